"""Pins from sightings of beacons, tags and other units.

A unit that stays near a beacon reports it again and again; sightings within ``SAME_VISIT_NS`` are
one pin, at the time of the shortest distance.
"""

from __future__ import annotations

import math
from collections import Counter

from base_station.core.closed_incidents import is_before_incident
from base_station.core.pins.pin_registry import MAX_PINS, drop, put, units_of
from base_station.core.state import SiteState, StationState, UnitState
from base_station.core.state.boot_state import captured_ns
from base_station.core.state.pin import Pin, PinKind, reach_std_m
from shared.clock import NS_PER_S
from shared.messages import Sighting, SightingKind

MAX_SIGHTINGS = MAX_PINS - 200  # the rest is for pins that people report
SAME_VISIT_NS = 20 * NS_PER_S  # sightings closer in time than this are one
MIN_IMPROVEMENT = 0.7  # of the earlier standard deviation: then the path is solved again
REACH_M = 3.0  # of a beacon that is not placed yet
TAG_REACH_M = 0.5  # of an arm
MEETING_REACH_M = 3.0
FURTHEST_M = 100.0
_KINDS: dict[SightingKind, PinKind] = {
    SightingKind.BEACON: "beacon",
    SightingKind.TAG: "tag",
    SightingKind.UNIT: "meeting",
}


def note_sighting(state: StationState, unit: UnitState, sighting: Sighting) -> set[str]:
    """Return the units whose past the sighting changes; unusable ones are counted by reason."""
    t_ns = captured_ns(unit.boots, sighting.header, state.t_ns)
    reason = _rejection_reason(state, unit, sighting, t_ns)
    if reason:
        unit.count_rejected(reason)
        return set()
    assert t_ns is not None
    site = state.sites[unit.site_id]
    beacon = site.beacons.get(sighting.seen_id)
    if beacon is not None and sighting.kind is not SightingKind.UNIT:
        beacon.seen_ns = max(t_ns, beacon.seen_ns or 0)
    pin = Pin(
        pin_id=f"{unit.unit_id}-{sighting.header.boot_id:x}-{sighting.header.seq}",
        kind=_KINDS[sighting.kind],
        unit_id=unit.unit_id,
        t_ns=t_ns,
        std_m=_std_m(site, sighting),
        set_ns=state.t_ns,
        by=unit.unit_id,
        other_id=sighting.seen_id,
        is_ranged=sighting.range_m is not None,
    )
    replaced = _same_visit(site, pin)
    if replaced is not None and pin.std_m > MIN_IMPROVEMENT * replaced.std_m:
        return set()
    if replaced is None and len(site.pins) >= MAX_SIGHTINGS:
        replaced = _most_redundant(site)
    changed = drop(site, lambda one: one is replaced)
    put(site, pin)
    return changed | units_of(pin)


def _rejection_reason(
    state: StationState, unit: UnitState, sighting: Sighting, t_ns: int | None
) -> str:
    site, meets = state.sites[unit.site_id], sighting.kind is SightingKind.UNIT
    other = state.units.get(sighting.seen_id) if meets else None
    range_m = sighting.range_m or 0.0
    causes = (
        (not unit.registered, "a sighting of a unit that is not registered"),
        (sighting.kind not in _KINDS or not sighting.seen_id, "a sighting of nothing"),
        (t_ns is None, "a sighting of an unknown time"),
        (
            t_ns is not None and is_before_incident(state, unit, t_ns),
            "a sighting of before this incident",
        ),
        (range_m > FURTHEST_M, "a sighting from too far away"),
        (meets and (other is None or not other.registered), "a meeting with an unknown unit"),
        (other is unit, "a meeting with itself"),
        (
            other is not None and other.site_id != unit.site_id,
            "a meeting with a unit of another incident",
        ),
        (
            len(site.pins) >= MAX_SIGHTINGS and not _sighting_pins(site),
            "no room for sightings beside what people pinned",
        ),
    )
    return next((why for holds, why in causes if holds), "")


def _std_m(site: SiteState, sighting: Sighting) -> float:
    """Standard deviation along each axis; a point on a circle of known range has half its square as
    variance.
    """
    if sighting.range_m is not None:
        return math.hypot(sighting.range_m / math.sqrt(2.0), sighting.range_std_m or 0.5)
    beacon = site.beacons.get(sighting.seen_id)
    reach_m = {
        SightingKind.BEACON: REACH_M if beacon is None else beacon.reach_m,
        SightingKind.TAG: TAG_REACH_M if beacon is None else beacon.reach_m,
    }.get(sighting.kind, MEETING_REACH_M)
    return reach_std_m(reach_m)


def _same_visit(site: SiteState, pin: Pin) -> Pin | None:
    """Newest pin from a sighting by the same two within one visit; pins of people are
    not replaced.
    """
    for earlier in reversed(_sighting_pins(site)):
        same = {earlier.unit_id, earlier.other_id} == {pin.unit_id, pin.other_id}
        if same and earlier.kind == pin.kind and abs(earlier.t_ns - pin.t_ns) < SAME_VISIT_NS:
            return earlier
    return None


def _most_redundant(site: SiteState) -> Pin:
    """Pin to drop when there are too many: the earliest of the longest stay of the unit with the
    most sightings.  So a single passage is kept, and no unit displaces the pins of another.
    """
    seen = _sighting_pins(site)
    ((busiest, _),) = Counter(pin.unit_id for pin in seen).most_common(1)
    seen = [pin for pin in seen if pin.unit_id == busiest]
    ((longest, _),) = Counter(pin.other_id for pin in seen).most_common(1)
    return min((pin for pin in seen if pin.other_id == longest), key=lambda pin: pin.t_ns)


def _sighting_pins(site: SiteState) -> list[Pin]:
    """The pins that units made, not people."""
    return [pin for pin in site.pins.values() if pin.by == pin.unit_id]
