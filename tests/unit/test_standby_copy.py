"""A standby's copy of the log: served from any place, fetched, and cut."""

from __future__ import annotations

import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from base_station.data_folder import DataFolder
from base_station.feed import LiveFeed, LogFeed
from base_station.recorder import Recorder
from base_station.standby.following import Follower, Leader
from base_station.standby.places import BEGINNING, Place, events_behind
from base_station.standby.setting_aside import mark_told, parts, read_part, set_aside
from base_station.standby.shared_log import SharedLog
from base_station.standby.shipping import Shipping
from base_station.standby.standby_feed import StandbyFeed
from base_station.standby.words import Have, key_of, unpack
from base_station.steady_clock import SteadyClock
from shared.bus_memory import MemoryRouter
from shared.channels import ALARM, FUSED, OPERATOR, TICK
from shared.clock import NS_PER_S, ManualClock, SystemClock
from shared.codec import encode
from shared.messages import STATION_ID, Header, OperatorAction
from shared.messages.station import ForgetWearers, TakeOver
from tests.waiting import until

Record = tuple[int, str, bytes]
T0 = 1_700_000_000_000_000_000
TICKED = TICK.key(STATION_ID)


def events(count: int, start: int = 0) -> list[Record]:
    """Every third has the time of the one before it, and decisions stand between them."""
    return [
        (T0 + number - (number % 3 == 2), TICKED, b"event %d" % number)
        for number in range(start, start + count)
    ]


def written(recorder: Recorder, log: SharedLog, records: list[Record]) -> None:
    for t_ns, key, payload in records:
        log.write(t_ns, key, payload)
        log.write(t_ns, FUSED.key(STATION_ID), b"decided")
    assert recorder.flush()


@pytest.fixture
def recorder(tmp_path: Path) -> Iterator[Recorder]:
    recorder = Recorder(tmp_path, SystemClock())
    yield recorder
    recorder.close()


@pytest.fixture
def log(recorder: Recorder) -> SharedLog:
    return SharedLog(recorder, SystemClock())


def disk(recorder: Recorder) -> LogFeed:
    return LogFeed(recorder.folder, recorder.flush)


def test_a_place_counts_events_and_not_what_was_decided(recorder: Recorder, log: SharedLog) -> None:
    written(recorder, log, events(6))
    assert log.place == Place(T0 + 4, 2)
    log.write(T0 + 9, ALARM.key(STATION_ID), b"decided")
    assert log.place == Place(T0 + 4, 2)


def test_what_stands_behind_any_place_is_served_from_memory_as_from_the_disk(
    recorder: Recorder, log: SharedLog
) -> None:
    records = events(20)
    written(recorder, log, records)
    place = BEGINNING
    for done in range(len(records) + 1):
        assert log.behind(place, 10**6) == records[done:]
        assert list(events_behind(place, disk(recorder).records(place.t_ns))) == records[done:]
        if done < len(records):
            place = place.then(records[done][0])


def test_what_is_no_longer_at_hand_is_said_to_be_on_the_disk_only(
    recorder: Recorder, log: SharedLog
) -> None:
    written(recorder, log, events(3))
    later = SharedLog(recorder, SystemClock())
    later.begin(log.place, T0, ())
    assert later.behind(BEGINNING, 10**6) is None
    assert later.behind(log.place, 10**6) == []


def test_nothing_stays_in_memory_of_who_is_to_be_forgotten(
    recorder: Recorder, log: SharedLog
) -> None:
    written(recorder, log, events(3))
    forget = OperatorAction(Header(STATION_ID, 1, 1, 5), "x", "ada", ForgetWearers("u"))
    log.write(T0 + 9, OPERATOR.key(STATION_ID), encode(forget))
    assert log.behind(Place(T0, 1), 10**6) is None
    assert log.behind(log.place, 10**6) == []


def test_of_a_long_log_the_newest_stay_at_hand_and_the_rest_is_said_to_be_on_the_disk(
    recorder: Recorder, log: SharedLog, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("base_station.standby.shared_log._RECENT_BYTES", 300)
    records = [(t_ns, key, bytes(size)) for size, (t_ns, key, _) in enumerate(events(60))]
    written(recorder, log, records)
    place, at_hand = BEGINNING, []
    for done in range(len(records) + 1):
        found = log.behind(place, 10**6)
        assert found in (None, records[done:])
        at_hand.append(found is not None)
        if done < len(records):
            place = place.then(records[done][0])
    assert at_hand == sorted(at_hand)
    kept_bytes = sum(len(payload) for _, _, payload in records[at_hand.index(True) :])
    assert 240 < kept_bytes <= 600  # between what is left and what makes it forget


def test_no_more_is_given_at_once_than_was_asked_for_but_always_something(
    recorder: Recorder, log: SharedLog
) -> None:
    records = events(10)  # of seven bytes each
    written(recorder, log, records)
    given = [len(log.behind(BEGINNING, most) or []) for most in (0, 1, 7, 8, 14, 15)]
    assert given == [1, 1, 1, 2, 2, 3]


def test_the_term_is_that_of_the_last_take_over_also_one_that_came_later(
    recorder: Recorder, log: SharedLog
) -> None:
    assert (log.term, log.take_overs) == (0, ())
    log.begin(BEGINNING, T0, [TakeOver(3, "a", T0, 1)])
    assert log.term == 3
    action = OperatorAction(Header(STATION_ID, 1, 1, 5), "x", "b", TakeOver(4, "b", T0, 2))
    log.write(T0 + 9, OPERATOR.key(STATION_ID), encode(action))
    log.write(T0 + 9, OPERATOR.key(STATION_ID), b"\xff nobody can read this")
    assert log.term == 4
    assert [one.term for one in log.take_overs] == [3, 4]
    assert recorder.flush()


class Pairing:
    """An active log, and one that follows it."""

    def __init__(self, folder: Path) -> None:
        clock = SteadyClock(SystemClock())
        self.router = router = MemoryRouter()
        self.recorders = [Recorder(folder / name, clock) for name in "ab"]
        self.active, self.standby = (SharedLog(one, clock) for one in self.recorders)
        self.feed = StandbyFeed(LiveFeed(clock), clock)
        self.cuts: list[Place] = []
        self.shipping = self.ship()
        self.follower = Follower(
            "b", router.attach_station(), self.standby, self.feed, self.cuts.append
        )

    def ship(self) -> Shipping:
        bus = self.router.attach_station()
        return Shipping("a", bus, self.active, disk(self.recorders[0]), lambda: True)

    def step(self) -> None:
        """What a drive does."""
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


class FullDisk:
    """A ``Log`` that takes as much as it has room for."""

    problem, little_room = "the log cannot be written", "only 1 MB is free"
    is_behind = False

    def __init__(self) -> None:
        self.room = 0
        self.kept: list[Record] = []

    def write(self, t_ns: int, key: str, payload: bytes) -> bool:
        self.room -= 1
        if self.room >= 0:
            self.kept.append((t_ns, key, payload))
        return self.room >= 0

    def flush(self) -> bool:
        return True


def test_a_log_that_follows_ends_where_the_disk_refused_and_has_no_hole() -> None:
    disk, clock = FullDisk(), ManualClock()
    log = SharedLog(disk, clock)
    log.follows = True
    disk.room = 3
    kept = []
    for number, (t_ns, key, payload) in enumerate(events(9)):
        if number == 6:
            disk.room = 100
        kept.append(log.write(t_ns, key, payload))
    assert kept == [True] * 3 + [False] * 6
    assert (log.problem, log.little_room) == (disk.problem, disk.little_room)
    assert log.is_cut_short
    assert disk.kept == events(9)[:3]
    assert log.behind(BEGINNING, 10**6) == events(9)[:3]


def test_a_log_that_leads_goes_on_behind_what_the_disk_refused_and_ships_what_it_has() -> None:
    disk, clock = FullDisk(), ManualClock()
    log = SharedLog(disk, clock)
    disk.room, said = 3, events(9)
    for t_ns, key, payload in said[:6]:
        clock.advance(1.0)
        log.write(t_ns, key, payload)
    assert clock.monotonic_ns() - log.written_ns == 3 * NS_PER_S  # silent like one that hangs
    disk.room = 100
    for record in said[6:]:
        log.write(*record)
    assert not log.is_cut_short
    assert log.behind(BEGINNING, 10**6) == disk.kept == [*said[:3], *said[6:]]


def test_a_standby_fetches_what_was_before_it_and_goes_on(pairing: Pairing) -> None:
    written(pairing.recorders[0], pairing.active, events(30))
    # As after a restart of the active station: the past is on its disk only.
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


def test_what_waits_to_be_stepped_is_not_fetched_again_when_the_link_comes_back(
    pairing: Pairing,
) -> None:
    """The active station does not answer for a moment while this one catches up."""
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


def test_a_standby_is_in_step_when_it_has_stepped_a_long_log_and_not_before(
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


def test_a_log_that_went_its_own_way_is_to_be_cut_and_nothing_is_fetched(pairing: Pairing) -> None:
    shared = events(6)
    for recorder, log in zip(pairing.recorders, (pairing.active, pairing.standby), strict=True):
        written(recorder, log, shared)
    place = pairing.active.place
    pairing.active.begin(place, T0, [TakeOver(2, "a", place.t_ns, place.events)])
    pairing.standby.write(T0 + 50, TICKED, b"apart")
    pairing.follower.start()
    pairing.follower.follow(Leader("a", 1))
    until(lambda: pairing.cuts != [])
    time.sleep(0.5)  # it is told once
    assert pairing.cuts == [place]
    pairing.step()
    assert pairing.standby.place == Place(T0 + 50, 1)


def test_a_log_that_went_its_own_way_confirms_nothing(pairing: Pairing) -> None:
    """It may reach farther than the leader's, which would take all that comes for safe."""
    for recorder, log in zip(pairing.recorders, (pairing.active, pairing.standby), strict=True):
        written(recorder, log, events(6))
    place = pairing.active.place
    pairing.active.begin(place, T0, [TakeOver(2, "a", place.t_ns, place.events)])
    pairing.standby.write(T0 + 50, TICKED, b"apart")
    said: list[Have] = []
    subscribed = pairing.router.attach_station().subscribe(
        key_of("b", "have"), lambda _, payload: said.append(unpack(payload, Have))
    )
    pairing.follower.start()
    pairing.follower.follow(Leader("a", 1))
    until(lambda: pairing.cuts != [])
    pairing.active.begin(place, T0, ())
    written(pairing.recorders[0], pairing.active, [(T0 + 50, TICKED, b"apart")])
    pairing.follower.follow(Leader("a", 2))
    until(lambda: said != [])
    assert {have.run for have in said} == {2}
    subscribed.close()


def test_what_kept_it_from_following_is_no_trouble_of_a_station_that_leads(
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


def test_nothing_is_delivered_any_more_once_following_was_stopped(pairing: Pairing) -> None:
    pairing.follower.start()
    pairing.follower.follow(Leader("a", 1))
    pairing.follower.stop_following()
    written(pairing.recorders[0], pairing.active, events(3))
    assert list(pairing.feed.take(0.5)) == []


def test_an_answer_that_was_under_way_when_following_was_stopped_is_not_delivered(
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
    assert follower.delivered == BEGINNING


@pytest.mark.parametrize("kept", [0, 1, 7, 20])
def test_a_cut_log_holds_what_stands_up_to_the_place_and_the_rest_is_beside(
    tmp_path: Path, kept: int
) -> None:
    records = events(20)
    recorder = Recorder(tmp_path, SystemClock())
    written(recorder, SharedLog(recorder, SystemClock()), records)
    recorder.close()
    place = BEGINNING
    for t_ns, _, _ in records[:kept]:
        place = place.then(t_ns)
    folder = DataFolder(tmp_path)
    set_aside(folder, place)
    left = list(LogFeed(folder.log).records())
    assert [record for record in left if record[1] == TICKED] == records[:kept]
    assert len(left) == 2 * kept  # with what was decided
    (name,) = parts(tmp_path)
    assert list(read_part(tmp_path, name)) == records[kept:]
    mark_told(tmp_path, name)
    assert parts(tmp_path) == []


def test_a_log_goes_on_behind_a_cut_and_may_be_cut_there_again(tmp_path: Path) -> None:
    records = events(9)
    for begin, apart in ((0, b"once"), (9, b"twice")):
        recorder = Recorder(tmp_path, SystemClock())
        strays = [(T0 + 10, TICKED, apart)]
        written(recorder, SharedLog(recorder, SystemClock()), records[begin:] + strays)
        recorder.close()
        set_aside(DataFolder(tmp_path), Place(T0 + 7, 2))
    recorder = Recorder(tmp_path, SystemClock())
    written(recorder, SharedLog(recorder, SystemClock()), events(3, start=9))
    recorder.close()
    kept = [r for r in LogFeed(tmp_path / "log").records() if r[1] == TICKED]
    assert kept == events(12)
    said = [[payload for _, _, payload in read_part(tmp_path, name)] for name in parts(tmp_path)]
    assert said == [[b"once"], [b"twice"]]
