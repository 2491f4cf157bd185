"""A copy tells whether it has people who were erased, and is rewritten without them."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

from base_station.app.archive_sources import open_copier
from base_station.app.factories import project_whole_log
from base_station.archive.catalogue import CatalogueEntry, require_entry
from base_station.archive.redacted_copy import (
    CopyIncompleteError,
    ErasedSubjects,
    erased_in,
    redacted_log,
)
from base_station.archive.store import FolderStore
from base_station.storage.db.erasure import FORGOT_INCIDENT, INCIDENT
from base_station.storage.db.known_people import KnownPerson
from base_station.storage.db.models import Tombstone
from base_station.storage.db.records import Records
from base_station.storage.db.roster import Roster
from base_station.storage.db.store import Store
from base_station.storage.db.tombstones import PERSON
from shared.channels import POSITION
from shared.clock import ManualClock, SystemClock
from shared.messages.station import Assign, CloseIncident, OpenIncident
from tests.rig.reported_incident import write_log
from tests.rig.station_script import Script

NOBODY = frozenset[str]()


@pytest.fixture
def archive(tmp_path: Path) -> FolderStore:
    """i1, and i2, which was open beside it and longer."""
    script = Script()
    script.register("FF-01")
    script.act(Assign("FF-01", "ada-0001"))
    script.act(OpenIncident("i1", "Mill Lane"))
    script.act(OpenIncident("i2", "Harbour", beside_others=True))
    for _ in range(30):
        script.now_s += 1.0
        script.position("FF-01", script.now_s, 0.0)
    script.act(CloseIncident("i1"))
    script.wait(200.0)
    script.act(CloseIncident("i2"))
    data, archive = tmp_path / "station", FolderStore(tmp_path / "archive")
    write_log(data, script.records)
    with Store(data / "station.sqlite") as store:
        project_whole_log(store, data / "log", lambda _: None)
        Roster(store, SystemClock()).add_unknown_people({"ada-0001": KnownPerson("Ada", "", "")})
    with open_copier(archive.address, data) as copier:
        list(copier.copy_due(lambda _: None))
    return archive


@pytest.fixture
def entry(archive: FolderStore) -> CatalogueEntry:
    return require_entry(archive, "i1")


@pytest.fixture
def store(tmp_path: Path, archive: FolderStore) -> Iterator[Store]:
    with Store(tmp_path / "station" / "station.sqlite") as store:
        yield store


def test_erased_people_are_found_in_the_copies_list(
    archive: FolderStore, entry: CatalogueEntry, store: Store
) -> None:
    with store.write() as session:
        session.add(Tombstone(what=f"{PERSON}p9", until_ns=None))
    assert not erased_in(archive, entry, store)
    with store.write() as session:
        session.add(Tombstone(what=f"{PERSON}ada-0001", until_ns=None))
    assert erased_in(archive, entry, store) == ErasedSubjects(frozenset({"ada-0001"}), NOBODY)


def test_incident_beside_counts_until_the_copy_is_newer(
    archive: FolderStore, entry: CatalogueEntry, store: Store
) -> None:
    for t_ns, expected in ((entry.archived_ns - 1, NOBODY), (entry.archived_ns + 1, {"i2"})):
        records = Records(store, ManualClock(utc_ns=t_ns))
        records.audit("chief", FORGOT_INCIDENT, f"{INCIDENT} i2: 4 records")
        assert erased_in(archive, entry, store).incident_ids == expected


def test_person_is_redacted_in_the_log_of_a_copy(
    archive: FolderStore, entry: CatalogueEntry, tmp_path: Path
) -> None:
    erased = ErasedSubjects(frozenset({"ada-0001"}), NOBODY)
    log = redacted_log(archive, entry, erased, tmp_path / "scratch")
    records = list(log.records())
    assert len(records) > 30, "that messages came stays"
    assert not any(key == POSITION.key("FF-01") for _, key, _ in records)
    others = redacted_log(archive, entry, ErasedSubjects(NOBODY, NOBODY), tmp_path / "whole")
    assert sum(key == POSITION.key("FF-01") for _, key, _ in others.records()) == 30


def test_part_of_an_incident_that_goes_on_behind_the_copy_is_refused(
    archive: FolderStore, entry: CatalogueEntry, tmp_path: Path
) -> None:
    erased = ErasedSubjects(NOBODY, frozenset({"i2"}))
    with pytest.raises(CopyIncompleteError, match="people of i2, which was erased"):
        redacted_log(archive, entry, erased, tmp_path / "scratch")
