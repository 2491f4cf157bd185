"""Backfilled messages solve a pinned trail again, and not for each message."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from base_station.core.events import PinsChanged, TrailBackfilled
from base_station.core.state.resolve_queue import PendingResolve, pop_due, request_resolve
from base_station.replay.playback import compare
from shared.channels import GPS, POSITION, backfilled_key, channel_of
from shared.clock import NS_PER_S
from shared.codec import encode
from shared.geo import Anchor
from shared.messages import STATION_ID, AlarmChange, FusedPosition, GpsFix, Header, Position
from shared.messages.pins import RemovePin, SetPin
from shared.messages.station import OpenIncident, SetAnchor, SetPlan, SetStart
from tests.rig import message_factory
from tests.rig.live_station import make_pipeline
from tests.rig.station_script import Script

ANCHOR = Anchor(52.0, 4.0, 0.0, 0.0)
PLAN = b"""{"type":"FeatureCollection",
"muster":{"frame":"site-m","floors":[{"floor":0,"down_m":0}]},
"features":[{"type":"Feature","properties":{"kind":"outline","floor":0},"geometry":{"type":"Polygon",
"coordinates":[[[-9,10],[9,10],[9,150],[-9,150],[-9,10]]]}},
{"type":"Feature","properties":{"kind":"wall","floor":0},"geometry":{"type":"LineString",
"coordinates":[[0.5,20],[0.5,150]]}}]}"""
TURN_RAD_PER_M = 0.004  # the unit's own path turns by it while there is no contact


class Walker:
    """A wearer who walks 60 m north with a link, 60 m without, and 20 m with one; missed messages
    are backfilled a minute later.
    """

    def __init__(self) -> None:
        self.script = Script()
        script = self.script
        script.register("FF-01")
        script.act(OpenIncident("i1", "Mill Lane"))
        script.act(SetAnchor(ANCHOR.lat_deg, ANCHOR.lon_deg, 0.0, 0.0))
        script.act(SetStart("FF-01", 0.0, 0.0, 0.0, 0.0, 0.5, 0.05))
        self.missed: list[Position | GpsFix] = []
        east_m = 0.0
        for second in range(1, 141):
            script.now_s += 1.0
            away = 60 < second <= 120
            east_m += TURN_RAD_PER_M * (second - 60) if away else 0.0
            own = message_factory.position(
                script.header("FF-01"),
                north_m=float(second),
                east_m=east_m,
                distance_m=float(second),
            )
            if away:
                self.missed.append(own)
                self.missed.append(self.fix(script.header("FF-01"), float(second)))
            else:
                script.say(own)
        self.pin_ns = script.t_ns
        script.act(SetPin("p1", "FF-01", self.pin_ns, 140.0, 0.0, 0.5, None, None, 0.0, ""))

    def fix(self, header: Header, north_m: float) -> GpsFix:
        lat_deg, lon_deg, _ = ANCHOR.to_geodetic(north_m, 0.0, 0.0)
        return message_factory.gps_fix(header, lat_deg, lon_deg, horizontal_std_m=1.0)

    def backfill(self) -> Iterator[list[object]]:
        """One message at a time, ten a second."""
        for number, message in enumerate(self.missed):
            self.script.now_s += 0.1
            channel = POSITION if isinstance(message, Position) else GPS
            key = backfilled_key("FF-01", channel.suffix)
            yield list(self.script.record(key, encode(message)))
            if number % 10 == 9:
                self.script.tick()

    def solved(self) -> int:
        return sum(isinstance(one, TrailBackfilled) for one in self.script.tick())

    def worst_off_m(self) -> float:
        """Largest error of the missed part."""
        begin_ns = self.script.records[0][0]
        trail = self.script.pipeline.state.units["FF-01"].trails.shown
        return max(abs(one.east_m) for one in trail if 60 < (one.t_ns - begin_ns) / NS_PER_S <= 120)


@pytest.fixture
def walker() -> Walker:
    return Walker()


def test_late_fixes_correct_the_pinned_trail_once_all_are_there(walker: Walker) -> None:
    for _ in walker.backfill():
        pass
    walker.script.now_s += 3.0
    assert walker.solved() == 1
    assert walker.worst_off_m() < 2.0
    assert walker.solved() == 0


def test_late_messages_count_without_the_pin(walker: Walker) -> None:
    plain = Walker()
    plain.script.act(RemovePin("p1"))
    for one in (walker, plain):
        for _ in one.backfill():
            pass
    walker.script.act(RemovePin("p1"))
    trails = [one.script.pipeline.state.units["FF-01"].trails.shown for one in (walker, plain)]
    assert trails[0] == trails[1]


def test_journal_of_hundreds_is_solved_now_and_then(walker: Walker) -> None:
    """A hundred and twenty messages in twelve seconds."""
    ticks = len(walker.script.outputs)
    for _ in walker.backfill():
        pass
    walker.script.wait(5.0)
    solutions = [one for one in walker.script.outputs[ticks:] if isinstance(one, PinsChanged)]
    assert 1 <= len(solutions) <= 6
    assert len(walker.missed) == 120


def test_unit_without_pins_does_not_wait() -> None:
    script = Script()
    script.register("FF-01")
    for second in range(10):
        script.now_s = float(second)
        script.position("FF-01", float(second), 0.0)
    late = message_factory.position(script.header("FF-01", 4.5), north_m=4.5)
    script.record(backfilled_key("FF-01", POSITION.suffix), encode(late))
    assert script.pipeline.state.late == {}


def test_plan_loaded_after_pins_is_used_within_seconds(walker: Walker) -> None:
    """As it is at the next change of a pin."""

    def trail() -> list[tuple[float, float]]:
        trail = walker.script.pipeline.state.units["FF-01"].trails.shown
        return [(one.north_m, one.east_m) for one in trail]

    before = trail()
    walker.script.act(SetPlan(PLAN))
    assert trail() == before
    walker.script.now_s += 3.0
    assert walker.solved() == 1
    assert walker.solved() == 0
    heeded = trail()
    assert heeded != before
    walker.script.act(SetPin("p1", "FF-01", walker.pin_ns, 140.0, 0.0, 0.5, None, None, 0.0, ""))
    assert trail() == heeded


def test_longest_waiting_unit_is_solved_first_and_one_at_a_time() -> None:
    late: dict[str, PendingResolve] = {}
    request_resolve(late, "FF-02", 0)
    request_resolve(late, "FF-01", NS_PER_S)
    assert pop_due(late, NS_PER_S) is None
    assert pop_due(late, 20 * NS_PER_S) == "FF-02"
    assert pop_due(late, 20 * NS_PER_S) == "FF-01"
    assert pop_due(late, 20 * NS_PER_S) is None


def test_endless_backfill_is_solved_meanwhile() -> None:
    late: dict[str, PendingResolve] = {}
    for second in range(10):
        request_resolve(late, "FF-01", second * NS_PER_S)
        assert pop_due(late, second * NS_PER_S) is None
    assert pop_due(late, 10 * NS_PER_S) == "FF-01"


@pytest.mark.slow
def test_replay_solves_it_at_the_same_time(walker: Walker) -> None:
    for _ in walker.backfill():
        pass
    walker.script.wait(5.0)
    again, logged = Script(make_pipeline()), []
    for t_ns, key, payload in walker.script.records:
        again.now_s = (t_ns - walker.script.records[0][0]) / 1e9
        logged.append((t_ns, key, payload))
        decided = [
            one
            for one in again.record(key, payload)
            if isinstance(one, AlarmChange | FusedPosition)
        ]
        logged += [(t_ns, channel_of(one).key(STATION_ID), encode(one)) for one in decided]
    assert list(compare(logged, make_pipeline())) == []
