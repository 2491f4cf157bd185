"""The position of a member, as the console shows it."""

from __future__ import annotations

import pytest

from base_station.storage.db.known_people import person_lookup
from base_station.views.units import unit_views
from base_station.views.wire import PositionView
from shared.messages.station import SetPlan, SetStart
from tests.rig.round_walk import PLAN
from tests.rig.station_script import Script

U = "FF-01"


def shown(script: Script) -> PositionView:
    state = script.pipeline.state
    (card,) = unit_views(state, state.units.values(), person_lookup({}))
    assert card.position is not None
    return card.position


@pytest.mark.parametrize("planned", [True, False])
def test_height_of_a_floor_is_that_of_the_plan_or_learnt(planned: bool) -> None:
    script = Script()
    script.register(U)
    if planned:
        script.act(SetPlan(PLAN))
    script.act(SetStart(U, 10.0, 2.0, 0.0, 0.0, 0.3, 0.05))
    for second in range(60):
        script.now_s += 1.0
        script.position(U, 0.0, 0.9 * second, distance_m=0.9 * second)
    position = shown(script)
    assert position.floor == 0
    assert position.floor_down_m == pytest.approx(0.0, abs=0.3)
