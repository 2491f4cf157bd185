"""Sets, moves and removes pins and beacons; ``pin_solver`` solves trails with them.

Every check gives a sentence with the reason why a pin cannot be taken.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

import msgspec

from base_station.core.durations import format_duration
from base_station.core.state import SiteState, StationState
from base_station.core.state.pin import WAITING, Beacon, Pin, reach_std_m
from base_station.core.state.resolve_queue import request_resolve
from base_station.site.plan import Plan
from shared.clock import NS_PER_S
from shared.coded_text import Measure, coded
from shared.errors import UserError
from shared.geo import rotate
from shared.messages.pins import (
    PlaceBeacon,
    RemoveBeacon,
    RemovePin,
    SetMeeting,
    SetPin,
    StartTogether,
)

PinAction = SetPin | StartTogether | SetMeeting | RemovePin | PlaceBeacon | RemoveBeacon
MAX_PINS = 1000
FURTHEST_M = 1000.0  # from the plan's outlines
FUTURE_NS = NS_PER_S
BEFORE_NS = 10 * NS_PER_S  # of a path's beginning: that is where it is pinned
LARGEST_STD_M = 1000.0
DEEPEST, HIGHEST = -20, 200  # floors


def change_pins(state: StationState, by: str, action: PinAction) -> set[str]:
    """Apply an action; returns the units whose paths change.  UserError where it can have no
    effect.
    """
    match action:
        case SetPin():
            return _set_pins(state, [_place_pin(state, by, action)])
        case StartTogether():
            return _set_pins(state, _start_pins(state, by, action))
        case SetMeeting():
            return _set_pins(state, [_meeting_pin(state, by, action)])
        case RemovePin():
            return _remove_pin(state, action.pin_id)
        case PlaceBeacon():
            return _place_beacon(state, by, action)
        case RemoveBeacon():
            return _remove_beacon(state, action.beacon_id)


def forget(state: StationState, unit_id: str) -> set[str]:
    """Remove every pin that constrains this unit; returns the other units whose paths change."""
    pinned = (drop(site, lambda pin: unit_id in units_of(pin)) for site in state.sites.values())
    return set().union(*pinned) - {unit_id}


def drop(site: SiteState, unwanted: Callable[[Pin], bool]) -> set[str]:
    """Remove pins; returns the units that they concerned."""
    changed: set[str] = set()
    for pin_id in [one for one, pin in site.pins.items() if unwanted(pin)]:
        changed |= units_of(site.pins.pop(pin_id))
        site.pin_verdicts.pop(pin_id, None)
    return changed


def reframe_pins(site: SiteState, turn_rad: float, north_m: float, east_m: float) -> None:
    """Move the pins with the incident frame, which was turned clockwise, then shifted."""
    for pin_id, pin in site.pins.items():
        heading_rad = None if pin.heading_rad is None else pin.heading_rad + turn_rad
        if pin.north_m is not None and pin.east_m is not None:
            north, east = rotate(pin.north_m, pin.east_m, turn_rad)
            site.pins[pin_id] = msgspec.structs.replace(
                pin, north_m=north + north_m, east_m=east + east_m, heading_rad=heading_rad
            )
    for beacon in site.beacons.values():
        north, east = rotate(beacon.north_m, beacon.east_m, turn_rad)
        beacon.north_m, beacon.east_m = north + north_m, east + east_m


def has_pins(state: StationState, unit_id: str) -> bool:
    """True where a pin concerns this unit's path."""
    return any(unit_id in units_of(pin) for pin in state.site_of(unit_id).pins.values())


def resolve_later(state: StationState, unit_id: str) -> None:
    """Request that the past of a unit is solved again, where a pin concerns it."""
    if has_pins(state, unit_id):
        request_resolve(state.late, unit_id, state.t_ns)


def units_of(pin: Pin) -> set[str]:
    """Units whose paths a pin concerns."""
    return {pin.unit_id, pin.other_id} if pin.kind == "meeting" else {pin.unit_id}


def put(site: SiteState, pin: Pin) -> None:
    """Store a checked pin; it replaces an earlier one with its id."""
    site.pins[pin.pin_id] = pin
    site.pin_verdicts[pin.pin_id] = WAITING


def _set_pins(state: StationState, pins: Sequence[Pin]) -> set[str]:
    """Set pins that belong together; returns the ids of the units whose paths they concern.

    Raises UserError for pins of several sites, or for too many.
    """
    sites = {state.units[unit_id].site_id for pin in pins for unit_id in units_of(pin)}
    if len(sites) > 1:
        raise UserError(
            coded(
                "pin-incidents-differ",
                "these units are in different incidents: they have no place in common",
            )
        )
    site = state.sites[sites.pop()]
    new = sum(pin.pin_id not in site.pins for pin in pins)
    if new and len(site.pins) + new > MAX_PINS:
        there = len(site.pins)
        raise UserError(
            coded(
                "pins-too-many",
                "there is room for {most} pins, not {wanted}; remove some first",
                most=MAX_PINS,
                wanted=there + new,
            )
        )
    changed: set[str] = set()
    for pin in pins:
        earlier = site.pins.get(pin.pin_id)
        changed |= units_of(pin) | (units_of(earlier) if earlier is not None else set())
        put(site, pin)
    return changed


def _place_pin(state: StationState, by: str, action: SetPin) -> Pin:
    state.registered_unit(action.unit_id)
    _check_time(state, action.unit_id, action.t_ns)
    _check_place(state.site_of(action.unit_id), action)
    return Pin(kind="place", set_ns=state.t_ns, by=by, **msgspec.structs.asdict(action))


def _start_pins(state: StationState, by: str, action: StartTogether) -> list[Pin]:
    """Pins of a common start position, for the units that were switched on after its time."""
    if not action.unit_ids:
        raise UserError(coded("pin-no-unit", "no unit to place: name at least one unit"))
    _check_place(state.site_of(action.unit_ids[0]), action)
    common = msgspec.structs.asdict(action)
    del common["pin_id"], common["unit_ids"], common["t_ns"]
    pins = []
    for unit_id in dict.fromkeys(action.unit_ids):
        state.registered_unit(unit_id)
        t_ns = 0 if _early_s(state, unit_id, action.t_ns) else action.t_ns
        _check_time(state, unit_id, t_ns)
        pin_id = f"{action.pin_id}:{unit_id}"
        pins.append(Pin(pin_id, "start", unit_id, t_ns, set_ns=state.t_ns, by=by, **common))
    return pins


def _meeting_pin(state: StationState, by: str, action: SetMeeting) -> Pin:
    if action.unit_id == action.other_unit_id:
        raise UserError(coded("pin-meets-itself", "a unit cannot meet itself: name two units"))
    for unit_id in (action.unit_id, action.other_unit_id):
        state.registered_unit(unit_id)
        _check_time(state, unit_id, action.t_ns)
    _check_std(action.std_m)
    return Pin(
        pin_id=action.pin_id,
        kind="meeting",
        unit_id=action.unit_id,
        t_ns=action.t_ns,
        std_m=action.std_m,
        set_ns=state.t_ns,
        by=by,
        note=action.note,
        other_id=action.other_unit_id,
    )


def _remove_pin(state: StationState, pin_id: str) -> set[str]:
    group = f"{pin_id}:"
    changed: set[str] = set()
    for site in state.sites.values():
        changed |= drop(site, lambda pin: pin.pin_id == pin_id or pin.pin_id.startswith(group))
    if not changed:
        raise UserError(
            coded("pin-gone", "there is no pin {pin}; it may have been removed already", pin=pin_id)
        )
    return changed


def _place_beacon(state: StationState, by: str, action: PlaceBeacon) -> set[str]:
    site = state.sites[state.site_id_of(action.incident_id)]
    _check_place(site, action)
    if not (math.isfinite(action.reach_m) and action.reach_m >= 0.0):
        raise UserError(
            coded("beacon-reach", "how far a beacon reaches is a number of metres, 0 or more")
        )
    earlier = site.beacons.get(action.beacon_id)
    for pin in _sightings_of(site, action.beacon_id):
        if not pin.is_ranged:
            std_m = reach_std_m(action.reach_m)
            site.pins[pin.pin_id] = msgspec.structs.replace(pin, std_m=std_m)
    site.beacons[action.beacon_id] = Beacon(
        **{name: getattr(action, name) for name in _BEACON_FIELDS},
        placed_ns=state.t_ns,
        by=by,
        seen_ns=earlier.seen_ns if earlier is not None else None,
    )
    return {pin.unit_id for pin in _sightings_of(site, action.beacon_id)}


_BEACON_FIELDS = ("beacon_id", "label", "north_m", "east_m", "floor", "std_m", "reach_m")


def _remove_beacon(state: StationState, beacon_id: str) -> set[str]:
    site = next((one for one in state.sites.values() if beacon_id in one.beacons), None)
    if site is None:
        raise UserError(
            coded(
                "beacon-gone",
                "there is no beacon {beacon}; it may have been removed already",
                beacon=beacon_id,
            )
        )
    del site.beacons[beacon_id]
    return {pin.unit_id for pin in _sightings_of(site, beacon_id)}


def _sightings_of(site: SiteState, beacon_id: str) -> list[Pin]:
    return [
        pin
        for pin in site.pins.values()
        if pin.kind in {"beacon", "tag"} and pin.other_id == beacon_id
    ]


def _check_time(state: StationState, unit_id: str, t_ns: int) -> None:
    if t_ns > state.t_ns + FUTURE_NS:
        ahead_s = (t_ns - state.t_ns) / NS_PER_S
        raise UserError(
            coded(
                "pin-in-future",
                "the pin's time is {ahead_s} in the future; say when it was",
                ahead_s=Measure(ahead_s, format_duration(ahead_s)),
            )
        )
    if early_s := _early_s(state, unit_id, t_ns):
        raise UserError(
            coded(
                "pin-before-path",
                "the pin's time is {early_s} before the path of {unit} begins; there is nothing "
                "to pin there",
                early_s=Measure(early_s, format_duration(early_s)),
                unit=unit_id,
            )
        )


def _early_s(state: StationState, unit_id: str, t_ns: int) -> float:
    """Seconds from a time to the begin of a unit's path; 0 where the path began earlier."""
    history = state.paths.get(unit_id)
    begin_ns = None if history is None else history.begin_ns
    if t_ns == 0 or begin_ns is None or t_ns >= begin_ns - BEFORE_NS:
        return 0.0
    return (begin_ns - t_ns) / NS_PER_S


def _check_place(site: SiteState, action: SetPin | StartTogether | PlaceBeacon) -> None:
    if not (math.isfinite(action.north_m) and math.isfinite(action.east_m)):
        raise UserError(coded("place-no-numbers", "the place is no pair of numbers"))
    _check_std(action.std_m)
    if not isinstance(action, PlaceBeacon) and action.heading_rad is not None:
        _check_heading(action.heading_rad, action.heading_std_rad)
    plan = site.plan
    if action.floor is not None:
        _check_floor(plan, action.floor)
    if plan is not None and plan.outlines:
        away_m = plan.away_m(action.north_m, action.east_m)
        if away_m > FURTHEST_M:
            raise UserError(
                coded(
                    "place-too-far",
                    "the place is {away_m:.0f} m from the plan's building; at most "
                    "{most_m:.0f} m make sense",
                    away_m=away_m,
                    most_m=FURTHEST_M,
                )
            )


def _check_floor(plan: Plan | None, floor: int) -> None:
    """Check a floor against the plan; without a plan's storeys any number is accepted, as it
    numbers the learnt ones.
    """
    floors = () if plan is None else [storey.floor for storey in plan.storeys]
    if floors and floor not in floors:
        known = ", ".join(map(str, floors))
        raise UserError(
            coded(
                "floor-not-on-plan",
                "the plan has no floor {floor}; it has: {known}",
                floor=floor,
                known=known,
            )
        )
    if not DEEPEST <= floor <= HIGHEST:
        raise UserError(
            coded(
                "floor-out-of-range",
                "no building has a floor {floor}; from {lowest} to {highest} make sense",
                floor=floor,
                lowest=DEEPEST,
                highest=HIGHEST,
            )
        )


def _check_std(std_m: float) -> None:
    if not (math.isfinite(std_m) and 0.0 < std_m <= LARGEST_STD_M):
        raise UserError(
            coded(
                "uncertainty-unfit",
                "an uncertainty of {std_m} m cannot be weighed; say how many metres it may "
                "be off, more than 0",
                std_m=std_m,
            )
        )


def _check_heading(heading_rad: float, std_rad: float) -> None:
    if not (math.isfinite(heading_rad) and math.isfinite(std_rad) and std_rad > 0.0):
        raise UserError(
            coded("heading-unfit", "a heading needs an angle, and an uncertainty of more than 0")
        )
