"""Erasure of one of two incidents that were open together, with people moved between them: nothing
of it is left, and all of the other.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Iterator
from functools import partial
from pathlib import Path

import msgspec
import pytest
from typer.testing import CliRunner

from base_station.app import folder_commands as station_app
from base_station.cli import app
from base_station.core.events import Output, event_of
from base_station.core.person_references import reference_to
from base_station.core.state import ERASED_TEXT
from base_station.replay.playback import Decision
from base_station.storage.data_folder import DataFolder
from base_station.storage.db.records import Records
from base_station.storage.db.roster import Roster
from base_station.storage.db.store import Store
from base_station.storage.db.window import EVER, FOREVER_NS
from shared.channels import OPERATOR, channel_of
from shared.clock import SystemClock
from shared.codec import decode, encode
from shared.mcap_log import read_log
from shared.messages import (
    STATION_ID,
    AlarmChange,
    CommandKind,
    EventKind,
    FusedPosition,
    Header,
    OperatorAction,
)
from shared.messages.pins import SetPin
from shared.messages.station import (
    Assign,
    AssignIncident,
    CheckIn,
    CloseIncident,
    OpenIncident,
    ResolveAlarm,
    SendCommand,
    SetAnchor,
    SetPlan,
    SetStart,
)
from tests.rig.erasure_folders import erasure_service_of, split_log
from tests.rig.erasure_scenario import put_person, stored_in
from tests.rig.reported_incident import plan, write_log
from tests.rig.station_script import Record, Script, new_pipeline

PEOPLE = {"p-ana": "Anastazja Kovač", "p-bo": "Bo Lind", "p-cem": "Cem Öz", "p-dan": "Dan Moe"}
UNITS = dict(zip(("FF-01", "FF-02", "FF-03"), PEOPLE, strict=False))
RECEIVED_FIRST = "FF-04"  # before it is registered, while the lane alone is open
LANE, HARBOUR = "i-lane", "i-harbour"


class _LoggedScript(Script):
    """With what is decided in the log, too, as the station writes it."""

    def record(self, key: str, payload: bytes) -> list[Output]:
        outputs = super().record(key, payload)
        self.records += [
            (self.t_ns, channel_of(one).key(STATION_ID), encode(one))
            for one in outputs
            if isinstance(one, Decision)
        ]
        return outputs


class _Scene:
    """Ana and Dan are at the lane, Bo at the harbour; Cem goes from there to the lane and back."""

    def __init__(self) -> None:
        self.script = _LoggedScript()
        self.of_harbour: list[Record] = []  # that have to stay
        self.of_lane: list[Record] = []  # that have to go
        self._north_m = 0.0

    def act(self, *actions: object) -> None:
        for action in actions:
            self.script.now_s += 0.5
            self.script.act(action)  # type: ignore[arg-type]

    def walk(self, seconds: int, **of: list[Record]) -> None:
        """``of``: where the units' words are kept, by unit."""

        def step() -> None:
            self._north_m += 1.0
            for unit_id, kept in of.items():
                name = unit_id.replace("_", "-")
                before = len(self.script.records)
                self.script.position(name, self._north_m, 7.125)
                kept.append(self.script.records[before])

        self.script.wait(seconds, step)

    def mayday(self, unit_id: str, kept: list[Record], note: str) -> None:
        before = len(self.script.records)
        self.script.event(unit_id, EventKind.MAYDAY)
        kept.append(self.script.records[before])
        alarm = next(one for one in reversed(self.script.alarms) if one.rule == "mayday")
        self.act(ResolveAlarm(alarm.alarm_id, note))

    def order(self, command_id: str, text: str, *person_ids: str) -> None:
        kind = CommandKind.TEXT
        self.act(SendCommand(command_id, kind, "", "", False, text, 0.0, 60.0, person_ids))


def start(unit_id: str) -> SetStart:
    return SetStart(unit_id, 1.0, 2.0, 0.0, 0.1, 0.5, 0.1)


def play() -> _Scene:
    scene = _Scene()
    lane, harbour = scene.of_lane, scene.of_harbour
    scene.script.register(*UNITS)
    scene.act(SetAnchor(52.0, 4.0, 0.0, 0.0))
    scene.act(*(Assign(*worn) for worn in UNITS.items()))
    scene.act(OpenIncident(LANE, "Mill Lane"))
    scene.script.position(RECEIVED_FIRST, 0.0, 0.0)
    scene.act(OpenIncident(HARBOUR, "Harbour", beside_others=True))
    scene.act(SetPlan(plan(), HARBOUR), AssignIncident(HARBOUR, ("FF-02", "FF-03")))
    scene.script.register(RECEIVED_FIRST)
    scene.act(Assign(RECEIVED_FIRST, "p-dan"))
    scene.act(*map(start, UNITS))
    scene.walk(20, FF_01=lane, FF_02=harbour, FF_03=harbour)
    scene.act(SetPin("pin-bo", "FF-02", 0, 3.25, 4.5, 1.0, None, None, 0.3, "Bo stands here"))
    scene.act(SetPin("pin-ana", "FF-01", 0, 6.75, 4.5, 1.0, None, None, 0.3, "Ana stands here"))
    scene.mayday("FF-02", harbour, f"spoke with {reference_to('p-cem')}")
    scene.act(AssignIncident(LANE, ("FF-03",)), start("FF-03"))
    scene.walk(20, FF_01=lane, FF_02=harbour, FF_03=lane, FF_04=lane)
    scene.mayday("FF-03", lane, f"{reference_to('p-cem')} is fine")
    scene.order("c-lane", "turn to the mill", "p-ana", "p-cem")
    scene.order("c-both", "the wind turns", "p-bo", "p-cem")
    scene.order("c-harbour", "close the gate", "p-bo")
    scene.act(CheckIn("", "", False, "k1", ("p-bo",)), CheckIn("FF-01", "", False, "k2"))
    scene.act(AssignIncident(HARBOUR, ("FF-03",)), start("FF-03"))
    scene.walk(20, FF_01=lane, FF_02=harbour, FF_03=harbour)
    scene.order("c-back", "welcome back", "p-cem")
    scene.act(CloseIncident(LANE))
    scene.walk(20, FF_02=harbour, FF_03=harbour)
    scene.act(CloseIncident(HARBOUR))
    return scene


class _Erased:
    """The folder with the lane erased, and what there was before."""

    def __init__(self, scene: _Scene, folder: Path, before: Path) -> None:
        self.scene, self.folder, self.before = scene, folder, before

    def records(self) -> list[Record]:
        return list(read_log(self.folder / "log"))

    def actions(self) -> list[OperatorAction]:
        payloads = [one[2] for one in self.records() if one[1] == OPERATOR.key(STATION_ID)]
        found = [decode(OPERATOR, payload) for payload in payloads]
        return [one for one in found if isinstance(one, OperatorAction)]


def make_folder(folder: Path, scene: _Scene) -> Path:
    folder.mkdir()
    write_log(folder, scene.script.records)
    split_log(folder / "log", 4)
    station_app.rebuild(folder, lambda _: None)
    with Store(folder / "station.sqlite") as store:
        for person_id, name in PEOPLE.items():
            put_person(store, person_id, name)
    return folder


@pytest.fixture(scope="module")
def erased(tmp_path_factory: pytest.TempPathFactory) -> _Erased:
    scene, root = play(), tmp_path_factory.mktemp("station")
    before, folder = (make_folder(root / name, scene) for name in ("before", "erased"))
    asked: list[str] = []
    done = station_app.forget(folder, LANE, asked.append, lambda _: None)
    assert "while another incident was open stays" in str(done)
    assert asked == [
        f"incident 'Mill Lane' of {LANE}, and nothing of Harbour, which was open beside it"
    ]
    return _Erased(scene, folder, before)


def test_erasure_removes_messages_of_its_incident_only(erased: _Erased) -> None:
    stored = stored_in(erased.folder)
    assert erased.scene.of_lane
    assert [one for one in erased.scene.of_lane if one[2] in stored] == []
    left = erased.records()
    assert [one for one in erased.scene.of_harbour if one not in left] == []
    for text in ("turn to the mill", "is fine", "Ana stands here"):
        assert text.encode() not in stored
    for text in ("the wind turns", "close the gate", "welcome back", "Bo stands here"):
        assert text.encode() in stored
    orders = {one.action.command_id: one.action for one in erased.actions()
              if isinstance(one.action, SendCommand)}  # fmt: skip
    assert (orders["c-lane"].text, orders["c-lane"].person_ids) == (ERASED_TEXT, ())
    assert (orders["c-both"].text, orders["c-both"].person_ids) == ("the wind turns", ("p-bo",))
    assert orders["c-back"].person_ids == ("p-cem",)
    notes = [one.action.note for one in erased.actions() if isinstance(one.action, ResolveAlarm)]
    assert notes == [f"spoke with {reference_to('p-cem')}", ERASED_TEXT]


def decisions(records: Iterable[Record], wanted: Callable[[Decision], bool]) -> list[bytes]:
    """Decisions of these records, without their numbers: there are fewer of them now."""
    pipeline = new_pipeline()
    outputs = [output for one in records for output in pipeline.step(event_of(*one))]
    found = [one for one in outputs if isinstance(one, Decision) and wanted(one)]
    header = Header(STATION_ID, 0, 0, 0)
    return [encode(msgspec.structs.replace(one, header=header)) for one in found]


def test_other_incident_replays_with_the_same_decisions(erased: _Erased) -> None:
    with Store(erased.before / "station.sqlite") as store:
        records = Records(store, SystemClock())
        members = records.members_of(records.require_incident(HARBOUR))

    def is_of_harbour(one: Decision) -> bool:
        match one:
            case FusedPosition(unit_id=unit_id, t_meas_ns=t_ns):
                return members.has(unit_id, t_ns)
            case AlarmChange(unit_id=unit_id, raised_ns=t_ns):
                return bool(unit_id) and members.has(unit_id, t_ns)

    before = decisions(erased.scene.script.records, is_of_harbour)
    assert len(before) > 100
    assert decisions(erased.records(), is_of_harbour) == before


def kept_of(folder: Path, incident_id: str) -> dict[str, object]:
    """Rows of the tables about an incident."""
    with Store(folder / "station.sqlite") as store:
        records, roster = Records(store, SystemClock()), Roster(store, SystemClock())
        incident = records.require_incident(incident_id)
        members = records.members_of(incident)
        worn = [
            (one.unit_id, one.person_id, part)
            for one in roster.assignments(incident.opened_ns, incident.closed_ns or FOREVER_NS)
            for window in members.of(one.unit_id)
            if (part := (max(one.from_ns, window.from_ns),
                         min(one.until_ns or FOREVER_NS, window.until_ns)))[0] < part[1]
        ]  # fmt: skip
        alarms = records.alarms(EVER, None, incident)
        return {
            "members": members,
            "worn": sorted(worn),
            "tracks": {unit_id: records.track(unit_id, window) for unit_id in UNITS
                       for window in members.of(unit_id)},
            "alarms": [(one.alarm_id, one.text, one.note, one.state) for one in alarms],
            "plan": records.plan(site_id=incident.site_id),
        }  # fmt: skip


@pytest.mark.parametrize("rebuilt", [False, True])
def test_tables_keep_the_other_incident_and_no_member_of_the_erased_one(
    erased: _Erased, tmp_path: Path, rebuilt: bool
) -> None:
    before, lane_before = (kept_of(erased.before, one) for one in (HARBOUR, LANE))
    assert before["tracks"]
    assert lane_before["worn"]
    if rebuilt:
        station_app.rebuild(erased.folder, lambda _: None)
    assert kept_of(erased.folder, HARBOUR) == before
    lane = kept_of(erased.folder, LANE)
    assert (lane["worn"], lane["members"]) == ([], lane_before["members"])
    assert not any(lane["tracks"].values())  # type: ignore[attr-defined]
    with Store(erased.folder / "station.sqlite") as store:
        roster = Roster(store, SystemClock())
        assert {unit: list(roster.worn_by(person)) for unit, person in UNITS.items()} == {
            unit: [unit] for unit in UNITS
        }


def report_of(folder: Path, incident_id: str, out: Path) -> str:
    arguments = ["report", incident_id, "--data", str(folder), "--html", str(out)]
    result = CliRunner().invoke(app, arguments)
    assert result.exit_code == 0, result.output
    return out.read_text(encoding="utf-8")


def test_report_of_the_other_incident_is_unchanged_and_of_the_erased_one_anonymous(
    erased: _Erased, tmp_path: Path
) -> None:
    page = partial(report_of, out=tmp_path / "report.html")
    before = page(erased.before, HARBOUR)
    ordered = "Message to Bo Lind{}: the wind turns"
    assert ordered.format(", Cem Öz") in before, "who was at the lane then"
    expected = before.replace(ordered.format(", Cem Öz"), ordered.format(""))
    assert page(erased.folder, HARBOUR) == expected
    assert re.search("Kovač.*Dan Moe", page(erased.before, LANE))
    assert (
        re.search("Kovač|Bo Lind|Cem Öz|Dan Moe|p-ana|p-cem|p-dan", page(erased.folder, LANE))
        is None
    )


class _PowerCut(BaseException):
    """In the middle of an erasure."""


def test_interrupted_and_repeated_erasure_gives_the_same_log(
    erased: _Erased, tmp_path: Path
) -> None:
    data = DataFolder(make_folder(tmp_path / "tries", erased.scene))
    cuts = 0
    with Store(data.database) as store:
        service = erasure_service_of(data, store, Records(store, SystemClock()))
        for after in range(20):
            steps = iter(range(after))

            def go_on(_: float, steps: Iterator[int] = steps) -> None:
                if next(steps, None) is None:
                    raise _PowerCut

            try:
                service.erase_incident("ada", LANE, go_on)
                break
            except _PowerCut:
                cuts += 1
                assert data.pending_erasures.exists(), (
                    "a log of which a part is rewritten does not say it"
                )
    assert cuts > 4
    assert not data.pending_erasures.exists()
    assert list(read_log(data.log)) == erased.records()


def test_repeated_erasure_changes_nothing_and_the_other_incident_can_be_erased(
    erased: _Erased, tmp_path: Path
) -> None:
    folder = make_folder(tmp_path / "again", erased.scene)
    erase = partial(station_app.forget, folder, confirm=lambda _: None, on_progress=lambda _: None)
    erase(LANE)
    once = list(read_log(folder / "log"))
    erase(LANE)
    assert list(read_log(folder / "log")) == once
    assert "stays" not in str(erase(HARBOUR))
    stored = stored_in(folder)
    reported = (*erased.scene.of_lane, *erased.scene.of_harbour)
    assert [one for one in reported if one[2] in stored] == []
    station_app.rebuild(folder, lambda _: None)
    for incident_id in (LANE, HARBOUR):
        assert kept_of(folder, incident_id)["worn"] == []
    assert DataFolder(folder).pending_erasures.exists() is False
