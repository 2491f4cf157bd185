"""What consoles are told of a pipeline, and how much of it at a time."""

from __future__ import annotations

import msgspec

from base_station.events import TrailFilled
from base_station.live.picture import FILLED_A_TURN, Picture
from base_station.live_state import UnitState
from base_station.trail import TrailStep
from shared.clock import NS_PER_S
from tests.live_station import Screen, make_pipeline

UNITS = [f"FF-{i:02}" for i in range(2 * FILLED_A_TURN + 3)]


def walked(screen: Screen) -> Picture:
    pipeline = make_pipeline()
    for unit_id in UNITS:
        unit = pipeline.state.units[unit_id] = UnitState(unit_id)
        unit.trail.append(TrailStep(NS_PER_S, 1.0, 2.0, 0))
    return Picture(pipeline, screen, lambda _: None)


def test_who_joins_gets_every_trail_beside_the_snapshot() -> None:
    shown, trails = walked(Screen()).whole()
    assert [unit.unit_id for unit in shown.units] == UNITS
    assert {unit_id: msgspec.json.decode(points) for unit_id, points in trails.items()} == {
        unit_id: [[1000, 1.0, 2.0, 0]] for unit_id in UNITS
    }


def test_trails_that_were_filled_in_are_told_some_at_a_time() -> None:
    """A radio that is back fills everybody's at once; positions do not wait for all of them."""
    screen = Screen()
    picture = walked(screen)
    picture.note([TrailFilled(unit_id) for unit_id in UNITS])
    picture.flush()
    assert not screen.deltas, "once a second will do"
    for health in (True, False, False, False):
        picture.flush(health)
    told = [list(delta.trails) for delta in screen.deltas]
    assert [len(trails) for trails in told] == [FILLED_A_TURN, FILLED_A_TURN, 3]
    assert sorted(one for trails in told for one in trails) == UNITS


def test_a_snapshot_to_all_takes_the_place_of_what_was_not_told_yet() -> None:
    screen = Screen()
    picture = walked(screen)
    picture.note([TrailFilled(unit_id) for unit_id in UNITS])
    picture.flush(health=True)
    picture.reset()
    picture.flush()
    assert (len(screen.deltas), len(screen.resets)) == (1, 1)
