"""What a client asks for again is known to have been done: in memory, and from the log."""

from __future__ import annotations

import uuid
from collections.abc import Iterator
from pathlib import Path

import msgspec
import pytest

from base_station import once
from base_station.clocks.steady import SteadyClock
from base_station.drive import StationDrive
from base_station.feed import LiveFeed
from base_station.forgetting.erasure import id_put_in
from base_station.live_state import FORGOTTEN, StationState
from base_station.once import asks_the_same, done_before, forget_words, note_done
from base_station.standby.places import is_event
from base_station.standby.shared_log import SharedLog
from base_station.standby.standby_feed import StandbyFeed
from base_station.storage.recorder import Recorder
from shared.clock import SystemClock
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
from tests.live_station import LiveStation, Screen, make_pipeline, ports_of
from tests.waiting import PATIENCE_S, until

EVACUATE = SendCommand("c1", CommandKind.EVACUATE, "", "", True, "", 0.0, 600.0)
CALL = CheckIn("", "", everyone=True)


def once_id(by: str, key: str, asked: bytes) -> str:
    return once.once_id(by, key, asked, uuid.uuid4().hex)


def done(action_id: str, action: Action = CALL) -> OperatorAction:
    return OperatorAction(Header(STATION_ID, 1, 1, 0), action_id, "ada", action)


def test_the_last_keys_are_known(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(once, "KEPT", 3)
    state = StationState()
    ids = [once_id("ada", f"k{number}", b"x") for number in range(4)]
    for action_id in ids:
        note_done(state, done(action_id), "")
    known = [done_before(state, action_id) is not None for action_id in ids]
    assert known == [False, True, True, True]


def test_an_action_without_a_key_is_nothing_that_was_asked_before() -> None:
    state = StationState()
    note_done(state, done("0000000000000001-7"), "")
    key_and_more = id_put_in(once_id("ada", "k", b"x"), "FF-01")  # by a forgetting
    note_done(state, done(key_and_more), "")
    assert state.done_once == {}
    assert done_before(state, "0000000000000001-7") is None


def test_one_key_with_another_wish_or_of_another_person_is_another_request() -> None:
    state = StationState()
    first = once_id("ada", "k", b"x")
    note_done(state, done(first), "")
    for again, same in ((once_id("ada", "k", b"x"), True), (once_id("ada", "k", b"y"), False)):
        before = done_before(state, again)
        assert before is not None
        assert (before.action_id, asks_the_same(again, before.action_id)) == (first, same)
    assert done_before(state, once_id("mia", "k", b"x")) is None


def test_why_something_was_refused_is_forgotten_with_whom_it_names() -> None:
    state = StationState()
    refused, well = once_id("ada", "a", b""), once_id("ada", "b", b"")
    note_done(state, done(refused), "Ada is resting already")
    note_done(state, done(well), "")
    forget_words(state)
    assert [one.refused for one in state.done_once.values()] == [FORGOTTEN, ""]


def test_a_station_that_was_started_again_knows_what_was_done(tmp_path: Path) -> None:
    opened, told, refused = (once_id("ada", key, b"x") for key in ("i", "c", "r"))
    with LiveStation(tmp_path) as station:
        station.act(RegisterUnit("FF-01", "one"))
        station.act(Assign("FF-01", "p1", "Ada", "A", ""))
        station.act(OpenIncident("i1", "Kitchen"), action_id=opened)
        first = station.act(EVACUATE, action_id=told)
        why = station.act(OpenIncident("i2", "Cellar"), action_id=refused).refused
        assert why is not None
    for path in tmp_path.joinpath("checkpoints").iterdir():
        path.unlink()  # the log alone tells
    with LiveStation(tmp_path) as station:
        anew = msgspec.structs.replace(EVACUATE, command_id="c2")
        again = station.act(anew, action_id=once_id("ada", "c", b"x"))
        assert again == first
        assert again.made_id == "c1"
        assert list(station.pipeline.state.commands) == ["c1"]
        cellar = OpenIncident("i2", "Cellar")
        assert station.act(cellar, action_id=once_id("ada", "r", b"x")).refused == why
        assert station.act(OpenIncident("i3", ""), action_id=opened).made_id == "i1"


@pytest.fixture
def standby(tmp_path: Path) -> Iterator[tuple[StationDrive, StandbyFeed]]:
    """It follows, whatever is delivered."""
    clock = SteadyClock(SystemClock())
    recorder = Recorder(tmp_path / "standby", clock)
    feed = StandbyFeed(LiveFeed(clock), clock)
    ports = ports_of(feed, SharedLog(recorder, clock), Screen(), tmp_path / "saved", clock)
    drive = StationDrive(make_pipeline(), ports)
    drive.start()
    yield drive, feed
    drive.stop()
    feed.close()
    recorder.close()


def test_a_standby_that_takes_over_knows_what_was_done_at_the_other_station(
    tmp_path: Path, standby: tuple[StationDrive, StandbyFeed]
) -> None:
    told, refused = once_id("ada", "c", b"x"), once_id("ada", "r", b"x")
    with LiveStation(tmp_path / "leader") as leader:
        leader.act(RegisterUnit("FF-01", "one"))
        leader.act(Assign("FF-01", "p1", "Ada", "A", ""))
        first = leader.act(EVACUATE, action_id=told)
        why = leader.act(Assign("FF-02", "p1", "Ada", "A", ""), action_id=refused).refused
        leader.recorder.flush()
        followed = [record for record in leader.log.records() if is_event(record[1])]
    drive, feed = standby
    feed.deliver(followed)
    feed.lead()
    until(lambda: not feed.follows)
    anew = msgspec.structs.replace(EVACUATE, command_id="c2")
    again = drive.submit("ada", anew, once_id("ada", "c", b"x")).result(PATIENCE_S)
    assert again == first
    worn = Assign("FF-02", "p1", "Ada", "A", "")
    again = drive.submit("ada", worn, once_id("ada", "r", b"x")).result(PATIENCE_S)
    assert why is not None
    assert again.refused == why
    other = drive.submit("mia", anew, once_id("mia", "c", b"x")).result(PATIENCE_S)
    assert other.made_id == "c2", "a key counts for who sent it"


def test_what_is_asked_while_the_other_station_s_log_is_followed_waits_for_its_end(
    tmp_path: Path, standby: tuple[StationDrive, StandbyFeed]
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


def test_the_drive_forgets_the_words_of_refusals(tmp_path: Path) -> None:
    key = once_id("ada", "k", b"x")
    with LiveStation(tmp_path) as station:
        station.act(RegisterUnit("FF-01", "one"))
        station.act(Assign("FF-02", "p1", "Ada", "A", ""), action_id=key)
        station.act(ForgetWearers("FF-01"))
        again = station.act(Assign("FF-02", "p1", "Ada", "A", ""), action_id=key)
    assert again.refused is not None
    assert again.refused.reason == FORGOTTEN
