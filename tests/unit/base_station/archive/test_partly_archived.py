"""A log of which parts are in an archive: each part is read where it is."""

from __future__ import annotations

from collections.abc import Container, Iterator

from base_station.archive.partly_archived import OpenedPart, PartlyArchivedFeed, without_archived
from base_station.replay.processes.jobs import ArchivedLog, ArchivedPart
from base_station.storage.missing_segments import KnownSegment
from shared.mcap_log import LogRecord


class NamedFeed:
    """A record each ten nanoseconds, with the name of who gives it."""

    def __init__(self, name: str) -> None:
        self._name = name

    def records(
        self,
        start_ns: int | None = None,
        end_ns: int | None = None,
        keys: Container[str] | None = None,
    ) -> Iterator[LogRecord]:
        for t_ns in range(0, 100, 10):
            if (start_ns or 0) <= t_ns < (100 if end_ns is None else end_ns):
                yield t_ns, self._name, b""


def read(parts: list[OpenedPart], from_ns: int | None, until_ns: int | None) -> list[str]:
    log = PartlyArchivedFeed(NamedFeed("own"), parts)
    return [f"{key} {t_ns}" for t_ns, key, _ in log.records(from_ns, until_ns)]


def test_each_part_is_read_where_it_is_and_no_record_twice() -> None:
    parts = [OpenedPart(20, 45, NamedFeed("a")), OpenedPart(40, 60, NamedFeed("b"))]
    assert read(parts, None, None) == [
        *("own 0", "own 10", "a 20", "a 30", "a 40", "b 50"),
        *("own 60", "own 70", "own 80", "own 90"),
    ]
    assert read(parts, 30, 51) == ["a 30", "a 40", "b 50"]
    assert read(parts, 0, 20) == ["own 0", "own 10"]
    assert read(parts, 90, None) == ["own 90"]


def test_a_segment_of_an_archived_incident_does_not_count_as_lost() -> None:
    parts = [ArchivedPart(20, 40, ArchivedLog("disk", b""))]
    before, within, behind = (
        KnownSegment(name, first_ns, first_ns + 9, 1)
        for name, first_ns in (("1", 0), ("2", 30), ("3", 40))
    )
    assert without_archived((before, within, behind), parts) == (before, behind)
