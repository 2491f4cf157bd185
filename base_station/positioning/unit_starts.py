"""A person says where a unit's own frame begins: whatever it walked since leads on from there."""

from __future__ import annotations

import msgspec
import numpy as np

from base_station.fusion.path.history import PathHistory
from base_station.fusion.path.start_correction import StartCorrection
from base_station.fusion.port import Estimate, Fuser, Start
from base_station.live_state import StationState, UnitState
from base_station.pins.pinning import trail_of


def begin(
    state: StationState, unit: UnitState, fuser: Fuser, history: PathHistory, start: Start
) -> None:
    """The fuser, the path and the trail begin there."""
    before = fuser.estimate()
    fuser.start(start)
    history.begin_with(start)
    lead_on(state, unit, fuser, history, before)


def lead_on(
    state: StationState,
    unit: UnitState,
    fuser: Fuser,
    history: PathHistory,
    before: Estimate | None,
) -> None:
    """The path and the trail of the run follow the fuser, which had the wearer there ``before``."""
    after = fuser.estimate()
    led = None
    if unit.position is not None and before is not None and after is not None:
        led = _led(history.boot_begin_ns, unit, fuser, after.down_m - before.down_m)
    if led is None:  # it has not gone anywhere yet
        return
    history.lead(led)
    unlearn(state, unit.unit_id)
    points = history.arrays()
    places_m = np.column_stack((points.shown_m, points.down_m))
    since = [one for one in trail_of(state, points, places_m) if one.t_ns >= led.begin_ns]
    unit.change_plain_trail(led.begin_ns, since)


def unlearn(state: StationState, unit_id: str) -> None:
    """What was learnt of the building from somebody who was elsewhere."""
    state.learnt_floors.unlearn(unit_id)
    state.learnt_building = state.learnt_building.without(unit_id)


def _led(begin_ns: int, unit: UnitState, fuser: Fuser, sunk_m: float) -> StartCorrection | None:
    """As the fuser sees two places of the own path: its origin, and one beside."""
    assert unit.position is not None
    origin, beside = (
        fuser.recall(msgspec.structs.replace(unit.position, north_m=north_m, east_m=0.0))
        for north_m in (0.0, 1.0)
    )
    if origin is None or beside is None:
        return None
    cosine, sine = beside.north_m - origin.north_m, beside.east_m - origin.east_m
    return StartCorrection(begin_ns, origin.north_m, origin.east_m, cosine, sine, sunk_m)
