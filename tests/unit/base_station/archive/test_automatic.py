"""Automatic archiving: a lasting failure is a problem, and is retried."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path
from threading import Semaphore

import pytest

from base_station.archive.automatic import ArchivingContext, AutomaticArchive
from base_station.config import ArchiveConfig
from base_station.replay.processes.frame_channel import FrameChannel
from base_station.replay.processes.jobs import ArchiveJob
from base_station.storage.db.archived import ArchivedCopies
from base_station.storage.db.models import IncidentRow
from base_station.storage.db.store import Store
from shared.clock import NS_PER_S, ManualClock
from shared.errors import ConfigError, StoreError
from tests.rig.waiting import until

_LATER_NS = 10_000 * NS_PER_S


@pytest.fixture
def copies(tmp_path: Path) -> Iterator[ArchivedCopies]:
    with Store(tmp_path / "station.sqlite") as store:
        with store.write() as session:
            for number, closed_ns in enumerate((20 * NS_PER_S, None)):
                session.add(
                    IncidentRow(
                        incident_id=f"i{number}", name="", opened_ns=10 * NS_PER_S + number,
                        opened_by="", closed_ns=closed_ns, closed_by="", dispatch_number="",
                        has_members=True,
                    )
                )  # fmt: skip
        yield ArchivedCopies(store)


def no_process(job: ArchiveJob) -> FrameChannel:
    raise StoreError(f"no process for {type(job).__name__}")


def archive_in(
    folder: Path,
    copies: ArchivedCopies,
    clock: ManualClock,
    *,
    radio: bool = False,
    prepare: Callable[[], object] = lambda: None,
) -> AutomaticArchive:
    place = ArchivingContext(no_process, "log", "db", prepare, lambda _: None, lambda: True)
    config = ArchiveConfig(str(folder), radio=radio)
    return AutomaticArchive(config, place, copies, clock, poll_interval_s=0.01)


def test_lasting_failure_is_a_problem_and_is_retried(
    copies: ArchivedCopies, tmp_path: Path
) -> None:
    clock, tries = ManualClock(utc_ns=_LATER_NS), Semaphore(0)
    archive = archive_in(tmp_path / "archive", copies, clock, prepare=tries.release)
    with archive:
        until(lambda: tries.acquire(blocking=False), "it is tried")
        until(lambda: tries.acquire(blocking=False), "it is tried again")
        view = archive.view()
        assert (view.state, view.waiting, view.archived_ms) == ("away", 1, None)
        assert list(archive.problems()) == [], "not at once"
        clock.advance(1_000.0)
        (problem,) = archive.problems()
        assert "17 min, 1 wait: no process for ArchiveJob" in problem


def test_audio_is_kept_until_it_is_archived(copies: ArchivedCopies, tmp_path: Path) -> None:
    clock = ManualClock(utc_ns=_LATER_NS)
    without, archive = (archive_in(tmp_path, copies, clock, radio=one) for one in (False, True))
    assert without.keeps_audio_since_ns() is None
    assert archive.keeps_audio_since_ns() == 10 * NS_PER_S
    copies.note("i0", str(tmp_path), _LATER_NS, 20 * NS_PER_S, ())
    assert archive.keeps_audio_since_ns() == 10 * NS_PER_S + 1, "of the one that is open"


@pytest.mark.parametrize("location", ["", "ftp://x/y"])
def test_folder_that_is_no_archive_is_refused(location: str) -> None:
    with pytest.raises(ConfigError, match="give a folder, or s3://"):
        ArchiveConfig(location)
