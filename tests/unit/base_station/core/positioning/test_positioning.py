"""Stages of a position: their order, and what each sets for the next."""

from __future__ import annotations

import math

from base_station.core.positioning.fuse_stages import PositionUpdate, place_in_time
from base_station.core.positioning.locate_stages import LocationUpdate, find_floor, show
from base_station.core.positioning.positioning import FUSE, LOCATE, LOCATE_LATE
from base_station.core.state import StationState
from base_station.fusion import FUSERS
from shared.clock import NS_PER_S
from tests.rig import message_factory
from tests.rig.station_script import Script

U = "FF-01"


def test_stages_stand_in_the_order_that_the_docs_list() -> None:
    assert [stage.__name__ for stage in FUSE] == [
        "place_in_time", "predict", "update_height_and_heading", "match_building",
        "extend_path", "learn_storey",
    ]  # fmt: skip
    assert [stage.__name__ for stage in LOCATE] == [
        "find_floor", "extend_trails", "keep_in_path", "apply_reported_place", "show",
        "note_inside",
    ]  # fmt: skip
    assert [stage.__name__ for stage in LOCATE_LATE] == ["find_earlier_floor", "insert_into_trails"]


def walked(seconds: int) -> Script:
    script = Script()
    script.register(U)
    script.wait(seconds, lambda: script.position(U, script.now_s, 0.0))
    return script


def test_outage_is_time_since_last_position_of_path() -> None:
    script = walked(3)
    state, unit = script.pipeline.state, script.pipeline.state.units[U]
    script.now_s += 2.0
    state.t_ns = script.t_ns
    position = message_factory.position(script.header(U), north_m=5.0)
    fuser = FUSERS[0].new()
    update = PositionUpdate(
        state, state.site, unit, position, state.path_of(U), (fuser,), has_plan=False
    )
    place_in_time(update)
    assert (update.t_ns, update.outage_s) == (script.t_ns, 2.0)
    first = PositionUpdate(
        state, state.site, unit, position, StationState().path_of(U), (fuser,), has_plan=False
    )
    place_in_time(first)
    assert math.isinf(first.outage_s)


def test_location_is_shown_and_ends_loss_of_position() -> None:
    script = walked(2)
    state, unit = script.pipeline.state, script.pipeline.state.units[U]
    unit.place.lost_since_ns = NS_PER_S
    fuser = FUSERS[0].new()
    assert unit.position is not None
    fuser.predict(unit.position)
    estimate = fuser.estimate()
    assert estimate is not None
    update = LocationUpdate(
        state, unit, None, unit.path_boot, "test", state.next_header(), estimate, None
    )
    find_floor(update)
    assert update.fused is update.plain
    show(update)
    assert unit.place.fused is update.fused
    assert unit.place.lost_since_ns is None
