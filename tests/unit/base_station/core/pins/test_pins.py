"""Pins in the pipeline: their corrections, and the effect of their removal."""

from __future__ import annotations

import numpy as np
import pytest

from base_station.core.checkpoint import read_checkpoint
from base_station.core.events import PinsChanged, TrailBackfilled
from base_station.core.pins.evidence import encounters_of, reported_floors
from base_station.core.pins.pin_solver import floors_along, trail_of
from base_station.core.state import StationState
from base_station.core.state.trail import TRAIL_POINTS
from base_station.fusion.odometry.points import FIX_ROW, Point, arrays_of, rows_of
from shared.clock import NS_PER_S
from shared.messages.pins import RemovePin, SetMeeting, SetPin, StartTogether
from shared.messages.station import CloseIncident, ForgetWearers, OpenIncident, SetPlan, SetStart
from tests.rig import message_factory
from tests.rig.live_station import make_pipeline
from tests.rig.round_walk import PLAN, Walk, truth, walk_from_the_engine
from tests.rig.station_script import START_NS, Script


@pytest.fixture
def walk() -> Walk:
    return walk_from_the_engine()


def test_pin_corrects_the_whole_past_and_the_present(walk: Walk) -> None:
    before_m, now_m = walk.worst_m("FF-01"), walk.now_off_m("FF-01")
    outputs = walk.pin("p1", "FF-01", 300.0)
    assert walk.state("p1") == "used"
    assert any(isinstance(output, TrailBackfilled) for output in outputs)
    assert any(isinstance(output, PinsChanged) for output in outputs)
    assert now_m > 5.0
    assert walk.now_off_m("FF-01") < 1.0
    assert walk.worst_m("FF-01") < 0.5 * before_m


def test_start_set_before_the_first_position_holds_from_then() -> None:
    script = Script()
    script.register("FF-01")
    script.act(StartTogether("s", ("FF-01",), 0, -30.0, 9.0, 1.0, None, None, 0.3, ""))
    verdicts = [script.pipeline.state.site.pin_verdicts["s:FF-01"].state]
    script.position("FF-01", 0.0, 0.0)
    fused = script.pipeline.state.units["FF-01"].place.fused
    verdicts.append(script.pipeline.state.site.pin_verdicts["s:FF-01"].state)
    assert verdicts == ["waiting", "used"]
    assert fused is not None
    assert (fused.north_m, fused.east_m) == pytest.approx((-30.0, 9.0), abs=0.1)


def test_pin_with_a_floor_holds_a_path_of_a_single_point() -> None:
    script = Script()
    script.register("FF-01")
    script.act(SetPlan(PLAN))
    script.position("FF-01", 0.0, 0.0)
    script.act(SetPin("p1", "FF-01", 0, 3.0, 4.0, 1.0, 1, None, 0.35, ""))
    fused = script.pipeline.state.units["FF-01"].place.fused
    assert fused is not None
    assert (fused.north_m, fused.east_m) == pytest.approx((3.0, 4.0), abs=0.1)
    assert fused.floor == 1


def test_path_continues_from_a_pin(walk: Walk) -> None:
    plain = Walk("FF-01")
    plain.start("FF-01")
    plain.go(400)
    walk.pin("p1", "FF-01", 150.0)
    walk.pin("p2", "FF-01", 300.0)
    walk.go(100)
    assert walk.now_off_m("FF-01") < 0.5 * plain.now_off_m("FF-01")


def test_removal_of_a_pin_restores_the_state_without_it() -> None:
    plain, pinned = Walk("FF-01"), Walk("FF-01")
    for walk in (plain, pinned):
        walk.start("FF-01")
        walk.go(200)
    pinned.pin("p1", "FF-01", 120.0)
    for walk in (plain, pinned):
        walk.go(150)
    assert pinned.trail("FF-01") != plain.trail("FF-01")
    pinned.script.act(RemovePin("p1"))
    for walk in (plain, pinned):
        walk.go(30)
    mine, theirs = (walk.script.pipeline.state.units["FF-01"] for walk in (pinned, plain))
    assert mine.place.fused is not None
    assert theirs.place.fused is not None
    assert mine.place.fused.north_m == theirs.place.fused.north_m
    assert mine.place.fused.std_north_m == theirs.place.fused.std_north_m
    assert mine.trails.shown == theirs.trails.shown
    assert pinned.script.pipeline.state.site.pins == {}


def test_removed_pin_leaves_no_unit_on_its_floor() -> None:
    """Half way up the stairs a unit stays on its floor, and not on that of a wrong pin."""
    floors = {}
    for is_pinned in (False, True):
        script = Script()
        script.register("FF-01")
        script.act(SetPlan(PLAN))
        script.act(SetStart("FF-01", 10.0, 10.0, 0.0, 0.0, 3.0, 0.05))
        for second in range(10):
            script.now_s += 1.0
            down_m = -0.19 * second
            script.position("FF-01", 0.4 * second, 0.0, down_m=down_m, distance_m=0.4 * second)
            if second == 5 and is_pinned:
                script.act(SetPin("p", "FF-01", script.t_ns, 12.0, 10.0, 0.5, 1, None, 0.0, ""))
                assert script.fused[-1].floor == 1
        if is_pinned:
            script.act(RemovePin("p"))
        script.position("FF-01", 3.7, 0.0, down_m=down_m, distance_m=3.7)
        floors[is_pinned] = script.fused[-1].floor
    assert floors == {False: 0, True: 0}


def test_opened_incident_shows_no_earlier_place() -> None:
    """The place of a silent, pinned unit is published again as pins are removed."""
    walk = Walk("FF-01")
    walk.start("FF-01")
    walk.go(60)
    walk.pin("p1", "FF-01", 30.0)
    walk.script.act(CloseIncident("i1"))
    walk.go(5)
    walk.script.now_s += 20.0
    walk.script.act(OpenIncident("i2", "Another"))
    assert walk.trail("FF-01") == []


@pytest.mark.slow
def test_removal_of_one_of_two_pins_leaves_the_trail_of_the_other() -> None:
    one, both = Walk("FF-01"), Walk("FF-01")
    for walk in (one, both):
        walk.start("FF-01")
        walk.go(300)
    both.pin("p2", "FF-01", 200.0, off_m=3.0)
    both.pin("p1", "FF-01", 100.0)
    both.script.act(RemovePin("p2"))
    one.pin("p1", "FF-01", 100.0)
    assert both.trail("FF-01") == one.trail("FF-01")
    fused = [walk.script.pipeline.state.units["FF-01"].place.fused for walk in (one, both)]
    assert fused[0] is not None
    assert fused[1] is not None
    assert fused[0].north_m == fused[1].north_m


@pytest.mark.slow
def test_moved_pin_equals_one_set_there(walk: Walk) -> None:
    other = Walk("FF-01")
    other.start("FF-01")
    other.go(300)
    walk.pin("p1", "FF-01", 250.0, off_m=5.0)
    walk.pin("p1", "FF-01", 250.0)
    other.pin("p1", "FF-01", 250.0)
    assert walk.trail("FF-01") == other.trail("FF-01")


def test_pin_moved_to_another_unit_leaves_the_first_as_before() -> None:
    walk = Walk("FF-01", "FF-02")
    walk.go(100)
    before_m = walk.now_off_m("FF-01")
    walk.pin("p1", "FF-01", 100.0, off_m=30.0)
    assert walk.now_off_m("FF-01") > 20.0
    walk.pin("p1", "FF-02", 100.0, off_m=30.0)
    assert walk.now_off_m("FF-02") > 20.0
    assert walk.now_off_m("FF-01") == before_m


def test_removal_of_a_pin_keeps_pins_with_the_same_prefix(walk: Walk) -> None:
    walk.pin("p1", "FF-01", 100.0)
    walk.pin("p10", "FF-01", 200.0)
    walk.script.act(RemovePin("p1"))
    assert list(walk.script.pipeline.state.site.pins) == ["p10"]


def test_contradicting_pin_is_kept_and_moves_no_member(walk: Walk) -> None:
    walk.pin("p1", "FF-01", 100.0)
    before = walk.now_off_m("FF-01")
    trail = walk.trail("FF-01")
    walk.pin("bad", "FF-01", 200.0, off_m=200.0)
    verdict = walk.script.pipeline.state.site.pin_verdicts["bad"]
    assert verdict.state == "conflict"
    assert "not used" in verdict.text
    code = verdict.text_code
    assert code.code == "pin-conflict"
    assert code.texts["against:"] == "pin-against-fixes"
    assert code.texts["against:path:"] == "pin-path-walked"
    assert code.numbers["away_m"] == verdict.residual_m
    assert verdict.residual_m == pytest.approx(200.0, abs=10.0)
    assert walk.state("p1") == "used"
    assert walk.now_off_m("FF-01") == pytest.approx(before, abs=1e-9)
    assert walk.trail("FF-01") == trail


def test_most_pins_outvote_the_first(walk: Walk) -> None:
    walk.pin("wrong", "FF-01", 150.0, off_m=80.0)
    for number, second in enumerate((100.0, 200.0, 290.0)):
        walk.pin(f"p{number}", "FF-01", second)
    assert walk.state("wrong") == "conflict"
    assert [walk.state(f"p{number}") for number in range(3)] == ["used"] * 3


def test_pins_alone_give_the_heading() -> None:
    """Start and heading of the unit are unknown."""
    walk = Walk("FF-01", turn_rad=2.0)
    walk.go(120)
    for number, second in enumerate((5.0, 60.0, 115.0)):
        walk.pin(f"p{number}", "FF-01", second)
    assert walk.worst_m("FF-01") < 2.0
    walk.go(40)
    assert walk.now_off_m("FF-01") < 3.0


def test_all_start_at_the_engine_with_the_same_heading() -> None:
    walk = Walk("FF-01", "FF-02", turn_rad=1.0)
    walk.go(100)
    # Heading 0 of their own frames is the direction that they faced.
    start = StartTogether("s", ("FF-01", "FF-02"), 0, 0.0, 0.0, 0.5, None, -1.0, 0.05, "engine 1")
    walk.script.act(start)
    assert set(walk.script.pipeline.state.site.pins) == {"s:FF-01", "s:FF-02"}
    for unit_id in walk.units:
        assert walk.worst_m(unit_id) < 6.0
    walk.script.act(RemovePin("s"))
    assert walk.script.pipeline.state.site.pins == {}


def test_all_are_at_the_engine_now_though_switched_on_long_before() -> None:
    """The ride there is in their paths: the begin of those does not matter."""
    walk = Walk("FF-01", "FF-02", turn_rad=1.0)
    walk.go(100)
    here, t_ns = truth(walk.walked_s), walk.script.t_ns
    walk.script.act(StartTogether("s", walk.units, t_ns, *here, 0.5, None, -1.0, 0.05, ""))
    walk.go(30)
    for unit_id in walk.units:
        assert walk.state(f"s:{unit_id}") == "used"
        assert walk.now_off_m(unit_id) < 4.0


def test_unit_switched_on_after_a_common_start_begins_there() -> None:
    walk = Walk("FF-01", "FF-02")
    walk.go(60, silent=("FF-02",))
    then_ns = walk.script.t_ns - 30 * 10**9
    walk.go(20)
    walk.script.act(StartTogether("s", walk.units, then_ns, 0.0, 0.0, 0.5, None, None, 0.3, ""))
    pins = walk.script.pipeline.state.site.pins
    assert (pins["s:FF-01"].t_ns, pins["s:FF-02"].t_ns) == (then_ns, 0)


@pytest.mark.slow
def test_encounter_with_a_well_known_place_improves_the_other() -> None:
    walk = Walk("FF-01", "FF-02")
    for unit_id in walk.units:
        walk.start(unit_id)
    walk.go(300)
    for number, second in enumerate((100.0, 200.0, 300.0)):
        walk.pin(f"p{number}", "FF-02", second)
    before_m = walk.now_off_m("FF-01")
    walk.script.act(SetMeeting("m", "FF-01", "FF-02", walk.script.t_ns, 1.0, ""))
    assert walk.state("m") == "used"
    assert walk.now_off_m("FF-01") < 0.5 * before_m
    walk.script.act(RemovePin("m"))
    assert walk.now_off_m("FF-01") == before_m


def test_later_pin_of_one_unit_counts_for_the_one_it_met() -> None:
    """The starts are unknown: whole paths move to their pins."""
    walk = Walk("FF-01", "FF-02")
    walk.go(100)
    walk.script.act(SetMeeting("m", "FF-01", "FF-02", walk.script.t_ns, 1.0, ""))
    assert walk.now_off_m("FF-01") < 10.0
    for number, second in enumerate((20.0, 60.0, 100.0)):
        walk.pin(f"p{number}", "FF-02", second, off_m=30.0)
    assert walk.now_off_m("FF-01") == pytest.approx(30.0, abs=5.0)


def test_pin_waits_for_a_path_that_comes_late(walk: Walk) -> None:
    walk.go(60, silent=("FF-01",))
    walk.pin("p1", "FF-01", float(walk.walked_s))
    assert walk.state("p1") == "waiting"
    walk.go(1)
    assert walk.state("p1") == "used"


def test_pin_of_now_counts_though_the_last_message_is_seconds_old(walk: Walk) -> None:
    walk.go(4, silent=("FF-01",))
    walk.pin("p1", "FF-01", 304.0)
    assert walk.state("p1") == "used"
    walk.go(2, silent=("FF-01",))
    walk.pin("p2", "FF-01", 306.0)
    assert walk.state("p2") == "waiting"


def test_floor_of_a_future_time_numbers_no_storeys_yet(walk: Walk) -> None:
    walk.go(60, silent=("FF-01",))
    north_m, east_m = truth(360.0)
    t_ns = walk.script.t_ns
    walk.script.act(SetPin("p", "FF-01", t_ns, north_m, east_m, 0.5, 2, None, 0.0, ""))
    assert walk.state("p") == "waiting"
    assert reported_floors(walk.script.pipeline.state, walk.script.pipeline.state.site) == []
    walk.go(1)
    assert [
        one.floor
        for one in reported_floors(walk.script.pipeline.state, walk.script.pipeline.state.site)
    ] == [2]


def test_encounter_ties_two_paths_once_both_have_reached_it() -> None:
    walk = Walk("FF-01", "FF-02", "FF-03")
    state = walk.script.pipeline.state
    walk.go(60, silent=("FF-03",))
    walk.go(60, silent=("FF-02", "FF-03"))
    for pin_id, other_id, ago_s in (("m1", "FF-02", 0), ("m2", "FF-02", 70), ("m3", "FF-03", 0)):
        t_ns = walk.script.t_ns - ago_s * NS_PER_S
        walk.script.act(SetMeeting(pin_id, "FF-01", other_id, t_ns, 1.0, ""))
    assert [
        (encounter.name, encounter.unit_id, encounter.other_id)
        for encounter in encounters_of(state, state.site)
    ] == [("m2", "FF-01", "FF-02")]
    walk.go(1)
    assert [encounter.name for encounter in encounters_of(state, state.site)] == ["m1", "m2", "m3"]


def test_trail_of_more_points_than_are_drawn_keeps_its_ends() -> None:
    count = TRAIL_POINTS + 300
    rows = rows_of([Point((1 + second) * NS_PER_S) for second in range(count)])
    places_m = np.zeros((count, 3))
    places_m[:, 0] = np.arange(count)
    trail = trail_of(StationState(), "FF-01", arrays_of(rows, np.empty(0, FIX_ROW)), places_m)
    assert len(trail) == TRAIL_POINTS
    assert (trail[0].north_m, trail[-1].north_m) == (0.0, count - 1.0)
    assert np.diff([step.north_m for step in trail]).max() == 2.0


def test_first_waiting_pin_is_used_once_the_path_has_reached_it(walk: Walk) -> None:
    walk.go(20, silent=("FF-01",))
    north_m, east_m = walk.own["FF-01"].place_m
    walk.go(40, silent=("FF-01",))
    walk.pin("p1", "FF-01", 320.0)
    walk.pin("p2", "FF-01", 360.0)
    assert (walk.state("p1"), walk.state("p2")) == ("waiting", "waiting")
    held_up = walk.script.header("FF-01", walk.script.now_s - 40.0)
    walk.script.say(
        message_factory.position(held_up, north_m=north_m, east_m=east_m, distance_m=320.0)
    )
    assert (walk.state("p1"), walk.state("p2")) == ("used", "waiting")


def test_encounter_with_an_uncertain_place_changes_little() -> None:
    """FF-02 went 200 m along a line; its north is known, and its east is not."""
    script = Script()
    script.register("FF-01", "FF-02")
    script.act(SetStart("FF-01", 200.0, 0.0, 0.0, 0.0, 0.5, 0.05))
    script.act(SetStart("FF-02", 0.0, 0.0, 0.0, 0.0, 0.5, 0.5))
    for second in range(201):
        script.now_s += 1.0
        script.position("FF-01", 0.0, 0.0)
        script.position("FF-02", float(second), 0.0, distance_m=float(second))
    units, verdicts = script.pipeline.state.units, script.pipeline.state.site.pin_verdicts
    before, vague = units["FF-01"].place.fused, units["FF-02"].place.fused
    script.act(SetMeeting("m", "FF-01", "FF-02", script.t_ns, 1.0, ""))
    after, sharp = units["FF-01"].place.fused, units["FF-02"].place.fused
    assert before is not None
    assert vague is not None
    assert after is not None
    assert sharp is not None
    assert vague.std_north_m < 50.0 < vague.std_east_m
    assert verdicts["m"].text == "the position of FF-02 was not known well enough"
    assert (after.north_m, after.east_m) == (before.north_m, before.east_m)
    assert sharp.std_east_m < 0.1 * vague.std_east_m, "who is known well tells where the other is"


@pytest.mark.slow
def test_conflict_of_an_encounter_stays_in_any_order_of_solving() -> None:
    """FF-02 was with FF-01 all the time, so not with FF-03; no evidence of FF-03 contradicts."""
    walk = Walk("FF-01", "FF-02", "FF-03", "FF-04")
    for unit_id in ("FF-01", "FF-04"):
        walk.start(unit_id)
    walk.script.act(SetStart("FF-02", 0.0, 0.0, 0.0, 0.0, 10.0, 0.05))
    walk.script.act(SetStart("FF-03", 20.0, 0.0, 0.0, 0.0, 0.5, 0.05))
    walk.go(60)

    def meet(pin_id: str, unit_id: str, other_id: str, ago_s: int, std_m: float) -> None:
        t_ns = walk.script.t_ns - ago_s * NS_PER_S
        walk.script.act(SetMeeting(pin_id, unit_id, other_id, t_ns, std_m, ""))

    for ago_s in (10, 30, 50):
        meet(f"m{ago_s}", "FF-02", "FF-01", ago_s, 1.0)
    meet("contradicted", "FF-02", "FF-03", 20, 1.0)
    meet("other", "FF-03", "FF-04", 40, 30.0)
    assert walk.state("contradicted") == "conflict"
    verdict = walk.script.pipeline.state.site.pin_verdicts["contradicted"]
    assert [one for one, of in verdict.of_units if of.state == "used"] == ["FF-03"]
    assert verdict.text.endswith("kept, and not used for FF-02"), "of FF-03 it may tell something"
    walk.pin("p", "FF-04", 60.0)
    assert walk.state("contradicted") == "conflict"
    for ago_s in (10, 30, 50):
        walk.script.act(RemovePin(f"m{ago_s}"))
    assert walk.state("contradicted") == "used"


def test_erased_person_leaves_the_pins_of_the_others() -> None:
    both = Walk("FF-01", "FF-02", "FF-03")
    both.go(20)
    for unit_id in both.units:
        both.pin(f"of {unit_id}", unit_id, 10.0)
    both.script.act(SetMeeting("m", "FF-01", "FF-02", both.script.t_ns, 1.0, ""))
    both.script.act(CloseIncident("i1"))
    both.script.act(ForgetWearers("FF-01"))
    state = both.script.pipeline.state
    assert state.site.pins.keys() == state.site.pin_verdicts.keys() == {"of FF-02", "of FF-03"}
    assert state.units["FF-01"].trails.unpinned is None
    saved = read_checkpoint(both.script.pipeline.checkpoint())
    assert saved is not None
    assert "FF-01" not in saved.pinned
    assert "FF-01" not in state.paths


def test_pin_on_a_floor_gives_the_height() -> None:
    """The height of the start was known roughly only."""
    walk = Walk("FF-01")
    walk.script.act(SetStart("FF-01", 0.0, 0.0, 0.0, 0.0, 3.0, 0.05))
    walk.go(300)
    walk.script.act(SetPlan(PLAN))
    north_m, east_m = truth(300.0)
    walk.script.act(SetPin("p", "FF-01", walk.script.t_ns, north_m, east_m, 1.0, 1, None, 0.0, ""))
    fused = walk.script.pipeline.state.units["FF-01"].place.fused
    assert fused is not None
    assert fused.floor == 1


def test_checkpoint_with_pins_continues_the_same(walk: Walk) -> None:
    walk.pin("p1", "FF-01", 200.0)
    saved = read_checkpoint(walk.script.pipeline.checkpoint())
    assert saved is not None
    again = make_pipeline(saved)
    walk.go(150)
    straight = walk.script.pipeline
    walk.script.pipeline, records = again, walk.script.records
    begin_ns = walk.script.t_ns - 150 * 10**9
    for t_ns, key, payload in [record for record in records if record[0] > begin_ns]:
        walk.script.now_s = (t_ns - START_NS) / 1e9
        walk.script.record(key, payload)
    assert again.state.units["FF-01"] == straight.state.units["FF-01"]
    assert again.checkpoint() == straight.checkpoint()


def test_pin_ahead_of_a_slow_link_counts_for_the_path_at_its_time(
    walk: Walk,
) -> None:
    """Positions come four seconds late: the pin is of now, the last position is older."""
    ahead_ns = walk.script.t_ns + 4 * NS_PER_S
    walk.script.now_s += 4.0
    north_m, east_m = truth(304.0)
    walk.script.act(SetPin("p", "FF-01", ahead_ns, north_m, east_m, 0.5, None, None, 0.0, ""))
    assert walk.state("p") == "used"
    walk.script.now_s -= 4.0
    walk.go(4)
    assert walk.now_off_m("FF-01") < 0.5
    solved = len([one for one in walk.script.outputs if isinstance(one, PinsChanged)])
    walk.go(6)
    again = [one for one in walk.script.outputs if isinstance(one, PinsChanged)][solved:]
    assert not again, "once"


def test_wearer_between_two_floors_stays_on_the_last_one(walk: Walk) -> None:
    """As it is shown live; a redrawn trail shows no floor that was not visited."""
    walk.script.act(SetPlan(PLAN))
    state = walk.script.pipeline.state
    points = state.paths["FF-01"].arrays()
    down_m = np.full(len(points), -3.2)
    down_m[1::2] = -1.5  # a little nearer to the ground floor
    floors = floors_along(state.site, points, np.column_stack((points.shown_m, down_m)))
    assert set(floors) == {1}
