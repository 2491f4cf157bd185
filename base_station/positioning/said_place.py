"""Where somebody is by a person's word that is newer than all that the unit has told of its path:
of who is not heard, nobody knows better.
"""

from __future__ import annotations

import math

import msgspec

from base_station.fusion.path.history import PathHistory
from base_station.fusion.smoother.port import ON_FLOOR_STD_M
from base_station.live_state import StationState
from base_station.pins.evidence import NEAR_NS, SUREST_M, at_of
from base_station.pins.pin import Pin
from base_station.site.storeys import storey_of, sureness
from shared.messages import FusedPosition
from shared.quality import Quality


def as_said(state: StationState, history: PathHistory, fused: FusedPosition) -> FusedPosition:
    """At the newest pin of a place that the path has not come to; ``fused`` where there is none."""
    pin = _newest(state, history, fused.unit_id)
    at = None if pin is None else at_of(state, pin)
    if pin is None or at is None or at.north_m is None or at.east_m is None:
        return fused
    std_m = max(pin.std_m if at is pin else math.hypot(pin.std_m, at.std_m), SUREST_M)
    said = msgspec.structs.replace(
        fused,
        t_meas_ns=pin.t_ns,
        north_m=at.north_m,
        east_m=at.east_m,
        std_north_m=std_m,
        std_east_m=std_m,
        correlation_ne=0.0,
        heading_std_rad=math.pi,
        quality=Quality.GOOD,
        quality_reason="",
    )
    storeys = state.storeys_at(at.north_m, at.east_m)
    storey = storey_of(storeys, at.floor)
    if at.floor is None:
        return said
    if storey is None:  # nobody knows how high that is
        return msgspec.structs.replace(said, floor=at.floor, floor_probability=None)
    std_down_m = math.hypot(ON_FLOOR_STD_M, storey.std_m)
    return msgspec.structs.replace(
        said,
        down_m=storey.down_m,
        std_down_m=std_down_m,
        floor=storey.floor,
        floor_probability=sureness(storeys, storey.floor, storey.down_m, std_down_m),
    )


def _newest(state: StationState, history: PathHistory, unit_id: str) -> Pin | None:
    if history.awaited_ns is None or history.end_ns is None:  # nearly always
        return None
    ahead_ns = history.end_ns + NEAR_NS
    pins = (
        pin
        for pin in state.pins.values()
        if pin.unit_id == unit_id and pin.kind != "meeting" and pin.t_ns > ahead_ns
    )
    return max(pins, key=lambda pin: pin.t_ns, default=None)
