"""Pins: after any set, move and removal every unit has a place, and removal restores the state
before.
"""

from __future__ import annotations

import math

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from shared.messages.pins import RemovePin
from tests.rig.round_walk import Walk

SECONDS = 80
PINS = st.lists(
    st.tuples(
        st.sampled_from(["p1", "p2", "p3"]),
        st.floats(0.0, float(SECONDS)),
        st.one_of(st.floats(-3.0, 3.0), st.floats(-1e4, 1e4)),
        st.booleans(),  # removed at once
    ),
    min_size=1,
    max_size=6,
)


def walked() -> Walk:
    walk = Walk("FF-01", turn_rad=0.7)
    walk.start("FF-01")
    walk.go(SECONDS)
    return walk


@pytest.fixture(scope="module")
def plain() -> Walk:
    walk = walked()
    walk.go(10)
    return walk


@pytest.mark.slow
@given(pins=PINS)
@settings(max_examples=12, suppress_health_check=[HealthCheck.function_scoped_fixture])
def test_removal_of_all_pins_restores_the_state_before(
    plain: Walk, pins: list[tuple[str, float, float, bool]]
) -> None:
    walk = walked()
    for pin_id, second, off_m, taken_back in pins:
        walk.pin(pin_id, "FF-01", second, off_m)
        unit = walk.script.pipeline.state.units["FF-01"]
        assert unit.place.fused is not None
        assert all(map(math.isfinite, (unit.place.fused.north_m, unit.place.fused.std_north_m)))
        assert all(math.isfinite(step.north_m) for step in unit.trails.shown)
        state = walk.script.pipeline.state
        assert state.site.pin_verdicts.keys() == state.site.pins.keys()
        if taken_back:
            walk.script.act(RemovePin(pin_id))
    for pin_id in list(walk.script.pipeline.state.site.pins):
        walk.script.act(RemovePin(pin_id))
    walk.go(10)
    mine, theirs = (one.script.pipeline.state.units["FF-01"] for one in (walk, plain))
    assert mine.trails.shown == theirs.trails.shown
    assert mine.place.fused is not None
    assert theirs.place.fused is not None
    assert mine.place.fused.north_m == theirs.place.fused.north_m
    assert mine.place.fused.std_east_m == theirs.place.fused.std_east_m
