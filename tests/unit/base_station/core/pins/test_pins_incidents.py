"""Pins and starts across incidents, and across runs of a unit's program."""

from __future__ import annotations

import pytest

from shared.clock import NS_PER_S
from shared.messages import FusedPosition
from shared.messages.pins import SetPin, StartTogether
from shared.messages.station import CloseIncident, OpenIncident, SetStart
from shared.quality import Quality
from tests.rig.round_walk import Walk, walk_from_the_engine
from tests.rig.station_script import Script


@pytest.fixture
def walk() -> Walk:
    return walk_from_the_engine()


def go_north(script: Script, seconds: int, since_m: float = 0.0) -> None:
    for second in range(seconds):
        script.now_s += 1.0
        way_m = since_m + second
        script.position("FF-01", way_m, 0.0, distance_m=way_m)


def fused_of(script: Script) -> FusedPosition:
    fused = script.pipeline.state.units["FF-01"].place.fused
    assert fused is not None
    return fused


def test_new_incident_begins_without_the_pins_of_the_last(walk: Walk) -> None:
    walk.pin("p1", "FF-01", 200.0)
    walk.script.act(CloseIncident("i1"))
    walk.go(5)
    walk.script.act(OpenIncident("i2", "Another"))
    state = walk.script.pipeline.state
    assert not state.site.pins
    assert not state.site.pin_verdicts
    assert state.paths["FF-01"].begin_ns == walk.script.t_ns - 4 * 10**9, "since the last closed"
    walk.go(5)
    assert len(walk.trail("FF-01")) <= 6


@pytest.mark.parametrize("is_on", [False, True], ids=["switched on later", "switched on before"])
@pytest.mark.parametrize("earlier", ["a morning's check", "an incident"])
def test_common_start_is_independent_of_earlier_runs(earlier: str, is_on: bool) -> None:
    """The run before does not tell where the one in this incident began."""
    script = Script()
    script.register("FF-01")
    if earlier == "an incident":
        script.act(OpenIncident("i0", "Before"))
        script.act(SetStart("FF-01", 0.0, 0.0, 0.0, 0.0, 0.5, 0.05))
        go_north(script, 60)
        script.act(CloseIncident("i0"))
    go_north(script, 60)
    script.now_s += 4.0 * 3600.0
    script.boot_ids["FF-01"] = 8
    if is_on:
        go_north(script, 10)
    script.act(OpenIncident("i1", "Mill Lane"))
    go_north(script, 30, since_m=10.0 if is_on else 0.0)
    script.act(StartTogether("s", ("FF-01",), 0, 100.0, 200.0, 1.0, None, 0.0, 0.05, ""))
    fused = fused_of(script)
    assert (fused.north_m, fused.east_m) == pytest.approx((139.0 if is_on else 129.0, 200.0), abs=1)
    assert fused.quality is Quality.GOOD
    begin_ns = script.pipeline.state.paths["FF-01"].begin_ns
    assert begin_ns == script.t_ns - (39 if is_on else 29) * NS_PER_S


@pytest.mark.parametrize("is_on", [False, True], ids=["switched on later", "out of reach"])
def test_start_set_before_contact_in_the_incident_belongs_to_the_next_run(
    is_on: bool,
) -> None:
    """The unit was tested in the morning, and left 60 m off; or its radio did not reach the
    station.
    """
    script = Script()
    script.register("FF-01")
    go_north(script, 60)
    script.now_s += 3600.0
    script.tick()
    script.act(OpenIncident("i1", "Mill Lane"))
    script.act(SetStart("FF-01", 100.0, 5.0, 0.0, 0.0, 0.5, 0.05))
    if not is_on:
        script.boot_ids["FF-01"] = 8
    since_m = 60.0 if is_on else 0.0
    go_north(script, 20, since_m)
    fused = fused_of(script)
    assert fused.north_m == pytest.approx(100.0 + since_m + 19.0, abs=0.5)
    assert fused.east_m == pytest.approx(5.0, abs=2.0)
    assert fused.heading_std_rad < 0.1
    assert fused.quality is Quality.GOOD


def test_start_set_after_contact_in_the_incident_belongs_to_that_run() -> None:
    """Though the unit is silent now: its trail is corrected."""
    script = Script()
    script.register("FF-01")
    script.act(OpenIncident("i1", "Mill Lane"))
    go_north(script, 60)
    script.now_s += 3600.0
    script.tick()
    script.act(SetStart("FF-01", 100.0, 5.0, 0.0, 0.0, 0.5, 0.05))
    assert fused_of(script).north_m == pytest.approx(159.0, abs=0.5)


def test_common_start_may_be_set_before_the_run() -> None:
    """The commander is quicker than the members who switch on their units."""
    script = Script()
    script.register("FF-01")
    go_north(script, 60)
    script.now_s += 600.0
    script.act(OpenIncident("i1", "Mill Lane"))
    script.act(StartTogether("s", ("FF-01",), 0, 100.0, 200.0, 1.0, None, 0.0, 0.05, ""))
    script.now_s += 600.0
    script.boot_ids["FF-01"] = 8
    go_north(script, 30)
    fused = fused_of(script)
    assert (fused.north_m, fused.east_m) == pytest.approx((129.0, 200.0), abs=1.0)


def test_pin_set_before_the_incident_was_opened_is_solved_in_its_path() -> None:
    script = Script()
    script.register("FF-01")
    go_north(script, 60)
    script.now_s += 600.0
    script.boot_ids["FF-01"] = 8
    go_north(script, 30)
    script.act(StartTogether("s", ("FF-01",), 0, 100.0, 200.0, 1.0, None, 0.0, 0.05, ""))
    script.act(OpenIncident("i1", "Mill Lane"))
    fused = fused_of(script)
    assert (fused.north_m, fused.east_m) == pytest.approx((129.0, 200.0), abs=1.0)


def test_start_of_an_ended_run_contradicts_nothing_in_the_next_incident() -> None:
    script = Script()
    script.register("FF-01")
    script.act(OpenIncident("i0", "Before"))
    script.act(SetStart("FF-01", 0.0, 0.0, 0.0, 0.0, 0.5, 0.05))
    go_north(script, 60)
    script.now_s += 1.0
    script.act(CloseIncident("i0"))
    script.act(OpenIncident("i1", "Mill Lane"))
    script.boot_ids["FF-01"] = 8
    go_north(script, 60)
    script.act(SetPin("p", "FF-01", script.t_ns, 300.0, 50.0, 1.0, None, None, 0.0, ""))
    assert script.pipeline.state.site.pin_verdicts["p"].state == "used"


def test_start_of_a_continuing_run_holds_in_the_next_incident() -> None:
    script = Script()
    script.register("FF-01")
    script.act(SetStart("FF-01", 0.0, 0.0, 0.0, 0.0, 0.5, 0.05))
    script.act(OpenIncident("i0", "Before"))
    go_north(script, 60)
    script.act(CloseIncident("i0"))
    script.now_s += 1.0
    script.act(OpenIncident("i1", "Mill Lane"))
    go_north(script, 10, since_m=60.0)
    script.act(SetPin("p", "FF-01", script.t_ns, 300.0, 50.0, 1.0, None, None, 0.0, ""))
    assert script.pipeline.state.site.pin_verdicts["p"].state == "conflict"
