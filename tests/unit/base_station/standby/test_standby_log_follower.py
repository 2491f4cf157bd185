"""A standby fetches the other station's log, from any place and over any link, and confirms it."""

from __future__ import annotations

import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from base_station.core.log_position import START, LogPosition
from base_station.engine.feed import LiveFeed
from base_station.engine.station_clock import SteadyClock
from base_station.standby.log_follower import Leader, LogFollower
from base_station.standby.log_sender import LogSender
from base_station.standby.protocol import ReplicationAck, key_of, unpack
from base_station.standby.shared_log import SharedLog
from base_station.standby.standby_feed import StandbyFeed
from base_station.storage.recorder import Recorder
from shared.bus_memory import MemoryRouter
from shared.clock import SystemClock
from shared.messages.station import TakeOver
from tests.rig.standby_logs import T0, TICKED, disk, events, written
from tests.rig.waiting import until


class Pairing:
    """A leading log, and one that follows it."""

    def __init__(self, folder: Path) -> None:
        clock = SteadyClock(SystemClock())
        self.router = router = MemoryRouter()
        self.recorders = [Recorder(folder / name, clock) for name in "ab"]
        self.active, self.standby = (SharedLog(one, clock) for one in self.recorders)
        self.feed = StandbyFeed(LiveFeed(clock), clock)
        self.cuts: list[LogPosition] = []
        self.shipping = self.ship()
        self.follower = LogFollower(
            "b", router.attach_station(), self.standby, self.feed, self.cuts.append
        )

    def ship(self) -> LogSender:
        bus = self.router.attach_station()
        return LogSender("a", bus, self.active, disk(self.recorders[0]), lambda: True)

    def step(self) -> None:
        """Work of an engine."""
        for record in self.feed.take(0.01):
            self.standby.write(*record)

    def close(self) -> None:
        self.feed.close()
        self.follower.close()
        self.shipping.close()
        for one in self.recorders:
            one.close()


@pytest.fixture
def pairing(tmp_path: Path) -> Iterator[Pairing]:
    pairing = Pairing(tmp_path)
    yield pairing
    pairing.close()


def test_standby_fetches_earlier_records_and_continues(pairing: Pairing) -> None:
    written(pairing.recorders[0], pairing.active, events(30))
    # As after a restart of the leading station: the past is on its disk only.
    restarted = SharedLog(pairing.recorders[0], SystemClock())
    restarted.begin(pairing.active.place, T0, ())
    pairing.shipping._log = restarted
    pairing.follower.start()
    pairing.follower.follow(Leader("a", 1))

    def caught_up() -> bool:
        pairing.step()
        return pairing.standby.place == restarted.place

    until(caught_up)
    written(pairing.recorders[0], restarted, events(30, start=30))
    until(caught_up)
    until(lambda: pairing.standby.durable == restarted.place)
    pairing.recorders[1].flush()
    assert [r for r in disk(pairing.recorders[1]).records() if r[1] == TICKED] == events(60)
    assert pairing.cuts == []


def test_records_waiting_to_be_stepped_are_not_fetched_again_after_a_lost_link(
    pairing: Pairing,
) -> None:
    """The leading station does not answer for a moment while this one catches up."""
    written(pairing.recorders[0], pairing.active, events(30))
    pairing.follower.start()
    pairing.follower.follow(Leader("a", 1))
    until(lambda: pairing.feed.waiting == 30)
    pairing.shipping.close()
    time.sleep(1.0)  # it asks, and begins anew
    pairing.shipping = pairing.ship()
    written(pairing.recorders[0], pairing.active, events(30, start=30))
    time.sleep(1.0)

    def caught_up() -> bool:
        pairing.step()
        return pairing.standby.place == pairing.active.place

    until(caught_up)
    pairing.recorders[1].flush()
    assert [r for r in disk(pairing.recorders[1]).records() if r[1] == TICKED] == events(60)


def test_standby_is_in_step_when_it_has_stepped_a_long_log_and_not_before(
    pairing: Pairing,
) -> None:
    written(pairing.recorders[0], pairing.active, events(5000))
    pairing.follower.start()
    pairing.follower.follow(Leader("a", 1))
    until(lambda: pairing.follower.delivered == pairing.active.place)
    written(pairing.recorders[0], pairing.active, events(3, start=5000))
    until(lambda: pairing.follower.delivered == pairing.active.place)
    assert not pairing.follower.in_step

    def stepped() -> bool:
        pairing.step()
        return pairing.standby.place == pairing.active.place

    until(stepped)
    written(pairing.recorders[0], pairing.active, events(3, start=5003))
    until(lambda: pairing.follower.in_step)


def test_diverged_log_is_to_be_cut_and_nothing_is_fetched(pairing: Pairing) -> None:
    shared = events(6)
    for recorder, log in zip(pairing.recorders, (pairing.active, pairing.standby), strict=True):
        written(recorder, log, shared)
    place = pairing.active.place
    pairing.active.begin(place, T0, [TakeOver(2, "a", place.t_ns, place.events)])
    pairing.standby.write(T0 + 50, TICKED, b"apart")
    pairing.follower.start()
    pairing.follower.follow(Leader("a", 1))
    until(lambda: pairing.cuts != [])
    time.sleep(0.5)  # it is reported once
    assert pairing.cuts == [place]
    pairing.step()
    assert pairing.standby.place == LogPosition(T0 + 50, 1)


def test_diverged_log_confirms_nothing(pairing: Pairing) -> None:
    """It may be longer than the leader's, which would take all records for safe."""
    for recorder, log in zip(pairing.recorders, (pairing.active, pairing.standby), strict=True):
        written(recorder, log, events(6))
    place = pairing.active.place
    pairing.active.begin(place, T0, [TakeOver(2, "a", place.t_ns, place.events)])
    pairing.standby.write(T0 + 50, TICKED, b"apart")
    stated: list[ReplicationAck] = []
    subscribed = pairing.router.attach_station().subscribe(
        key_of("b", "have"), lambda _, payload: stated.append(unpack(payload, ReplicationAck))
    )
    pairing.follower.start()
    pairing.follower.follow(Leader("a", 1))
    until(lambda: pairing.cuts != [])
    pairing.active.begin(place, T0, ())
    written(pairing.recorders[0], pairing.active, [(T0 + 50, TICKED, b"apart")])
    pairing.follower.follow(Leader("a", 2))
    until(lambda: stated != [])
    assert {have.run for have in stated} == {2}
    subscribed.close()


def test_reason_for_not_following_is_no_problem_of_a_leader(
    pairing: Pairing,
) -> None:
    for recorder, log, number in zip(
        pairing.recorders, (pairing.active, pairing.standby), (0, 1), strict=True
    ):
        written(recorder, log, events(6 + number)[number:])
    pairing.follower.start()
    pairing.follower.follow(Leader("a", 1))
    until(lambda: "the log of another station" in pairing.follower.problem)
    pairing.follower.stop_following()
    assert pairing.follower.problem == ""


def test_nothing_is_delivered_once_following_was_stopped(pairing: Pairing) -> None:
    pairing.follower.start()
    pairing.follower.follow(Leader("a", 1))
    pairing.follower.stop_following()
    written(pairing.recorders[0], pairing.active, events(3))
    assert list(pairing.feed.take(0.5)) == []


def test_answer_in_transit_when_following_was_stopped_is_not_delivered(
    pairing: Pairing, monkeypatch: pytest.MonkeyPatch
) -> None:
    follower, ask, asked = pairing.follower, pairing.follower._ask, list[str]()

    def stopped_meanwhile(leader: Leader, what: str, kind: type[Any]) -> Any:
        answer = ask(leader, what, kind)
        if what.startswith("records"):
            follower.follow(None)
            asked.append(what)
        return answer

    monkeypatch.setattr(follower, "_ask", stopped_meanwhile)
    written(pairing.recorders[0], pairing.active, events(3))
    follower.start()
    follower.follow(Leader("a", 1))
    until(lambda: asked)
    assert list(pairing.feed.take(0.5)) == []
    assert follower.delivered == START
