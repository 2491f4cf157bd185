"""Input of a smoother from the live state: paths, pins and floors. Encounters are handled by
``pin_solver``, as they depend on another unit's path.
"""

from __future__ import annotations

import math
from collections.abc import Collection, Mapping, Sequence

import numpy as np

from base_station.core.durations import format_duration
from base_station.core.pins.pin_registry import BEFORE_NS
from base_station.core.state import SiteState, StationState
from base_station.core.state.pin import WAITING, Beacon, Pin
from base_station.fusion.odometry.path_history import PathHistory
from base_station.fusion.odometry.points import PathArrays
from base_station.fusion.smoothing.interface import (
    ON_FLOOR_STD_M,
    EncounterConstraint,
    PositionConstraint,
    UnitEvidence,
)
from base_station.site.floor_grid import FloorGrid
from base_station.site.learnt_floors import ReportedFloor
from base_station.site.storeys import storey_of
from shared.clock import NS_PER_S
from shared.coded_text import Measure, coded

NEAR_NS = 5 * NS_PER_S  # a pin may be so far ahead of the unit's last position
MIN_STD_M = 0.05  # no place is known better


def evidence_of_site(
    state: StationState, site_id: str, grid: FloorGrid | None
) -> Mapping[str, UnitEvidence]:
    """Return the evidence of every unit of a site that has a path, without meetings; ``grid``: the
    plan's walls.
    """
    return {
        unit_id: evidence_of_one(state, unit_id, own_places(state, unit_id, history), grid)
        for unit_id, history in sorted(state.paths.items())
        if history.begin_ns is not None and state.units[unit_id].site_id == site_id
    }


def encounters_of(state: StationState, site: SiteState) -> list[EncounterConstraint]:
    """Meetings of units whose paths both reach them."""
    encounters = []
    for pin in site.pins.values():
        paths = [state.paths.get(one) for one in (pin.unit_id, pin.other_id)]
        reached = [path for path in paths if path is not None and path.begin_ns is not None]
        if pin.kind == "meeting" and len(reached) == 2:
            times = [time_of(path, pin) for path in reached]
            if not any(isinstance(t_ns, str) for t_ns in times):
                std_m = max(pin.std_m, MIN_STD_M)
                encounters.append(
                    EncounterConstraint(pin.pin_id, pin.unit_id, pin.other_id, pin.t_ns, std_m)
                )
    return encounters


def reported_floors(
    state: StationState, site: SiteState, judged_anew: Collection[str] = ()
) -> list[ReportedFloor]:
    """Floors that pins and beacons give, each with the height estimated there without any pin. A
    pin in conflict is left out, unless its unit is in ``judged_anew``.
    """
    floors = []
    unpacked: dict[str, PathArrays] = {}
    for pin in site.pins.values():
        history = state.paths.get(pin.unit_id)
        floor = location_of(site, pin).floor
        if floor is None or history is None or history.begin_ns is None:
            continue
        verdict = site.pin_verdicts.get(pin.pin_id, WAITING)
        if verdict.state == "conflict" and pin.unit_id not in judged_anew:
            continue
        t_ns = time_of(history, pin)
        if not isinstance(t_ns, str):
            if pin.unit_id not in unpacked:
                unpacked[pin.unit_id] = history.arrays()
            points = unpacked[pin.unit_id]
            row = int(np.searchsorted(points.t_ns, t_ns).clip(0, len(points) - 1))
            north_m, east_m = points.shown_m[row].tolist()
            floors.append(ReportedFloor(north_m, east_m, float(points.down_m[row]), floor))
    return floors


def location_of(site: SiteState, pin: Pin) -> Pin | Beacon:
    """Object that holds the place of a pin: the placed beacon that was sighted, else the pin."""
    return pin if pin.kind == "meeting" else site.beacons.get(pin.other_id, pin)


def reference_receiver(state: StationState, site: SiteState) -> dict[str, UnitEvidence]:
    """Evidence of the site's reference unit, if its start position is set; by unit."""
    unit_id = site.barometers.reference_id or ""
    history = state.paths.get(unit_id)
    if history is None or history.begin_ns is None or history.start.position is None:
        return {}
    return {unit_id: evidence_of_one(state, unit_id, own_places(state, unit_id, history), None)}


def own_places(state: StationState, unit_id: str, history: PathHistory) -> list[PositionConstraint]:
    """Position constraints of a unit's pins, without encounters."""
    site = state.site_of(unit_id)
    pins = [one for one in site.pins.values() if one.unit_id == unit_id and one.kind != "meeting"]
    places = [place_of(site, history, pin) for pin in pins]
    return [place for place in places if not isinstance(place, str)]


def place_of(site: SiteState, history: PathHistory, pin: Pin) -> PositionConstraint | str:
    """Position constraint of a pin on the path, or the reason for which it waits."""
    t_ns = time_of(history, pin)
    return t_ns if isinstance(t_ns, str) else place_at(site, pin, t_ns)


def place_at(site: SiteState, pin: Pin, t_ns: int) -> PositionConstraint | str:
    """Position constraint at a time from a pin that is no encounter, or the reason for which it
    waits.
    """
    beacon = site.beacons.get(pin.other_id) if pin.other_id else None
    if pin.other_id and beacon is None:
        if pin.kind == "tag":
            return coded(
                "pin-tag-unplaced", "the place of tag {tag} has not been set", tag=pin.other_id
            )
        return coded(
            "pin-beacon-unplaced",
            "the place of beacon {beacon} has not been set",
            beacon=pin.other_id,
        )
    at: Pin | Beacon = beacon or pin
    assert at.north_m is not None
    assert at.east_m is not None
    storey = storey_of(site.storeys_at(at.north_m, at.east_m), at.floor)
    return PositionConstraint(
        name=pin.pin_id,
        t_ns=t_ns,
        north_m=at.north_m,
        east_m=at.east_m,
        std_m=max(math.hypot(pin.std_m, beacon.std_m if beacon is not None else 0.0), MIN_STD_M),
        down_m=None if storey is None else storey.down_m,
        down_std_m=math.hypot(ON_FLOOR_STD_M, 0.0 if storey is None else storey.std_m),
        heading_rad=pin.heading_rad,
        heading_std_rad=pin.heading_std_rad,
        source=pin.other_id,
    )


def time_of(history: PathHistory, pin: Pin) -> int | str:
    """Time of a pin on the path (ns, station), or the reason for which it waits."""
    begin_ns, end_ns = history.begin_ns, history.end_ns
    assert begin_ns is not None
    assert end_ns is not None
    if pin.t_ns == 0:
        return begin_ns
    if pin.t_ns > end_ns + NEAR_NS:
        return coded("pin-path-behind", "the unit's path has not come to that time yet")
    if pin.t_ns < begin_ns - BEFORE_NS:
        early_s = (begin_ns - pin.t_ns) / NS_PER_S
        return coded(
            "pin-path-later",
            "the path that is known begins {early_s} later: the unit's journal may still bring "
            "what was before, else give the pin a later time",
            early_s=Measure(early_s, format_duration(early_s)),
        )
    return min(max(pin.t_ns, begin_ns), end_ns)


def evidence_of_one(
    state: StationState, unit_id: str, places: Sequence[PositionConstraint], grid: FloorGrid | None
) -> UnitEvidence:
    """Evidence of a unit that has a path. The start position of the reference unit holds for every
    run of its program.
    """
    history = state.paths[unit_id]
    stays = unit_id == state.site_of(unit_id).barometers.reference_id
    start = history.start.position if stays else history.start.in_path
    return UnitEvidence(
        history.arrays(),
        start,
        history.start.begin_ns,
        places,
        grid,
        history.latest.height_assumed,
        history.path_noise,
        history.noise_runs,
    )
