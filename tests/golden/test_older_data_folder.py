"""A data folder of an older version opens, replays to the same decisions, is queried, and a person
in it is erased.
"""

from __future__ import annotations

import tarfile
from pathlib import Path

from base_station.app import folder_commands
from base_station.core.events import event_of, is_decision
from base_station.core.state import ERASED_TEXT
from base_station.replay.playback import compare
from base_station.storage.db.accounts import Accounts
from base_station.storage.db.known_people import person_lookup
from base_station.storage.db.records import Records
from base_station.storage.db.roster import Roster
from base_station.storage.db.smoothed import SmoothedTracks
from base_station.storage.db.store import Store
from base_station.storage.db.window import EVER
from base_station.views.station import StationFacts, snapshot
from base_station.views.stored_units import stored_sensors
from shared.clock import SystemClock
from shared.mcap_log import read_log
from tests.rig.erasure_scenario import names_in, stored_in
from tests.rig.live_station import make_pipeline
from tests.rig.older_data_folder import ARCHIVE


def test_log_of_older_version_replays_to_same_decisions(tmp_path: Path) -> None:
    with tarfile.open(ARCHIVE) as archive:
        archive.extractall(tmp_path, filter="data")
    records = list(read_log(tmp_path / "log"))
    assert sum(is_decision(key) for _, key, _ in records) > 100
    assert list(compare(records, make_pipeline())) == []


def test_database_of_older_version_is_queried(tmp_path: Path) -> None:
    with tarfile.open(ARCHIVE) as archive:
        archive.extractall(tmp_path, filter="data")
    with Store(tmp_path / "station.sqlite") as store:
        records, roster = Records(store, SystemClock()), Roster(store, SystemClock())
        assert [stored_sensors(unit) for unit, _ in roster.units()] == [(), ()]
        incident = records.require_incident("i1")
        assert (incident.name, incident.late_data_ns) == ("Mill Lane", 0)
        assert {person.name for person in roster.people()} == {"Ana Horn", "Bo Lind"}
        assert records.tracks_of(incident).keys() == {"FF-01", "FF-02"}
        assert any(records.alarm_life(alarm.alarm_id) for alarm in records.alarms(EVER))
        kept = SmoothedTracks(store)
        assert kept.has("i1")
        assert kept.report("i1")
        assert [user.username for user in Accounts(store, SystemClock()).users()] == ["chief"]


def test_person_in_log_of_older_version_is_shown_by_name_and_forgotten(tmp_path: Path) -> None:
    with tarfile.open(ARCHIVE) as archive:
        archive.extractall(tmp_path, filter="data")
    assert "Mayday from Ana Horn" in mayday_texts(tmp_path)
    assert names_in(stored_in(tmp_path), "Ana Horn")

    folder_commands.forget(tmp_path, "Ana Horn", lambda _: None, lambda _: None)

    assert names_in(stored_in(tmp_path), "Ana Horn") == []
    assert names_in(stored_in(tmp_path), "Bo Lind")
    assert mayday_texts(tmp_path) == {ERASED_TEXT}
    pipeline = make_pipeline()
    for record in read_log(tmp_path / "log"):
        pipeline.step(event_of(*record))
    shown = snapshot(pipeline.state, 1, StationFacts(), person_lookup({}))
    worn = {one.unit_id: one.person.name for one in shown.units if one.person}
    assert worn == {"FF-02": "Bo Lind"}, "who is forgotten hands back the unit"
    folder_commands.rebuild(tmp_path, lambda _: None)
    assert names_in(stored_in(tmp_path), "Ana Horn") == []


def mayday_texts(folder: Path) -> set[str]:
    with Store(folder / "station.sqlite") as store:
        roster, records = Roster(store, SystemClock()), Records(store, SystemClock())
        return {roster.shown(one.text) for one in records.alarms(EVER) if one.rule == "mayday"}
