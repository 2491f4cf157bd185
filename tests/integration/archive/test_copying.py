"""Incidents are copied to an S3 server and to a disk, and copies are verified."""

from __future__ import annotations

import json
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from shutil import rmtree

import pytest
from sqlalchemy import select
from typer.testing import CliRunner

from base_station.app.archive_sources import open_copier
from base_station.archive.catalogue import CONSOLE_NAME, ENTRY_NAME, LOG_NAME, require_entry
from base_station.archive.store import open_store
from base_station.cli import app
from base_station.storage.db.archived import ArchivedCopies
from base_station.storage.db.models import AlarmRow
from base_station.storage.db.roster import Roster
from base_station.storage.db.store import Store
from shared.clock import SystemClock
from shared.errors import ArchiveError, UserError
from shared.mcap_log import segment_paths
from tests.rig.archived_station import muster, refusal, succeeded
from tests.rig.bucket_server import ADDRESS, BucketServer
from tests.rig.closed_folder import close_incident
from tests.rig.noted_segments import note_segments


def test_bucket_contains_the_incidents_of_the_station(
    data: Path, ask_as: Callable[[str], None], tmp_path: Path
) -> None:
    address = f"{ADDRESS}-whole"
    copied = succeeded("archive", "copy", address, "--data", data)
    assert "2 incidents copied" in copied
    assert "0 incidents copied" in succeeded("archive", "copy", address, "--data", data)
    listed = succeeded("archive", "list", address)
    assert "i1\\t" in listed.replace("\t", "\\t")
    assert "mayday" in listed
    assert "Mill Lane" in listed
    assert ": 0 defects" in succeeded("archive", "verify", address)
    found = succeeded("search", "mill", "--person", "ada", "--alarm", "mayday", "--data", data)
    assert address in found
    assert "i2" not in found

    fetched, exported = tmp_path / "fetched.mcap", tmp_path / "exported.mcap"
    succeeded("archive", "fetch", address, "i1", fetched)
    succeeded("export", "i1", exported, "--data", data)
    assert fetched.read_bytes() == exported.read_bytes()

    with Store(data / "station.sqlite") as store:
        entry = require_entry(open_store(address), "i1")
        files = ArchivedCopies(store).files("i1")
        assert files == {one.name: one for one in entry.files}
        assert {CONSOLE_NAME, LOG_NAME} == set(files)
        assert entry.people.keys() == {"ada0", "bo00"}
        with store.write() as session:
            for table in ("archived_incidents", "archived_objects", "archived_ranges"):
                session.connection().exec_driver_sql(f"DELETE FROM {table}")
    again = succeeded("archive", "copy", address, "--data", data)
    assert again.count("is there already") == 2, "the catalogue is made again from the archive"
    with Store(data / "station.sqlite") as store:
        assert ArchivedCopies(store).files("i1") == files


def test_bucket_without_rights_is_reported(
    data: Path, ask_as: Callable[[str], None], monkeypatch: pytest.MonkeyPatch
) -> None:
    address = f"{ADDRESS}-rights"
    succeeded("archive", "copy", address, "--data", data)
    for asker in ("reader", "nobody"):
        ask_as(asker)
        reported = refusal("archive", "copy", f"{address}-other", "--data", data)
        assert "s3:PutObject" in reported
        assert "AWS_ACCESS_KEY_ID" in reported
    assert "s3:ListBucket" in refusal("archive", "list", address)
    ask_as("reader")
    assert "2 incidents" not in succeeded("archive", "verify", address)
    with Store(data / "station.sqlite") as store:
        assert ArchivedCopies(store).archives(["i1", "i2"]) == {"i1": address, "i2": address}
    ask_as("owner")
    assert "has no complete copy of ?; it has: i1, i2" in refusal(
        "archive", "fetch", address, "?", data / "out.mcap"
    )
    assert "make the bucket" in refusal("archive", "list", "s3://no-such-bucket/x")
    monkeypatch.setenv("AWS_ENDPOINT_URL", "http://192.0.2.1:1")
    assert "192.0.2.1" in refusal("archive", "list", address), "names of people are encrypted"


def test_complete_copy_is_not_replaced_after_loss_of_the_log(data: Path, tmp_path: Path) -> None:
    archive = tmp_path / "archive"
    succeeded("archive", "copy", archive, "--data", data)
    before = {path: path.read_bytes() for path in (archive / "i1").iterdir()}
    with Store(data / "station.sqlite") as store:
        note_segments(store, data / "log")
        Roster(store, SystemClock()).change_person("ada0", "Ada Changed", "", "")
        with store.write() as session:
            for table in ("archived_incidents", "archived_objects", "archived_ranges"):
                session.connection().exec_driver_sql(f"DELETE FROM {table}")
    segment_paths(data / "log")[1].unlink()
    refused = refusal("archive", "copy", archive, "--data", data)
    assert "i1 has newer data than its copy" in refused
    assert "i2" not in refused
    assert {path: path.read_bytes() for path in before} == before
    with Store(data / "station.sqlite") as store:
        assert ArchivedCopies(store).files("i2"), "the others are copied all the same"


def test_copy_that_is_not_there_any_more_is_made_again(data: Path, tmp_path: Path) -> None:
    archive = tmp_path / "archive"
    succeeded("archive", "copy", archive, "--data", data)
    before = (archive / "i1" / "incident.mcap").read_bytes()
    rmtree(archive / "i1")
    succeeded("archive", "copy", archive, "--data", data)
    assert (archive / "i1" / "incident.mcap").read_bytes() == before
    assert "0 defects" in succeeded("archive", "verify", archive)

    rmtree(archive / "i1")
    with Store(data / "station.sqlite") as store:
        note_segments(store, data / "log")
    segment_paths(data / "log")[1].unlink()
    refused = refusal("archive", "copy", archive, "--data", data)
    assert "the copy of i1 is not in" in refused
    assert "bring either back" in refused
    with Store(data / "station.sqlite") as store:
        assert ArchivedCopies(store).files("i1"), "it may come back"


def test_archive_that_has_none_of_its_copies_is_taken_for_another_disk(
    data: Path, tmp_path: Path
) -> None:
    archive = tmp_path / "archive"
    succeeded("archive", "copy", archive, "--data", data)
    archive.rename(tmp_path / "unmounted")
    assert "no such folder" in refusal("archive", "copy", archive, "--data", data)
    archive.mkdir()
    refused = refusal("archive", "copy", archive, "--data", data)
    assert "none of the 2 incidents" in refused
    assert list(archive.iterdir()) == []
    archive.rmdir()
    (tmp_path / "unmounted").rename(archive)
    succeeded("archive", "copy", archive, "--data", data)


def test_unreachable_bucket_loses_nothing(
    data: Path, server: BucketServer, ask_as: Callable[[str], None]
) -> None:
    address = f"{ADDRESS}-away"
    with open_copier(address, data) as copier:
        results = copier.copy_due(lambda _: None)
        assert next(results).incident_id == "i1"
        server.stop()
        try:
            with pytest.raises(ArchiveError, match="nothing is lost"):
                next(results)
            assert "nothing is lost" in refusal("archive", "list", address)
        finally:
            server.start()
    again = succeeded("archive", "copy", address, "--data", data)
    assert "i2\t" in again
    assert "i1" not in again
    assert ": 0 defects" in succeeded("archive", "verify", address)


def test_damaged_copy_is_detected_and_replaced(data: Path, tmp_path: Path) -> None:
    disk = tmp_path / "disk"
    succeeded("archive", "copy", disk, "--data", data)
    assert ": 0 defects" in succeeded("archive", "verify", disk)
    whole = (disk / "i1" / LOG_NAME).read_bytes()
    flipped = bytearray(whole)
    flipped[len(whole) // 2] ^= 1
    (disk / "i1" / LOG_NAME).write_bytes(flipped)
    (disk / "i2" / ENTRY_NAME).unlink()
    verified = muster("archive", "verify", disk)
    assert verified.exit_code == 1
    assert f"i1: {LOG_NAME} is not as it was written" in verified.output
    assert "i2: the copy was cut short" in verified.output
    out = tmp_path / "out.mcap"
    assert "is not as it was written" in refusal("archive", "fetch", disk, "i1", out)
    assert list(tmp_path.glob("*out.mcap*")) == [], "no partial file is left"
    (disk / "i1" / LOG_NAME).write_bytes(whole[:-1])
    with suppress(UserError), Store(data / "station.sqlite") as store, store.write() as session:
        session.connection().exec_driver_sql("DELETE FROM archived_incidents")
    copied = succeeded("archive", "copy", disk, "--data", data)
    assert "already" not in copied
    assert ": 0 defects" in succeeded("archive", "verify", disk)
    entry = json.loads((disk / "i1" / ENTRY_NAME).read_bytes())
    (disk / "i1" / ENTRY_NAME).write_text(json.dumps(entry | {"version": 99}))
    assert "newer version of Muster" in refusal("archive", "fetch", disk, "i1", out)
    assert "an archive is a folder, or s3://" in refusal("archive", "list", "ftp://x/y")
    assert "see that the disk is there" in refusal("archive", "list", tmp_path / "none")


def test_erased_person_is_removed_from_the_next_copy(data: Path, tmp_path: Path) -> None:
    close_incident(data, "i3")
    disk = tmp_path / "disk"
    succeeded("archive", "copy", disk, "--data", data)
    assert any(b"Ada" in file.read_bytes() for file in disk.rglob("*.*"))
    forgotten = CliRunner().invoke(app, ["forget", "Ada", "--data", str(data)], input="Ada\n")
    assert forgotten.exit_code == 0, forgotten.output
    assert "3 incidents copied" in succeeded("archive", "copy", disk, "--data", data)
    assert not any(b"Ada" in file.read_bytes() for file in disk.rglob("*.*"))
    with Store(data / "station.sqlite") as store, store.read() as session:
        assert "mayday" in session.scalars(select(AlarmRow.rule)).all()
