"""Erasure of a person or an incident leaves no byte, and other incidents replay unchanged."""

from __future__ import annotations

from functools import partial
from pathlib import Path

import msgspec
import pytest

from base_station.app import folder_commands as station_app
from base_station.core.events import event_of
from base_station.core.state import ERASED_TEXT
from base_station.privacy.erasure_queue import ErasureJob, ErasureState
from base_station.storage.db.records import Records
from base_station.storage.db.roster import Roster
from base_station.storage.db.store import Store
from base_station.storage.db.window import EVER, FOREVER_NS, Window
from base_station.storage.job_queue import JobList
from shared.channels import STATUS, Direction, backfilled_key, channel_of
from shared.clock import SystemClock
from shared.codec import encode
from shared.coded_text import code_of_text
from shared.errors import UserError
from shared.mcap_log import SegmentReader, is_derived, read_log, segment_paths
from shared.messages import (
    FusedPosition,
    Header,
    Heartbeat,
    OperatorAction,
)
from shared.messages.pins import SetPin
from shared.messages.station import (
    Assign,
    OpenIncident,
    SetStart,
    Unassign,
)
from tests.rig import message_factory
from tests.rig.erasure_scenario import ANA, BO, CEM, ErasureScenario, forget, names_in
from tests.rig.live_station import LiveStation, make_pipeline
from tests.rig.waiting import until


@pytest.fixture(params=["log of an earlier version", "log of this version"])
def scenario(tmp_path: Path, request: pytest.FixtureRequest) -> ErasureScenario:
    return ErasureScenario(tmp_path / "station", older=request.param == "log of an earlier version")


def test_no_byte_is_left_of_a_person(scenario: ErasureScenario) -> None:
    before = scenario.stored()
    assert names_in(before, ANA)
    assert any(piece in before for piece in pieces(scenario.photo))
    assert all(payload in before for payload in scenario.ana_stated)

    forget(scenario, "p-77")

    after = scenario.stored()
    assert names_in(after, ANA) == []
    assert not any(piece in after for piece in pieces(scenario.photo))
    assert [payload for payload in scenario.ana_stated if payload in after] == []
    of_bo = [one for one in fused_in(scenario) if one.unit_id == "FF-01"]
    assert of_bo
    assert len(of_bo) < len([one for one in fused_in(scenario) if one.unit_id == "FF-02"])
    actions = [e.message.action for e in scenario.events() if isinstance(e.message, OperatorAction)]
    assert not any(isinstance(action, SetPin | SetStart) for action in actions)


@pytest.mark.parametrize(("subject", "stay"), [("p-77", True), ("i1", False)])
def test_answer_names_files_that_were_brought_in_and_stay(
    tmp_path: Path, subject: str, stay: bool
) -> None:
    scenario = ErasureScenario(tmp_path / "station", older=False)
    brought_in = scenario.folder / "imports" / "i1" / "a.original"
    brought_in.parent.mkdir(parents=True)
    brought_in.write_bytes(b"track")
    done = station_app.forget(scenario.folder, subject, lambda _: None, lambda _: None)
    assert brought_in.exists() is stay
    assert ["erasure-imports-kept"] * stay == [code_of_text(one).code for one in done.kept]


def pieces(photo: bytes) -> list[bytes]:
    """Short enough for some to stand within a page of the database."""
    return [photo[at : at + 60] for at in range(0, len(photo) - 60, 500)]


def fused_in(scenario: ErasureScenario) -> list[FusedPosition]:
    return [e.message for e in scenario.events() if isinstance(e.message, FusedPosition)]


def test_other_people_are_kept_and_replay_identically(scenario: ErasureScenario) -> None:
    forget(scenario, ANA)  # by name

    kept = list(read_log(scenario.folder / "log"))
    others = [one for one in scenario.before if "/FF-02/" in one[1]]
    assert [one for one in kept if "/FF-02/" in one[1]] == others
    logged = [one for one in fused_in(scenario) if one.unit_id == "FF-02"]
    pipeline = make_pipeline()
    replayed = [
        output
        for record in kept
        for output in pipeline.step(event_of(*record))
        if isinstance(output, FusedPosition)
    ]
    assert [_bare(one) for one in replayed if one.unit_id == "FF-02"] == list(map(_bare, logged))
    assert pipeline.state.shown_incident is not None


def _bare(fused: FusedPosition) -> bytes:
    """Decisions are numbered; that there are fewer of them is seen."""
    return encode(msgspec.structs.replace(fused, header=Header("station", 0, 0, 0)))


def test_erased_messages_are_not_fetched_from_the_unit_again(scenario: ErasureScenario) -> None:
    forget(scenario, "p-77")
    again = make_pipeline()
    for record in read_log(scenario.folder / "log"):
        again.step(event_of(*record))
    before = make_pipeline()
    for record in scenario.before:
        before.step(event_of(*record))
    for unit_id in ("FF-01", "FF-02"):
        seen = [boot.seen for boot in again.state.units[unit_id].boots]
        assert seen
        assert seen == [boot.seen for boot in before.state.units[unit_id].boots]


def test_audit_is_kept(scenario: ErasureScenario) -> None:
    forget(scenario, "p-77")
    with Store(scenario.folder / "station.sqlite") as store:
        records = Records(store, SystemClock())
        audit = records.audit_entries(EVER)
        reported = [(entry.by, entry.action) for entry in audit]
        assert records.track("FF-02", EVER)
        (mayday,) = [one for one in records.alarms(EVER) if one.rule == "mayday"]
        roster = Roster(store, SystemClock())
        assert roster.person("p-77") is None
        assert roster.photo("p-77") is None
        worn = {one.person_id: roster.wearer(one).name for one in roster.assignments(0, FOREVER_NS)}
    for action in ("Assign", "SetPin", "ResolveAlarm", "AddedPerson"):
        assert ("chief", action) in reported
    assert ("muster base forget", "ForgotPerson") in reported
    assert mayday.text == ERASED_TEXT
    assert mayday.state == "resolved"
    assert worn == {"p-77": ERASED_TEXT, "p-bo": BO, "p-cem": CEM}


def test_rebuilt_tables_contain_no_erased_person(scenario: ErasureScenario) -> None:
    forget(scenario, "p-77")
    station_app.rebuild(scenario.folder, lambda _: None)
    assert names_in(scenario.stored(), ANA) == []
    with Store(scenario.folder / "station.sqlite") as store:
        roster = Roster(store, SystemClock())
        worn = {one.person_id: roster.wearer(one).name for one in roster.assignments(0, FOREVER_NS)}
        tracked = Records(store, SystemClock()).track_units(Window(0, FOREVER_NS))
    assert worn == {"p-77": ERASED_TEXT, "p-bo": BO, "p-cem": CEM}
    assert list(tracked) == ["FF-01", "FF-02"]


def test_incident_is_erased_with_all_its_members(scenario: ErasureScenario) -> None:
    forget(scenario, "i1")
    after = scenario.stored()
    assert [payload for payload in scenario.ana_stated if payload in after] == []
    reported = [one.message for one in scenario.events()]
    assert {type(one) for one in reported if channel_of(one).direction is Direction.UP} == {
        Heartbeat
    }
    assert fused_in(scenario) == []
    pipeline = make_pipeline()
    worn = []
    for record in read_log(scenario.folder / "log"):
        pipeline.step(event_of(*record))
        if (
            pipeline.state.shown_incident is not None
            and pipeline.state.shown_incident.closed_ns is None
        ):
            worn += [
                unit.wearer.person for unit in pipeline.state.units.values() if unit.wearer.person
            ]
    assert worn == []
    assert pipeline.state.units["FF-02"].wearer.person is not None  # as it was afterwards
    with Store(scenario.folder / "station.sqlite") as store:
        records = Records(store, SystemClock())
        incident = records.incident("i1")
        assert incident is not None
        assert incident.closed_ns is not None
        window = Window(incident.opened_ns, incident.closed_ns)
        assert list(records.track_units(window)) == []
        during = Roster(store, SystemClock()).assignments(window.from_ns, window.until_ns)
        assert list(during) == []
        texts = [one.text for one in records.alarms(window) if one.unit_id]
    assert set(texts) == {ERASED_TEXT}


def test_late_messages_of_an_erased_incident_are_erased(scenario: ErasureScenario) -> None:
    """Out of its journal, with the next link."""
    forget(scenario, "i1")
    headers = [one.message.header for one in scenario.events()]
    for unit_id in ("FF-01", "FF-02"):
        last = max((one for one in headers if one.unit_id == unit_id), key=lambda one: one.seq)
        late = encode(message_factory.status(msgspec.structs.replace(last, seq=10_000)))
        with LiveStation(scenario.folder) as station:
            received = station.pipeline.state.units[unit_id]
            station.feed.offer(backfilled_key(unit_id, STATUS.suffix), late)
            until(partial(received.has, last.boot_id, 10_000))
        assert late in scenario.stored()
        forget(scenario, "i1")
        assert late not in scenario.stored()


def test_erasure_of_an_open_incident_or_unknown_person_is_refused(
    scenario: ErasureScenario,
) -> None:
    for stranger in ("p-nobody", "A. Kovač"):
        with pytest.raises(UserError, match="knows a person"):
            forget(scenario, stranger)
    assert not (scenario.folder / "forgetting.json").exists(), "it has no names in it"
    with LiveStation(scenario.folder) as station:
        station.act(OpenIncident("i2", "Another"))
    station_app.rebuild(scenario.folder, lambda _: None)
    for what in ("i2", "p-77"):  # whose name would be gone from what goes on
        with pytest.raises(UserError, match="incident Another is open; close it first"):
            forget(scenario, what)


def test_wearer_is_unassigned_before_the_erasure(scenario: ErasureScenario) -> None:
    """Else what the unit goes on saying would be forgotten never.  It is asked about before."""
    with LiveStation(scenario.folder) as station:
        station.act(Assign("FF-01", "p-77", ANA, "Engine 1", "Nozzle"))
    station_app.rebuild(scenario.folder, lambda _: None)
    asked: list[str] = []
    station_app.forget(scenario.folder, ANA, asked.append, lambda _: None)
    assert asked == [f"person {ANA}, who wears FF-01 and is unassigned first"]
    assert names_in(scenario.stored(), ANA) == []
    last = [one.message for one in scenario.events() if isinstance(one.message, OperatorAction)][-1]
    assert (last.by, last.action) == ("muster base forget", Unassign("FF-01"))
    with Store(scenario.folder / "station.sqlite") as store:
        assert list(Roster(store, SystemClock()).worn_by("p-77")) == []
        actions = [one.action for one in Records(store, SystemClock()).audit_entries(EVER)]
    assert "Unassign" in actions
    with LiveStation(scenario.folder) as station:
        assert station.pipeline.state.units["FF-01"].wearer.person is None


def test_refused_confirmation_keeps_the_assignment(scenario: ErasureScenario) -> None:
    with LiveStation(scenario.folder) as station:
        station.act(Assign("FF-01", "p-77", ANA, "Engine 1", "Nozzle"))
    station_app.rebuild(scenario.folder, lambda _: None)

    def refuse(_about: str) -> None:
        raise UserError("no")

    with pytest.raises(UserError, match="no"):
        station_app.forget(scenario.folder, ANA, refuse, lambda _: None)
    with Store(scenario.folder / "station.sqlite") as store:
        assert list(Roster(store, SystemClock()).worn_by("p-77")) == ["FF-01"]


def test_removed_person_is_erased_by_name(scenario: ErasureScenario) -> None:
    with Store(scenario.folder / "station.sqlite") as store:
        assert Roster(store, SystemClock()).remove_person("p-77")
    forget(scenario, ANA)
    assert names_in(scenario.stored(), ANA) == []


def test_ambiguous_name_is_refused(scenario: ErasureScenario) -> None:
    with Store(scenario.folder / "station.sqlite") as store:
        roster, records = Roster(store, SystemClock()), Records(store, SystemClock())
        other = roster.add_person(ANA, "", "")
        records.audit("chief", "AddedPerson", f"{other.person_id} {ANA}")
        assert roster.remove_person(other.person_id)
    with pytest.raises(UserError, match=rf"2 people are or were called .*{other.person_id}"):
        forget(scenario, ANA)


@pytest.mark.parametrize("what", ["p-77", "i1"])
def test_station_completes_an_unfinished_erasure_of_a_command(
    scenario: ErasureScenario, monkeypatch: pytest.MonkeyPatch, what: str
) -> None:
    def cut_short(*_: object) -> None:
        raise KeyboardInterrupt

    with monkeypatch.context() as patched:
        patched.setattr("base_station.privacy.erasure_service.forget_in", cut_short)
        with pytest.raises(UserError, match="the same command, or the station when it is started"):
            forget(scenario, what)
    (job,) = JobList(scenario.folder / "forgetting.json", ErasureJob).under_way()
    assert (job.by, job.subject_id, job.began) == ("muster base forget", what, True)
    forget(scenario, what)
    stored = scenario.stored()
    assert [payload for payload in scenario.ana_stated if payload in stored] == []
    (job,) = JobList(scenario.folder / "forgetting.json", ErasureJob).all()
    assert job.state is ErasureState.DONE
    with Store(scenario.folder / "station.sqlite") as store:
        audit = Records(store, SystemClock()).audit_entries(EVER)
    (entry,) = [one for one in audit if one.action.startswith("Forgot")]
    assert entry.detail.endswith(f"{job.records} records of the log in {job.files} files")
    assert job.records > 0


def test_names_are_found_in_every_kind_of_record(tmp_path: Path) -> None:
    """Every kind of record that can hold a text is in the story."""
    scenario = ErasureScenario(tmp_path / "station", older=True)
    kinds = {key for _, key, payload in scenario.before if ANA.encode() in payload}
    assert any("operator" in key for key in kinds)
    assert any("alarm" in key for key in kinds)
    with SegmentReader(segment_paths(scenario.folder / "log")[0]) as reader:
        derived = [key for _, key, payload in reader.records(derived=True) if is_derived(key)]
    assert derived
    assert encode(Heartbeat(Header("FF-01", 1, 1, 1), 0, 0))
