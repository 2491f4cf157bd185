"""Start position: a person sets the origin of a unit's own frame, and the path since
then follows.
"""

from __future__ import annotations

import msgspec
import numpy as np

from base_station.core.pins.pin_solver import trail_of
from base_station.core.state import StationState, UnitState
from base_station.fusion.interface import Estimate, Fuser, Start
from base_station.fusion.odometry.path_history import PathHistory
from base_station.fusion.odometry.start_correction import StartCorrection


def begin(
    state: StationState, unit: UnitState, fuser: Fuser, history: PathHistory, start: Start
) -> None:
    """Begin the fuser, the path and the trail at the start position."""
    before = fuser.estimate()
    fuser.start(start)
    history.set_start(start)
    replay_from_start(state, unit, fuser, history, before)


def replay_from_start(
    state: StationState,
    unit: UnitState,
    fuser: Fuser,
    history: PathHistory,
    before: Estimate | None,
) -> None:
    """Move the path and the trail of the run as the fuser was moved; ``before``: its earlier
    estimate.
    """
    after = fuser.estimate()
    correction = None
    if unit.position is not None and before is not None and after is not None:
        correction = _start_correction(
            history.runs.begin_ns, unit, fuser, after.down_m - before.down_m
        )
    if correction is None:  # it has not moved yet
        return
    history.apply_start_correction(correction)
    drop_learnt(state, unit.unit_id)
    points = history.arrays()
    places_m = np.column_stack((points.shown_m, points.down_m))
    trail = trail_of(state, unit.unit_id, points, places_m)
    since = [one for one in trail if one.t_ns >= correction.begin_ns]
    unit.trails.replace_plain(correction.begin_ns, since)


def drop_learnt(state: StationState, unit_id: str) -> None:
    """Drop the landmarks of the building that were learnt from a unit at a wrong place."""
    site = state.site_of(unit_id)
    site.learnt_floors.drop_learnt(unit_id)
    site.learnt_building = site.learnt_building.without(unit_id)


def _start_correction(
    begin_ns: int, unit: UnitState, fuser: Fuser, sunk_m: float
) -> StartCorrection | None:
    """Correction from two points of the own path as the fuser estimates them: the origin, and one
    metre north of it.
    """
    assert unit.position is not None
    origin, beside = (
        fuser.estimate_at(msgspec.structs.replace(unit.position, north_m=north_m, east_m=0.0))
        for north_m in (0.0, 1.0)
    )
    if origin is None or beside is None:
        return None
    cosine, sine = beside.north_m - origin.north_m, beside.east_m - origin.east_m
    return StartCorrection(begin_ns, origin.north_m, origin.east_m, cosine, sine, sunk_m)
