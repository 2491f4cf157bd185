"""Repeated requests of a client are recognised as done: in memory, and from the log."""

from __future__ import annotations

import uuid
from collections.abc import Iterator
from pathlib import Path

import msgspec
import pytest

from base_station.core import idempotency
from base_station.core.erasure.erasure import inserted_action_id
from base_station.core.idempotency import (
    earlier_result,
    erase_reasons,
    is_same_request,
    record_result,
)
from base_station.core.log_position import is_event
from base_station.core.state import ERASED_TEXT, StationState
from base_station.engine.engine import StationEngine
from base_station.engine.feed import LiveFeed
from base_station.engine.station_clock import SteadyClock
from base_station.standby.shared_log import SharedLog
from base_station.standby.standby_feed import StandbyFeed
from base_station.storage.recorder import Recorder
from shared.clock import SystemClock
from shared.coded_text import NO_CODE, coded
from shared.messages import STATION_ID, CommandKind, Header, OperatorAction
from shared.messages.station import (
    Action,
    Assign,
    CheckIn,
    ForgetWearers,
    OpenIncident,
    RegisterUnit,
    SendCommand,
)
from tests.rig.live_station import LiveStation, Screen, make_pipeline, ports_of
from tests.rig.waiting import PATIENCE_S, until

EVACUATE = SendCommand("c1", CommandKind.EVACUATE, "", "", True, "", 0.0, 600.0)
CALL = CheckIn("", "", everyone=True)


def idempotent_action_id(by: str, key: str, asked: bytes) -> str:
    return idempotency.idempotent_action_id(by, key, asked, uuid.uuid4().hex)


def done(action_id: str, action: Action = CALL) -> OperatorAction:
    return OperatorAction(Header(STATION_ID, 1, 1, 0), action_id, "ada", action)


def test_last_keys_are_known(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(idempotency, "KEPT", 3)
    state = StationState()
    ids = [idempotent_action_id("ada", f"k{number}", b"x") for number in range(4)]
    for action_id in ids:
        record_result(state, done(action_id), "")
    known = [earlier_result(state, action_id) is not None for action_id in ids]
    assert known == [False, True, True, True]


def test_action_without_a_key_is_no_repeat() -> None:
    state = StationState()
    record_result(state, done("0000000000000001-7"), "")
    key_and_more = inserted_action_id(
        idempotent_action_id("ada", "k", b"x"), "FF-01"
    )  # by an erasure
    record_result(state, done(key_and_more), "")
    assert state.idempotency_records == {}
    assert earlier_result(state, "0000000000000001-7") is None


def test_key_with_another_action_or_person_is_another_request() -> None:
    state = StationState()
    first = idempotent_action_id("ada", "k", b"x")
    record_result(state, done(first), "")
    for again, same in (
        (idempotent_action_id("ada", "k", b"x"), True),
        (idempotent_action_id("ada", "k", b"y"), False),
    ):
        before = earlier_result(state, again)
        assert before is not None
        assert (before.action_id, is_same_request(again, before.action_id)) == (first, same)
    assert earlier_result(state, idempotent_action_id("mia", "k", b"x")) is None


def test_reasons_of_refusals_are_erased_with_the_person_they_name() -> None:
    state = StationState()
    refused, well = idempotent_action_id("ada", "a", b""), idempotent_action_id("ada", "b", b"")
    record_result(state, done(refused), coded("rests", "{name} is resting already", name="Ada"))
    record_result(state, done(well), "")
    erase_reasons(state)
    results = state.idempotency_records.values()
    assert [one.refused for one in results] == [ERASED_TEXT, ""]
    assert [one.refused_code for one in results] == [NO_CODE, NO_CODE]


def test_restarted_station_answers_repeated_requests(tmp_path: Path) -> None:
    opened, reported, refused = (idempotent_action_id("ada", key, b"x") for key in ("i", "c", "r"))
    with LiveStation(tmp_path) as station:
        station.act(RegisterUnit("FF-01", "one"))
        station.act(Assign("FF-01", "p1", "Ada", "A", ""))
        station.act(OpenIncident("i1", "Kitchen"), action_id=opened)
        first = station.act(EVACUATE, action_id=reported)
        why = station.act(OpenIncident("i2", "Cellar"), action_id=refused).refused
        assert why is not None
    for path in tmp_path.joinpath("checkpoints").iterdir():
        path.unlink()  # from the log alone
    with LiveStation(tmp_path) as station:
        anew = msgspec.structs.replace(EVACUATE, command_id="c2")
        again = station.act(anew, action_id=idempotent_action_id("ada", "c", b"x"))
        assert again == first
        assert again.created_id == "c1"
        assert list(station.pipeline.state.commands) == ["c1"]
        cellar = OpenIncident("i2", "Cellar")
        assert station.act(cellar, action_id=idempotent_action_id("ada", "r", b"x")).refused == why
        assert station.act(OpenIncident("i3", ""), action_id=opened).created_id == "i1"


@pytest.fixture
def standby(tmp_path: Path) -> Iterator[tuple[StationEngine, StandbyFeed]]:
    """A standby that follows, whatever is delivered."""
    clock = SteadyClock(SystemClock())
    recorder = Recorder(tmp_path / "standby", clock)
    feed = StandbyFeed(LiveFeed(clock), clock)
    ports = ports_of(feed, SharedLog(recorder, clock), Screen(), tmp_path / "saved", clock)
    drive = StationEngine(make_pipeline(), ports)
    drive.start()
    yield drive, feed
    drive.stop()
    feed.close()
    recorder.close()


def test_standby_answers_requests_repeated_from_the_other_station(
    tmp_path: Path, standby: tuple[StationEngine, StandbyFeed]
) -> None:
    reported, refused = (
        idempotent_action_id("ada", "c", b"x"),
        idempotent_action_id("ada", "r", b"x"),
    )
    with LiveStation(tmp_path / "leader") as leader:
        leader.act(RegisterUnit("FF-01", "one"))
        leader.act(Assign("FF-01", "p1", "Ada", "A", ""))
        first = leader.act(EVACUATE, action_id=reported)
        why = leader.act(Assign("FF-02", "p1", "Ada", "A", ""), action_id=refused).refused
        leader.recorder.flush()
        followed = [record for record in leader.log.records() if is_event(record[1])]
    drive, feed = standby
    feed.deliver(followed)
    feed.lead()
    until(lambda: not feed.follows)
    anew = msgspec.structs.replace(EVACUATE, command_id="c2")
    again = drive.submit("ada", anew, idempotent_action_id("ada", "c", b"x")).result(PATIENCE_S)
    assert again == first
    worn = Assign("FF-02", "p1", "Ada", "A", "")
    again = drive.submit("ada", worn, idempotent_action_id("ada", "r", b"x")).result(PATIENCE_S)
    assert why is not None
    assert again.refused == why
    other = drive.submit("mia", anew, idempotent_action_id("mia", "c", b"x")).result(PATIENCE_S)
    assert other.created_id == "c2", "a key counts for who sent it"


def test_request_during_replication_waits_for_the_end_of_the_other_stations_log(
    tmp_path: Path, standby: tuple[StationEngine, StandbyFeed]
) -> None:
    with LiveStation(tmp_path / "leader") as leader:
        leader.act(RegisterUnit("FF-01", "one"))
        leader.act(Assign("FF-01", "p1", "Ada", "A", ""))
        leader.recorder.flush()
        followed = [record for record in leader.log.records() if is_event(record[1])]
    drive, feed = standby
    asked = drive.submit("ada", EVACUATE)
    looked: list[object] = []
    drive.request_snapshot(lambda picture, _: looked.append(picture))
    until(lambda: bool(looked))
    feed.deliver(followed)
    feed.lead()
    done = asked.result(PATIENCE_S)
    assert done.refused is None, "half of the log does not know the unit"


def test_engine_erases_the_texts_of_refusals(tmp_path: Path) -> None:
    key = idempotent_action_id("ada", "k", b"x")
    with LiveStation(tmp_path) as station:
        station.act(RegisterUnit("FF-01", "one"))
        station.act(Assign("FF-02", "p1", "Ada", "A", ""), action_id=key)
        station.act(ForgetWearers("FF-01"))
        again = station.act(Assign("FF-02", "p1", "Ada", "A", ""), action_id=key)
    assert again.refused is not None
    assert again.refused.reason == ERASED_TEXT
