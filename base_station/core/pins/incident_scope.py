"""Scope of pins: the closed incident or the next one."""

from __future__ import annotations

from base_station.core.pins.pin_registry import PinAction
from base_station.core.state import StationState
from base_station.core.state.pin import Pin
from shared.messages.pins import (
    PlaceBeacon,
    RemoveBeacon,
    RemovePin,
    SetMeeting,
    SetPin,
    StartTogether,
)


def is_about(pin: Pin, closed_ns: int) -> bool:
    """True if a pin belongs to the closed incident.  Start positions are set in advance: one that
    is set after an incident belongs to the next one.
    """
    return pin.set_ns <= closed_ns or _is_before_close(pin.t_ns, closed_ns)


def concerns_closed_incident(
    state: StationState, site_id: str, action: PinAction, closed_ns: int
) -> bool:
    """True if an action changes the paths of the closed incident of a site; called before the
    action is applied.  Beacons are removed after an incident and placed for the next one.  So a
    placed beacon counts if a unit passed it before it had a place, and a removed one never counts.
    """
    pins, beacons = state.sites[site_id].pins, state.sites[site_id].beacons
    match action:
        case SetPin() | SetMeeting():
            earlier = pins.get(action.pin_id)
            is_moved = earlier is not None and is_about(earlier, closed_ns)
            is_here = _is_on(state, site_id, action.unit_id)
            return is_moved or (is_here and _is_before_close(action.t_ns, closed_ns))
        case StartTogether():
            is_here = any(_is_on(state, site_id, unit_id) for unit_id in action.unit_ids)
            return is_here and _is_before_close(action.t_ns, closed_ns)
        case RemovePin(pin_id=pin_id):
            removed = (one for one in pins.values() if _goes_with(one, pin_id))
            return any(is_about(one, closed_ns) for one in removed)
        case PlaceBeacon(beacon_id=beacon_id):
            passed = (one for one in pins.values() if one.other_id == beacon_id)
            is_new = site_id == state.site_id_of(action.incident_id) and beacon_id not in beacons
            return is_new and any(is_about(one, closed_ns) for one in passed)
        case RemoveBeacon():
            return False


def _is_on(state: StationState, site_id: str, unit_id: str) -> bool:
    unit = state.units.get(unit_id)
    return unit is not None and unit.site_id == site_id


def _is_before_close(t_ns: int, closed_ns: int) -> bool:
    return 0 < t_ns <= closed_ns


def _goes_with(pin: Pin, pin_id: str) -> bool:
    return pin.pin_id == pin_id or pin.pin_id.startswith(f"{pin_id}:")
