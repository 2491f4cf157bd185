"""Test of pins: about an incident that is closed, or about the next one."""

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
    """True of a pin of the closed incident. Start positions are set beforehand: one that is set
    after an incident is about the next one.
    """
    return pin.set_ns <= closed_ns or _is_then(pin.t_ns, closed_ns)


def concerns_closed_incident(state: StationState, action: PinAction, closed_ns: int) -> bool:
    """True of an action that changes the paths of the closed incident; called before the action is
    applied.

    Beacons are taken down after an incident and put up for the next one. So a placed beacon counts
    if it was passed while it had no place, and a removed one never does.
    """
    pins = {pin_id: pin for site in state.sites.values() for pin_id, pin in site.pins.items()}
    match action:
        case SetPin() | SetMeeting():
            earlier = pins.get(action.pin_id)
            is_moved = earlier is not None and is_about(earlier, closed_ns)
            return is_moved or _is_then(action.t_ns, closed_ns)
        case StartTogether():
            return _is_then(action.t_ns, closed_ns)
        case RemovePin(pin_id=pin_id):
            removed = (one for one in pins.values() if _goes_with(one, pin_id))
            return any(is_about(one, closed_ns) for one in removed)
        case PlaceBeacon(beacon_id=beacon_id):
            passed = (one for one in pins.values() if one.other_id == beacon_id)
            is_new = beacon_id not in state.site.beacons
            return is_new and any(is_about(one, closed_ns) for one in passed)
        case RemoveBeacon():
            return False


def _is_then(t_ns: int, closed_ns: int) -> bool:
    return 0 < t_ns <= closed_ns


def _goes_with(pin: Pin, pin_id: str) -> bool:
    return pin.pin_id == pin_id or pin.pin_id.startswith(f"{pin_id}:")
