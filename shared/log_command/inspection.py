"""Contents of a log, and damage that is found in it."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass, field
from datetime import UTC, datetime
from pathlib import Path

from shared.clock import NS_PER_S
from shared.mcap_log import SegmentReader, SegmentState, identity_of

_REPORT_EVERY = 10_000  # messages


@dataclass(frozen=True, slots=True)
class FileContents:
    """One file; times are those of the first and the last record, None where it has none."""

    path: Path
    state: SegmentState  # closed: ended in order
    log_id: str  # the same in all files of a log; empty: of an earlier version
    size_bytes: int
    start: datetime | None
    end: datetime | None
    topics: dict[str, int]  # messages
    damage: list[str] = field(default_factory=list)  # in words

    @property
    def messages(self) -> int:
        return sum(self.topics.values())


class _EveryKey:
    """Has every key: reading by key goes through the index of each chunk, and so checks it."""

    def __contains__(self, key: object) -> bool:
        return True


def contents_of_file(path: Path) -> FileContents:
    """As the end of a complete file states it; one without an end is read through."""
    with SegmentReader(path) as reader:
        counts = reader.topic_counts
        if counts is None:
            counts = Counter(key for _, key, _ in reader.records(derived=True))
        return _described(reader, dict(counts))


def check_file(path: Path, on_bytes: Callable[[int], None]) -> FileContents:
    """Reads all of it: checksums, indexes, counts and order; not what the heads of chunks and
    files repeat of that.  ``on_bytes`` takes how much of the
    file has been read since its last call, roughly.
    """
    found: Counter[str] = Counter()
    earliest_ns = backwards = 0
    with SegmentReader(path) as reader:
        stated = reader.topic_counts
        expected = sum(stated.values()) if stated is not None else 0
        share = path.stat().st_size / max(expected, 1)
        for t_ns, key, _ in reader.records(keys=_EveryKey(), derived=True):
            found[key] += 1
            backwards += t_ns < earliest_ns
            earliest_ns = max(earliest_ns, t_ns)
            if not found.total() % _REPORT_EVERY:
                on_bytes(round(share * _REPORT_EVERY))
        contents = _described(reader, dict(found))
    if stated is not None and found.total() != expected:
        contents.damage.append(
            f"{path.name}: its end states {expected} messages, {found.total()} can be read"
        )
    if backwards:
        contents.damage.append(f"{path.name}: {backwards} records are not in the order of time")
    return contents


def damage_of(reader: SegmentReader) -> list[str]:
    """Damage of a file that was found so far, as sentences."""
    damage = list(reader.damage)
    name = reader.path.name
    if identity_of(reader.path) is None:
        damage.append(f"{name}: it is no MCAP file, or its head is damaged")
    if reader.state is SegmentState.TORN:
        lost = f"; {reader.bytes_lost} bytes at its end cannot be read" if reader.bytes_lost else ""
        damage.append(f"{name}: it was not ended in order, or is being written{lost}")
    return damage


def _described(reader: SegmentReader, topics: dict[str, int]) -> FileContents:
    info = reader.info()
    return FileContents(
        reader.path,
        info.state,
        info.log_id,
        info.size_bytes,
        _utc(info.start_ns),
        _utc(info.end_ns),
        dict(sorted(topics.items())),
        damage_of(reader),
    )


def _utc(t_ns: int) -> datetime | None:
    return datetime.fromtimestamp(t_ns / NS_PER_S, UTC) if t_ns else None
