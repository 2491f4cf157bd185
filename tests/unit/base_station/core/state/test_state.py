"""State of the station: repeats, restarts, late messages, trails, and the display of a card."""

from __future__ import annotations

import math
from itertools import pairwise

import msgspec
import pytest

from base_station.core.events import Refused, UnitChanged
from base_station.core.state import UnitState
from base_station.core.state.trail import RECENT_POINTS, TRAIL_POINTS
from base_station.storage.db.known_people import KnownPerson, person_lookup
from base_station.views.station import StationFacts, health_view, snapshot
from base_station.views.units import unit_views
from base_station.views.wire import ClockView
from shared.clock import NS_PER_S
from shared.messages import EventKind, Heartbeat
from shared.messages.pins import SetMeeting, SetPin
from shared.messages.station import (
    Assign,
    OpenIncident,
    RegisterUnit,
    SetAnchor,
    SetPlan,
    SetStart,
    Unassign,
)
from shared.quality import Quality
from tests.rig import message_factory
from tests.rig.station_script import Script

U = "FF-01"
OUTLINE = (
    b'{"type":"FeatureCollection","muster":{"frame":"site-m"},"features":[{"type":"Feature",'
    b'"properties":{"kind":"outline"},"geometry":{"type":"Polygon","coordinates":'
    b"[[[-10,10],[10,10],[10,30],[-10,30],[-10,10]]]}}]}"
)
STOREYS = (
    b'{"type":"FeatureCollection","muster":{"frame":"site-m","floors":[{"floor":3,"down_m":-50}]},'
    b'"features":[]}'
)


@pytest.fixture
def script() -> Script:
    script = Script()
    script.register(U)
    return script


def unit(script: Script) -> UnitState:
    return script.pipeline.state.units[U]


def test_repeat_changes_nothing_and_is_counted(script: Script) -> None:
    script.position(U, 1.0, 2.0)
    t_ns, key, payload = script.records[-1]
    fused = len(script.fused)
    script.now_s += 30.0
    assert script.record(key, payload) == []
    assert unit(script).duplicates == 1
    assert len(script.fused) == fused
    assert unit(script).last_message_ns == t_ns, "a repeat is no sign of life"


def test_older_message_does_not_set_the_state_back(script: Script) -> None:
    late = script.header(U, captured_s=-5.0)
    script.position(U, 1.0, 2.0)
    script.position(U, 9.0, 9.0, header=late)
    position, fused = unit(script).position, unit(script).place.fused
    assert position is not None
    assert fused is not None
    assert (position.north_m, fused.north_m) == pytest.approx((1.0, 1.0))


def test_messages_of_an_earlier_run_are_old(script: Script) -> None:
    before = script.header(U)
    script.status(U, steps=5)
    script.boot_ids[U] = 8
    script.now_s = -900.0  # the new run's monotonic clock begins earlier
    script.status(U, steps=1)
    assert unit(script).status is not None
    script.status(U, steps=99, header=before)
    assert unit(script).status.steps == 1  # type: ignore[union-attr]


def rebooted(script: Script, seconds: int) -> None:
    """The unit's clock begins anew, and its tracker does not run yet."""
    script.boot_ids[U] = 8
    for second in range(seconds):
        script.now_s += 1.0
        header = script.header(U, captured_s=second - 900.0)
        script.say(message_factory.status(header))
        if script.pipeline.state.site.anchor is not None:
            script.say(
                message_factory.gps_fix(script.header(U, captured_s=second - 900.0), 52.0, 4.0)
            )


def test_old_place_stays_old_when_the_unit_restarts(script: Script) -> None:
    script.position(U, 1.0, 2.0)
    script.wait(30)
    rebooted(script, 5)
    script.act(SetAnchor(52.0, 4.0, 50.0, 0.0))
    assert script.fused[-1].t_meas_ns == script.t_ns - 35 * NS_PER_S


def test_fixes_of_a_run_without_positions_are_current(script: Script) -> None:
    script.act(SetAnchor(52.0, 4.0, 50.0, 0.0))
    script.position(U, 0.0, 0.0)
    script.wait(30)
    rebooted(script, 20)
    assert unit(script).rejected_counts == {}
    shown = script.fused[-1]
    assert (shown.t_meas_ns, shown.since_gps_s) == (script.t_ns, 0.0)
    assert shown.std_north_m < 20.0
    script.now_s += 10.0
    script.say(message_factory.position(script.header(U, captured_s=-871.0)))
    assert script.fused[-1].since_gps_s == 10.0
    script.now_s += 1.0
    script.say(message_factory.gps_fix(script.header(U, captured_s=-870.0), 52.0, 4.0))
    assert script.fused[-1].since_gps_s == 0.0


@pytest.mark.parametrize(
    ("silent_s", "link"), [(0, "live"), (9, "live"), (10, "stale"), (29, "stale"), (30, "lost")]
)
def test_link_age_is_that_of_the_last_message(script: Script, silent_s: int, link: str) -> None:
    assert unit(script).link == "never"
    script.status(U)
    script.wait(silent_s)
    assert unit(script).link == link


def test_every_message_reaches_consoles_and_urgent_ones_at_once(
    script: Script,
) -> None:
    at_once, may_wait = UnitChanged(U, soon=True), UnitChanged(U, soon=False)
    assert at_once in script.temperature(U, 21.0), "the link is there"
    assert may_wait in script.status(U)
    assert may_wait in script.temperature(U, 22.0)
    assert at_once in script.position(U, 1.0, 2.0)
    assert at_once in script.gps(U, 0.0, 0.0), "what was not used is counted on its card"
    assert at_once in script.event(U, EventKind.MAYDAY)
    script.wait(60)
    assert unit(script).link == "lost"
    assert at_once in script.status(U), "somebody is heard of again"
    assert UnitChanged("stranger") in script.status("stranger")


def test_old_position_is_shown_as_old_and_its_region_grows(script: Script) -> None:
    script.position(U, 1.0, 2.0)
    state = script.pipeline.state

    def region_m() -> float:
        [view] = unit_views(state, [unit(script)], person_lookup({}))
        assert view.position is not None
        return view.position.ellipse_major_m

    fresh_m = region_m()
    script.wait(20)
    stale_m = region_m()
    script.wait(20)
    assert fresh_m < stale_m < region_m()
    touched = script.tick()
    assert touched, "the console hears of it although nothing came"


def test_status_replaces_lost_messages_of_a_press_and_its_end(
    script: Script,
) -> None:
    def maydays() -> tuple[int | None, int | None]:
        return unit(script).mayday.t_ns, unit(script).mayday.cancelled_ns

    script.status(U)
    assert maydays() == (None, None)
    script.wait(5)
    script.status(U, mayday=True)
    pressed_ns = script.t_ns
    script.wait(5)
    script.status(U, mayday=True)
    assert maydays() == (pressed_ns, None), "said again, not pressed again"
    script.status(U)
    cancelled_ns = script.t_ns
    script.wait(5)
    script.status(U)
    assert maydays() == (pressed_ns, cancelled_ns)
    script.wait(5)
    script.status(U, mayday=True)
    again_ns = script.t_ns
    script.wait(5)
    script.status(U, mayday=True)
    assert maydays() == (again_ns, None)
    script.wait(5)
    script.status(U)
    assert maydays() == (again_ns, script.t_ns)


def test_path_is_in_doubt_since_the_first_poor_position(script: Script) -> None:
    script.position(U, 0.0, 0.0)
    script.wait(5)
    script.position(U, 1.0, 0.0, quality=Quality.DEGRADED)
    doubted_ns = script.t_ns
    script.wait(5)
    script.position(U, 2.0, 0.0, quality=Quality.LOST)
    assert unit(script).degraded_since_ns == doubted_ns
    script.wait(5)
    script.position(U, 3.0, 0.0)
    assert unit(script).degraded_since_ns is None


def test_wearer_follows_the_last_assignment(script: Script) -> None:
    script.register("FF-02")
    script.act(Assign(U, "p1", "Ada", "red", "leader"))
    script.act(Assign("FF-02", "p1", "Ada", "red", "leader"))
    assert unit(script).wearer.person is None, "nobody wears two units"
    script.act(Unassign("FF-02"))
    assert script.pipeline.state.units["FF-02"].wearer.person is None


def test_action_on_an_unknown_unit_is_refused_with_a_sentence(script: Script) -> None:
    (refused,) = script.act(Assign("nobody", "p1", "Ada", "", ""))
    assert "register" in refused.reason  # type: ignore[union-attr]


@pytest.mark.parametrize(
    "action",
    [
        SetStart(U, 0.0, 0.0, 0.0, 0.0, -1.0, 0.1),
        SetStart(U, 0.0, 0.0, 0.0, 0.0, 1.0, -0.1),
        SetStart(U, math.nan, 0.0, 0.0, 0.0, 1.0, 0.1),
        SetStart(U, 0.0, 0.0, 0.0, 0.0, math.inf, 0.1),
        SetAnchor(90.1, 4.0, 0.0, 0.0),
        SetAnchor(-90.1, 4.0, 0.0, 0.0),
        SetAnchor(52.0, -180.1, 0.0, 0.0),
        SetAnchor(52.0, math.nan, 0.0, 0.0),
    ],
)
def test_impossible_place_is_refused_with_a_sentence(
    script: Script, action: SetStart | SetAnchor
) -> None:
    outputs = script.act(action)
    assert [type(output) for output in outputs] == [Refused]
    assert script.pipeline.state.site.anchor is None
    assert not script.pipeline.state.site.start_set


def test_silent_unit_moves_with_the_frame_and_gets_the_floor_of_the_plan(
    script: Script,
) -> None:
    """The first good fix places the frame; then a person places it better."""
    for second in range(20):
        script.now_s += 1.0
        script.position(U, float(second), 0.0)
        script.gps(U, 52.0 + second * 9e-6, 4.0, horizontal_std_m=2.0)
    script.act(SetPin("p1", U, script.t_ns, 19.0, 0.0, 1.0, None, 0.1, 0.5, ""))
    script.register("FF-02")
    script.act(SetMeeting("m", U, "FF-02", script.t_ns, 1.0, ""))
    script.wait(60)
    before = unit(script).place.fused
    assert before is not None
    script.act(SetAnchor(51.999, 4.0, 0.0, math.pi / 2.0))
    script.act(SetPlan(STOREYS))
    after = unit(script).place.fused
    assert after is not None
    place, last = (after.north_m, after.east_m), unit(script).trails.shown[-1]
    assert place == pytest.approx((before.east_m, -111.3 - before.north_m), abs=1.0)
    assert place == pytest.approx((last.north_m, last.east_m), abs=0.5)
    assert place == pytest.approx(script.pipeline.state.paths[U].shown_m, abs=1.0)
    unpinned_trail = unit(script).trails.unpinned
    assert unpinned_trail is not None, "the pin is of use"
    assert place == pytest.approx((unpinned_trail[-1].north_m, unpinned_trail[-1].east_m), abs=1.0)
    assert after.t_meas_ns == before.t_meas_ns
    assert after.floor == 3
    pin = script.pipeline.state.site.pins["p1"]
    assert (pin.north_m, pin.east_m) == pytest.approx((0.0, -111.3 - 19.0), abs=1.0)
    assert pin.heading_rad == pytest.approx(0.1 - math.pi / 2.0)


@pytest.mark.slow
def test_trail_is_thinned_and_bounded(script: Script) -> None:
    for step in range(3 * TRAIL_POINTS):
        script.now_s += 0.5
        script.position(U, 0.8 * step, 0.0)
    trail = unit(script).trails.shown
    assert RECENT_POINTS < len(trail) <= TRAIL_POINTS
    assert trail[0].north_m == pytest.approx(0.0, abs=1.0), "the way is whole"
    steps_ns = [after.t_ns - before.t_ns for before, after in pairwise(trail)]
    assert min(steps_ns) >= 10**9
    assert max(steps_ns[-RECENT_POINTS + 1 :]) < 2 * 10**9


def test_time_inside_begins_at_the_outline_or_at_the_first_steps(script: Script) -> None:
    script.act(OpenIncident("i1", "Mill Lane"))
    script.position(U, 0.0, 0.0, distance_m=0.0)
    assert unit(script).place.inside_since_ns is None
    script.position(U, 6.0, 0.0, distance_m=6.0)
    assert unit(script).place.inside_since_ns == script.t_ns
    script.act(SetPlan(OUTLINE))
    script.position(U, 0.0, 0.0)
    assert unit(script).place.inside_since_ns is None
    script.wait(20, lambda: None)
    script.position(U, 20.0, 0.0)
    assert unit(script).place.inside_since_ns == script.t_ns


def test_ellipse_is_the_95_percent_region(script: Script) -> None:
    script.position(U, 0.0, 0.0)
    fused = unit(script).place.fused
    assert fused is not None
    unit(script).place.fused = msgspec.structs.replace(
        fused, std_north_m=2.0, std_east_m=1.0, correlation_ne=0.0
    )
    view = unit_views(script.pipeline.state, [unit(script)], person_lookup({}))[0].position
    assert view is not None
    assert view.ellipse_major_m == pytest.approx(2.0 * 2.4477, rel=1e-3)
    assert view.ellipse_minor_m == pytest.approx(1.0 * 2.4477, rel=1e-3)
    assert view.ellipse_heading_rad == pytest.approx(0.0)
    unit(script).place.fused = msgspec.structs.replace(
        fused, std_north_m=1.0, std_east_m=1.0, correlation_ne=0.9
    )
    view = unit_views(script.pipeline.state, [unit(script)], person_lookup({}))[0].position
    assert view is not None
    assert view.ellipse_heading_rad == pytest.approx(math.pi / 4.0, abs=1e-3), "towards north-east"


def test_snapshot_shows_people_and_alarms(script: Script) -> None:
    script.act(Assign(U, "p1", "Ada", "red", "leader"))
    script.event(U, EventKind.MAYDAY)
    script.position(U, 1.0, 2.0)
    shown = snapshot(
        script.pipeline.state, 7, StationFacts(), lambda p: KnownPerson("", photo_url=f"/photo/{p}")
    )
    (view,) = shown.units
    assert view.person is not None
    assert view.person.photo_url == "/photo/p1"
    assert view.alarms == (shown.alarms[0].alarm_id,)
    assert shown.seq == 7


def test_rubbish_and_unregistered_units_are_counted_in_health(script: Script) -> None:
    script.record("muster/v1/FF-01/up/position", b"rubbish")
    script.status("stranger")
    health = health_view(script.pipeline.state, StationFacts())
    assert (health.undecodable, health.unknown_units, health.messages) == (1, 1, 1)
    assert any("up/position" in problem for problem in health.problems)


def test_endless_unregistered_units_do_not_fill_the_memory(script: Script) -> None:
    for number in range(300):
        script.status(f"X-{number}")
    state = script.pipeline.state
    assert len(state.units) == 201
    assert state.counts.unregistered_dropped == 100
    script.act(RegisterUnit("X-299", "late"))
    script.status("X-299")
    assert state.units["X-299"].status is not None


def test_unit_is_shown_switched_off_until_its_next_message(script: Script) -> None:
    def is_off() -> bool:
        (view,) = unit_views(script.pipeline.state, [unit(script)], person_lookup({}))
        return view.switched_off

    script.status(U)
    shown = [is_off()]
    script.event(U, EventKind.STOPPED)
    shown.append(is_off())
    script.wait(60)
    shown.append(is_off())
    script.status(U)
    assert [*shown, is_off()] == [False, True, True, False]


def test_unit_is_shown_with_the_error_of_its_clock(script: Script) -> None:
    def clock() -> ClockView | None:
        return unit_views(script.pipeline.state, [unit(script)], person_lookup({}))[0].clock

    script.say(Heartbeat(script.header(U), 1, 1))
    assert clock() is None, "the station never answered it"
    script.say(Heartbeat(script.header(U), 1, 1, clock_ahead_s=-3.5, clock_std_s=0.002))
    assert clock() == ClockView(-3500.0, 2.0)
