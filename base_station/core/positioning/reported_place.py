"""Reported place: a person's pin newer than the path of a unit without contact is its position."""

from __future__ import annotations

import math

import msgspec

from base_station.core.pins.evidence import NEAR_NS, location_of, place_at
from base_station.core.state import SiteState, StationState
from base_station.core.state.pin import Pin
from base_station.fusion.odometry.path_history import PathHistory
from base_station.fusion.smoothing.interface import PositionConstraint
from base_station.site.storeys import floor_probability
from shared.messages import FusedPosition
from shared.quality import Quality


def apply_reported_place(
    state: StationState, history: PathHistory, fused: FusedPosition
) -> FusedPosition:
    """Return the position at the newest pin after the end of the path; ``fused`` where there is
    none.
    """
    site = state.site_of(fused.unit_id)
    pin = _newest_pin_ahead(site, history, fused.unit_id)
    place = None if pin is None else place_at(site, pin, pin.t_ns)
    if pin is None or not isinstance(place, PositionConstraint):
        return fused
    reported = msgspec.structs.replace(
        fused,
        t_meas_ns=place.t_ns,
        north_m=place.north_m,
        east_m=place.east_m,
        std_north_m=place.std_m,
        std_east_m=place.std_m,
        correlation_ne=0.0,
        heading_std_rad=math.pi,
        quality=Quality.GOOD,
        quality_reason="",
    )
    floor = location_of(site, pin).floor
    if floor is None:
        return reported
    if place.down_m is None:  # the height of that floor is unknown
        return msgspec.structs.replace(reported, floor=floor, floor_probability=None)
    storeys = site.storeys_at(place.north_m, place.east_m)
    return msgspec.structs.replace(
        reported,
        down_m=place.down_m,
        std_down_m=place.down_std_m,
        floor=floor,
        floor_probability=floor_probability(storeys, floor, place.down_m, place.down_std_m),
    )


def _newest_pin_ahead(site: SiteState, history: PathHistory, unit_id: str) -> Pin | None:
    if history.awaited_ns is None or history.end_ns is None:  # nearly always
        return None
    ahead_ns = history.end_ns + NEAR_NS
    pins = (
        pin
        for pin in site.pins.values()
        if pin.unit_id == unit_id and pin.kind != "meeting" and pin.t_ns > ahead_ns
    )
    return max(pins, key=lambda pin: pin.t_ns, default=None)
