"""Which pins are about an incident that is closed already, and not about the next one."""

from __future__ import annotations

from base_station.live_state import StationState
from base_station.pins.book import PinAction
from base_station.pins.pin import Pin
from shared.messages.pins import (
    PlaceBeacon,
    RemoveBeacon,
    RemovePin,
    SetMeeting,
    SetPin,
    StartTogether,
)


def is_about(pin: Pin, closed_ns: int) -> bool:
    """Where paths begin is said beforehand: of the next incident, where it is said after one."""
    return pin.set_ns <= closed_ns or _is_then(pin.t_ns, closed_ns)


def looks_back(state: StationState, action: PinAction, closed_ns: int) -> bool:
    """Whether it tells more of the time until then; asked before it is done.

    Beacons are taken down after an incident and hung up for the next.  So one counts that
    somebody passed and nobody had placed, and none is taken away.
    """
    match action:
        case SetPin() | SetMeeting():
            earlier = state.pins.get(action.pin_id)
            is_moved = earlier is not None and is_about(earlier, closed_ns)
            return is_moved or _is_then(action.t_ns, closed_ns)
        case StartTogether():
            return _is_then(action.t_ns, closed_ns)
        case RemovePin(pin_id=pin_id):
            removed = (one for one in state.pins.values() if _goes_with(one, pin_id))
            return any(is_about(one, closed_ns) for one in removed)
        case PlaceBeacon(beacon_id=beacon_id):
            passed = (one for one in state.pins.values() if one.other_id == beacon_id)
            is_new = beacon_id not in state.beacons
            return is_new and any(is_about(one, closed_ns) for one in passed)
        case RemoveBeacon():
            return False


def _is_then(t_ns: int, closed_ns: int) -> bool:
    return 0 < t_ns <= closed_ns


def _goes_with(pin: Pin, pin_id: str) -> bool:
    return pin.pin_id == pin_id or pin.pin_id.startswith(f"{pin_id}:")
