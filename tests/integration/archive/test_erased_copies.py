"""Copies are made anew without people who were erased, also where the station has no log."""

from __future__ import annotations

import shutil
from collections.abc import Callable
from pathlib import Path

import pytest
from sqlalchemy import select
from typer.testing import CliRunner

from base_station.archive.catalogue import LOG_NAME, archived_ids, require_entry
from base_station.archive.copying import ArchiveCopier
from base_station.archive.feed import ArchivedFeed
from base_station.archive.store import ArchiveStore, FolderStore, open_store
from base_station.cli import app
from base_station.engine.log_feed import FolderFeed
from base_station.storage.db.archived import ArchivedCopies
from base_station.storage.db.models import Assignment, TrackPoint
from base_station.storage.db.store import Store
from base_station.storage.imports import ImportFolder
from shared.clock import SystemClock
from shared.mcap_log import LogRecord, SegmentReader, segment_paths
from tests.rig.archived_station import succeeded
from tests.rig.bucket_server import ADDRESS, BucketServer
from tests.rig.closed_folder import close_incident
from tests.rig.noted_segments import note_segments
from tests.rig.station_command import Browser, Command
from tests.rig.waiting import until

ADA = b"Ada"


@pytest.fixture
def closed(data: Path) -> Path:
    """The station, with all its incidents closed."""
    close_incident(data, "i3")
    with Store(data / "station.sqlite") as store:
        note_segments(store, data / "log")
    return data


def forget(subject: str, data: Path) -> None:
    done = CliRunner().invoke(app, ["forget", subject, "--data", str(data)], input=f"{subject}\n")
    assert done.exit_code == 0, (done.output, done.exception)


def records_of(archive: ArchiveStore, incident_id: str) -> list[LogRecord]:
    entry = require_entry(archive, incident_id)
    files = {one.name: one for one in entry.files}
    feed = ArchivedFeed(archive, incident_id, files, entry.log_id)
    return list(feed.records(entry.opened_ns, entry.closed_ns))


def content_of(archive: ArchiveStore) -> bytes:
    return b"".join(archive.read_all(name) or b"" for name in archive.names())


def outdated(data: Path) -> dict[str, int]:
    with Store(data / "station.sqlite") as store:
        return ArchivedCopies(store).outdated_by_erasure()


@pytest.mark.parametrize("subject", ["Ada", "i1"])
def test_copy_without_log_is_redacted_as_the_log_would_be(
    closed: Path, ask_as: Callable[[str], None], tmp_path: Path, subject: str
) -> None:
    address, folder = f"{ADDRESS}-{subject}", tmp_path / "of-the-log"
    succeeded("archive", "copy", address, "--data", closed)
    bucket = open_store(address)
    before = bucket.names()
    assert ADA in content_of(bucket)
    kept = records_of(bucket, "i2")
    log = segment_paths(closed / "log")
    forget(subject, closed)
    assert outdated(closed)[address] >= 1
    succeeded("archive", "copy", folder, "--data", closed)  # of the log, which is still here
    assert not outdated(closed)
    with Store(closed / "station.sqlite") as store, store.write() as session:
        session.connection().exec_driver_sql(
            f"UPDATE archived_incidents SET archive = '{address}', known_ns = 0"
        )
    for segment in log:
        segment.unlink()

    copied = succeeded("archive", "copy", address, "--data", closed)
    assert ": 0 defects" in succeeded("archive", "verify", address)
    for one in ("i1", "i2", "i3"):
        assert records_of(bucket, one) == records_of(open_store(str(folder)), one)
    assert not outdated(closed)
    if subject == "Ada":
        assert ADA not in content_of(bucket)
    else:
        assert records_of(bucket, "i2") == kept
        assert "i2\tis there already" in copied
    assert f"i1/{LOG_NAME}" in before
    assert f"i1/{LOG_NAME}" not in bucket.names(), "the file with the people is gone"
    assert "0 incidents copied" in succeeded("archive", "copy", address, "--data", closed)


def test_person_is_erased_of_tables_and_copies_after_loss_of_the_log(
    closed: Path, tmp_path: Path
) -> None:
    folder = tmp_path / "archive"
    succeeded("archive", "copy", folder, "--data", closed)
    archive = open_store(str(folder))
    counts = [len(records_of(archive, one)) for one in ("i1", "i2", "i3")]
    for segment in segment_paths(closed / "log")[:-1]:
        segment.unlink()
    assert tracked_units(closed) == {"FF-01", "FF-02"}
    forget("Ada", closed)
    assert tracked_units(closed) == {"FF-02"}
    succeeded("archive", "copy", folder, "--data", closed)
    assert ADA not in content_of(archive)
    assert not outdated(closed)
    counts[0] -= 1  # where she was set to be
    assert [len(records_of(archive, one)) for one in ("i1", "i2", "i3")] == counts
    assert ": 0 defects" in succeeded("archive", "verify", folder)


def tracked_units(data: Path) -> set[str]:
    with Store(data / "station.sqlite") as store, store.read() as session:
        return set(session.scalars(select(TrackPoint.unit_id)))


class KilledError(BaseException):
    """The copying is killed."""


class KilledStore(FolderStore):
    """An archive in which the copying is killed before a certain change."""

    def __init__(self, folder: Path, changes: int) -> None:
        super().__init__(folder)
        self._left = changes

    def put(self, name: str, content: Path) -> None:
        self._count()
        super().put(name, content)

    def remove(self, name: str) -> None:
        self._count()
        super().remove(name)

    def _count(self) -> None:
        if self._left == 0:
            raise KilledError
        self._left -= 1


def test_copy_that_is_killed_anywhere_loses_no_record_and_is_made_again(
    closed: Path, tmp_path: Path
) -> None:
    """The archive has the only log: at every step it has a whole copy."""
    folder = tmp_path / "archive"
    succeeded("archive", "copy", folder, "--data", closed)
    archive = open_store(str(folder))
    for segment in segment_paths(closed / "log")[:-1]:
        segment.unlink()
    forget("Ada", closed)
    station, before = tmp_path / "kept-station", tmp_path / "kept-archive"
    shutil.copytree(closed, station)
    shutil.copytree(folder, before)
    killed_at = 0
    while copied_until_killed(closed, KilledStore(folder, killed_at)):
        for incident_id in archived_ids(archive):
            assert records_of(archive, incident_id)
        assert len(archived_ids(archive)) == 3
        assert outdated(closed)[str(folder)] >= 1, "it is not done yet"
        succeeded("archive", "copy", folder, "--data", closed)
        assert ADA not in content_of(archive), killed_at
        assert ": 0 defects" in succeeded("archive", "verify", folder)
        assert not outdated(closed)
        for there, as_it_was in ((closed, station), (folder, before)):
            shutil.rmtree(there)
            shutil.copytree(as_it_was, there)
        killed_at += 1
    assert killed_at == 3 * 5, "of each copy two files, the catalogue, and two old files"


def copied_until_killed(data: Path, archive: ArchiveStore) -> bool:
    """True if it was killed."""
    log, imports = FolderFeed(data / "log"), ImportFolder(data / "imports")
    with Store(data / "station.sqlite") as store:
        copier = ArchiveCopier(archive, store, log, SystemClock(), imports)
        try:
            list(copier.copy_due(lambda _: None))
        except KilledError:
            return True
    return False


def test_station_reports_copies_with_erased_people_until_the_archive_is_back(
    closed: Path, server: BucketServer, ask_as: Callable[[str], None],
    serve: Callable[..., Command], tmp_path: Path,
) -> None:  # fmt: skip
    address = f"{ADDRESS}-pending"
    succeeded("archive", "copy", address, "--data", closed)
    for segment in segment_paths(closed / "log")[:-1]:
        segment.unlink()
    settings = tmp_path / "station.toml"
    settings.write_text(f'[archive]\nlocation = "{address}"\n')
    first = serve()  # it copies nowhere
    with Browser(first.wait_ready(), closed) as browser:
        browser.call("POST", "/people/ada0/forget", json={"name": "Ada"})
        until(lambda: f"muster base archive copy {address}" in problems_of(browser), "it is told")
    first.kill()
    server.stop()
    second = serve("--config", str(settings))
    try:
        with Browser(second.wait_ready(), closed) as browser:
            until(
                lambda: (
                    f"copies in the archive {address} may have" in problems_of(browser)
                    and "nothing is lost" in problems_of(browser)
                ),
                "the archive is away",
            )
    finally:
        server.start()
    second.kill()
    third = serve("--config", str(settings))
    with Browser(third.wait_ready(), closed) as browser:
        until(lambda: not outdated(closed), "the copies are made anew")
        until(lambda: address not in problems_of(browser), "nothing is pending")
    assert third.stop() == 0
    assert ADA not in content_of(open_store(address))


def problems_of(browser: Browser) -> str:
    return str(browser.call("GET", "/health")["problems"])


@pytest.mark.parametrize("left", [-1, 1], ids=["log of its end", "log of all but its beginning"])
def test_incident_whose_opening_is_lost_is_erased_as_with_it(
    closed: Path, tmp_path: Path, left: int
) -> None:
    """The audit has its members."""
    whole, folder = tmp_path / "whole", tmp_path / "archive"
    shutil.copytree(closed, whole)
    forget("i1", whole)
    succeeded("archive", "copy", folder, "--data", closed)
    archive = open_store(str(folder))
    kept = records_of(archive, "i2")
    segments = segment_paths(closed / "log")
    for segment in segments[:left]:
        segment.unlink()

    forget("i1", closed)
    names = [one.name for one in segments[left:]]
    for name in names:
        assert records_in(closed / "log" / name) == records_in(whole / "log" / name), name
    assert assigned(closed) == assigned(whole)
    assert tracks(closed) == tracks(whole)
    succeeded("archive", "copy", folder, "--data", closed)
    assert not outdated(closed)
    assert not [one for one in records_of(archive, "i1") if b"ada0" in one[2]]
    assert records_of(archive, "i2") == kept
    assert ": 0 defects" in succeeded("archive", "verify", folder)


def records_in(segment: Path) -> list[LogRecord]:
    with SegmentReader(segment) as reader:
        return list(reader.records())


def assigned(data: Path) -> list[tuple[str, str, int, int | None]]:
    with Store(data / "station.sqlite") as store, store.read() as session:
        rows = session.scalars(select(Assignment).order_by(Assignment.unit_id, Assignment.from_ns))
        return [(one.unit_id, one.person_id, one.from_ns, one.until_ns) for one in rows]


def tracks(data: Path) -> list[tuple[str, int]]:
    with Store(data / "station.sqlite") as store, store.read() as session:
        rows = session.scalars(select(TrackPoint).order_by(TrackPoint.unit_id, TrackPoint.t_ns))
        return [(one.unit_id, one.t_ns) for one in rows]
