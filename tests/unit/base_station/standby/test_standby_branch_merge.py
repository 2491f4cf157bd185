"""Merge of a set-aside branch into the leading station: once, in order, and complete or
repeated.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from concurrent.futures import Future
from pathlib import Path
from threading import Event, Thread

import pytest

from base_station.core import idempotency
from base_station.core.log_position import START, Record
from base_station.core.state import StationState
from base_station.engine.ports import ActionResult
from base_station.standby.branch_merge import BranchMerge, PartServer
from base_station.standby.log_truncation import parts, set_aside
from base_station.standby.rpc import ask
from base_station.storage.data_folder import DataFolder
from base_station.storage.recorder import Recorder
from shared.bus_memory import MemoryRouter
from shared.channels import EVENT, OPERATOR, TICK, backfilled_key, unread_key
from shared.clock import SystemClock
from shared.codec import encode
from shared.errors import StoreError
from shared.messages import STATION_ID, CommandKind, Header, OperatorAction, Tick
from shared.messages.pins import StartTogether
from shared.messages.station import (
    Action,
    Assign,
    CloseIncident,
    DoneApart,
    ReportProblem,
    ResolveAlarm,
    SendCommand,
)
from tests.rig.waiting import until

T0 = 1_700_000_000_000_000_000
UNITS = 1_500  # messages: more than one answer holds


class Leading:
    """The leading station: received records, its actions, and its rounds."""

    def __init__(self, router: MemoryRouter) -> None:
        self.brought: list[tuple[str, bytes]] = []
        self.done: list[Action] = []
        self.stop = Event()
        self.stop_after = 10**9  # messages
        self.there = True
        self.settled = True
        self.written = True
        self.waiting: list[Future[ActionResult]] = []  # time for the records of the actions
        self.bus = router.attach_station()
        self._state = StationState()  # in its log
        self.start()

    def start(self) -> None:
        """Actions before it has the state of its log."""
        self._merging = BranchMerge(
            self.bus,
            self,
            self._bring,
            lambda: self.settled,
            lambda: "b" if self.there else None,
        )

    def run_round(self) -> None:
        self._merging.run_round(self.stop)

    def submit(self, by: str, action: Action, action_id: str = "") -> Future[ActionResult]:
        assert by == STATION_ID
        reported: Future[ActionResult] = Future()
        before = ActionResult.before(self._state, action_id)
        if before is not None:
            reported.set_result(before)
            return reported
        self.done.append(action)
        if self.written:
            done = OperatorAction(Header(STATION_ID, 1, 1, 5), action_id, by, action)
            idempotency.record_result(self._state, done, "")
            reported.set_result(ActionResult("x", T0, None))
        else:
            self.waiting.append(reported)
        return reported

    def _bring(self, key: str, payload: bytes) -> None:
        self.brought.append((key, payload))
        if len(self.brought) >= self.stop_after:
            self.stop.set()


def leading_with(folder: Path, records: Sequence[Record]) -> Leading:
    """A leading station that finds one branch of these records."""
    recorder = Recorder(folder, SystemClock())
    for record in records:
        recorder.write(*record)
    recorder.close()
    set_aside(DataFolder(folder), START)
    router = MemoryRouter()
    PartServer("b", router.attach_station(), folder)
    return Leading(router)


def looking_until(leading: Leading, waits: Callable[[], bool]) -> Thread:
    """A round that has reached that point."""
    looking = Thread(target=leading.run_round)
    looking.start()
    until(waits)
    return looking


def closed_by(person: str) -> Record:
    action = OperatorAction(Header(STATION_ID, 1, 1, 5), person, person, CloseIncident("i1"))
    return T0 + UNITS, OPERATOR.key(STATION_ID), encode(action)


@pytest.fixture
def leading(tmp_path: Path) -> Leading:
    """It finds messages of a unit, and behind them actions of Ada and of the station."""
    stated = [(T0 + number, EVENT.key("u"), b"%d" % number) for number in range(UNITS)]
    return leading_with(tmp_path, [*stated, closed_by("ada"), closed_by(STATION_ID)])


ALL = [(backfilled_key("u", EVENT.suffix), b"%d" % number) for number in range(UNITS)]


def test_messages_of_units_are_added_as_late_ones_and_once(
    leading: Leading, tmp_path: Path
) -> None:
    leading.run_round()
    assert leading.brought == ALL
    assert parts(tmp_path) == []
    leading.run_round()
    assert leading.brought == ALL


def test_actions_of_people_are_recorded_and_not_done(leading: Leading) -> None:
    leading.run_round()
    apart, report = leading.done
    assert apart == DoneApart("b", T0 + UNITS, "ada", "CloseIncident i1")
    assert isinstance(report, ReportProblem)
    assert "people acted at b (1 times)" in report.text


@pytest.mark.parametrize(
    ("action", "what"),
    [
        (
            StartTogether("p1", ("FF-01", "FF-02"), 5, 3.0, 4.0, 1.0, None, None, 0.3, ""),
            "StartTogether p1, FF-01, FF-02, 5, 3.0, 4.0, 1.0, 0.3",
        ),
        (
            SendCommand("c1", CommandKind.TEXT, "", "red", False, "come out", 0.0, 60.0),
            "SendCommand c1, text, red, not everyone, come out, 0.0, 60.0",
        ),
        (ResolveAlarm("a1", "n" * 500), f"ResolveAlarm a1, {'n' * 500}, 0"),
        (Assign("FF-01", "p1", "Ada", "red", "leader"), "Assign FF-01, p1"),
    ],
)
def test_actions_of_people_are_reported_in_words(tmp_path: Path, action: Action, what: str) -> None:
    done = OperatorAction(Header(STATION_ID, 1, 1, 5), "a1", "ada", action)
    leading = leading_with(tmp_path, [(T0, OPERATOR.key(STATION_ID), encode(done))])
    leading.run_round()
    assert leading.done[0] == DoneApart("b", T0, "ada", what)


def test_station_stopped_meanwhile_takes_the_whole_branch_later(
    leading: Leading, tmp_path: Path
) -> None:
    leading.stop_after = 1
    leading.run_round()
    assert len(leading.brought) < UNITS
    assert len(parts(tmp_path)) == 1
    leading.stop.clear()
    leading.stop_after = 10**9
    leading.run_round()
    assert leading.brought[-UNITS:] == ALL
    assert parts(tmp_path) == []


def test_branch_is_not_confirmed_before_its_messages_are_on_the_disk(
    leading: Leading, tmp_path: Path
) -> None:
    leading.settled = False
    looking = looking_until(leading, lambda: leading.brought == ALL)
    looking.join(0.2)
    assert len(parts(tmp_path)) == 1
    leading.settled = True
    looking.join()
    assert parts(tmp_path) == []


def test_branch_is_not_confirmed_before_its_actions_are_recorded(
    leading: Leading, tmp_path: Path
) -> None:
    """A station that failed then would have reported them to nobody."""
    leading.written = False
    looking = looking_until(leading, lambda: len(leading.waiting) == 2)
    for reported in leading.waiting:
        assert len(parts(tmp_path)) == 1
        reported.set_result(ActionResult("x", T0, None))
    looking.join()
    assert parts(tmp_path) == []


def test_actions_are_left_to_the_station_that_leads_by_then(
    leading: Leading, tmp_path: Path
) -> None:
    leading.written = False
    looking = looking_until(leading, lambda: len(leading.waiting) == 2)
    for reported in leading.waiting:
        reported.set_exception(StoreError("the station is stopping"))
    looking.join()
    assert len(parts(tmp_path)) == 1
    leading.written = True
    leading.run_round()
    assert parts(tmp_path) == []
    assert [type(one) for one in leading.done] == [DoneApart, ReportProblem] * 2


@pytest.mark.parametrize("starts_again", [False, True])
def test_repeated_branch_names_its_actions_once(
    leading: Leading, monkeypatch: pytest.MonkeyPatch, starts_again: bool
) -> None:
    with monkeypatch.context() as broken:
        broken.setattr("base_station.standby.branch_merge.mark_merged", lambda *_: None)
        leading.run_round()  # its confirmation was lost
    if starts_again:
        leading.start()
    leading.run_round()
    assert [type(one) for one in leading.done] == [DoneApart, ReportProblem]


def test_station_that_does_not_lead_requests_nothing(leading: Leading, tmp_path: Path) -> None:
    leading.there = False
    leading.run_round()
    assert leading.brought == []
    assert len(parts(tmp_path)) == 1


def test_actions_are_recorded_alone_and_the_alarm_follows(
    tmp_path: Path,
) -> None:
    tick, unread = encode(Tick(Header(STATION_ID, 1, 1, 5), T0)), unread_key("u", 7, 3, "up/later")
    records = [
        (T0, TICK.key(STATION_ID), tick),
        (T0 + 1, OPERATOR.key(STATION_ID), b"\xff nobody can read this"),
        (T0 + 2, unread, b"of a later version"),
        (T0 + UNITS, *closed_by(STATION_ID)[1:]),
    ]
    leading = leading_with(tmp_path, records)
    leading.run_round()
    assert leading.brought == [(unread, b"of a later version")]
    assert leading.done == []
    assert parts(tmp_path) == []


def test_station_stopped_while_the_disk_refuses_reports_nothing(
    leading: Leading, tmp_path: Path
) -> None:
    leading.settled = False
    leading.stop_after = UNITS + 1  # not before all has come
    looking = looking_until(leading, lambda: leading.brought == ALL)
    leading.stop.set()
    looking.join(10.0)
    assert not looking.is_alive()
    assert len(parts(tmp_path)) == 1


@pytest.mark.parametrize("name", [b"", b"..", b"../log", b"20990101"])
def test_records_that_were_not_set_aside_are_neither_given_nor_confirmed(
    leading: Leading, tmp_path: Path, name: bytes
) -> None:
    before = sorted(tmp_path.rglob("*"))
    assert list(ask(leading.bus, "b", "apart/records", name + b" 0")) == []
    assert list(ask(leading.bus, "b", "apart/told", name)) == []
    assert sorted(tmp_path.rglob("*")) == before
