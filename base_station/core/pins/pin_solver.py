"""Solves the past of units again with the pins that are known of them.

A meeting pins each of the two where the other is by everything else that is known of that one,
so that neither believes itself by way of the other.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field

import msgspec
import numpy as np
from numpy.typing import NDArray

from base_station.core.durations import format_duration
from base_station.core.pins.evidence import (
    evidence_of_one,
    own_places,
    place_of,
    reference_receiver,
    time_of,
)
from base_station.core.pins.pin_registry import units_of
from base_station.core.state import SiteState, StationState
from base_station.core.state.pin import WAITING, Pin, PinVerdict
from base_station.core.state.trail import TRAIL_GAP_NS, TRAIL_POINTS, TrailStep
from base_station.fusion.odometry.path_history import PathHistory
from base_station.fusion.odometry.points import NO_FLOOR, PathArrays
from base_station.fusion.smoothing.interface import (
    ON_FLOOR_STD_M,
    PositionConstraint,
    SmoothedPath,
    Smoother,
    Solution,
    Verdict,
)
from base_station.site.floor_grid import FloorGrid
from base_station.site.storeys import floor_at
from shared.clock import NS_PER_S

Floats = NDArray[np.float64]

AHEAD_NS = NS_PER_S // 2  # no wearer gets far meanwhile
SAME_TIME_S = 1.0  # people report times no more exactly
MEETING_MOST_M = 50.0  # a partner with a larger uncertainty constrains nothing


@dataclass(frozen=True)
class PathSolver:
    """Solver of single paths with their pins; caches paths within one change of the evidence."""

    smoother: Smoother
    grid: FloorGrid | None  # the plan's walls
    _alone: dict[str, SmoothedPath] = field(default_factory=dict)

    def solve(
        self, state: StationState, unit_id: str, places: Sequence[PositionConstraint]
    ) -> Solution:
        """Solve one unit's path; the reference unit is part of it, for the common-mode error."""
        evidence = reference_receiver(state, state.site_of(unit_id))
        evidence[unit_id] = evidence_of_one(state, unit_id, places, self.grid)
        solution = self.smoother.solve(evidence)
        verdicts = {place.name: solution.verdicts[place.name] for place in places}
        return Solution({unit_id: solution.paths[unit_id]}, verdicts)

    def alone(self, state: StationState, unit_id: str, history: PathHistory) -> SmoothedPath:
        """A unit's path by all evidence but its meetings; the same at each of them."""
        if unit_id not in self._alone:
            places = own_places(state, unit_id, history)
            self._alone[unit_id] = self.solve(state, unit_id, places).paths[unit_id]
        return self._alone[unit_id]


@dataclass(frozen=True)
class SolvedUnit:
    """Result of one unit."""

    path: SmoothedPath | None  # None: no pin is of use
    trail: list[TrailStep]


def with_partners(state: StationState, unit_ids: Iterable[str]) -> list[str]:
    """These units and those that met them, whose past hangs on theirs; in a fixed order."""
    required = set(unit_ids)
    sites = {state.units[one].site_id for one in required if one in state.units}
    pins = [pin for site_id in sites for pin in state.sites[site_id].pins.values()]
    met = [units_of(pin) for pin in pins if pin.kind == "meeting"]
    for pair in met:
        if pair & set(unit_ids):
            required |= pair
    return sorted(required)


def solve_pins(
    state: StationState, solver: PathSolver, unit_ids: Sequence[str]
) -> dict[str, SolvedUnit]:
    """Solve the past of these units, and judge their pins."""
    results: dict[str, SolvedUnit] = {}
    verdicts: dict[str, dict[str, PinVerdict]] = {}  # by pin, then by unit
    for unit_id in unit_ids:
        history, site = state.paths.get(unit_id), state.site_of(unit_id)
        pins = [pin for pin in site.pins.values() if unit_id in units_of(pin)]
        solution: Solution | None = None
        if history is not None and history.begin_ns is not None:
            places, waiting = _places(state, solver, unit_id, history, pins)
            _await(history, pins)
            if places:
                solution = solver.solve(state, unit_id, places)
        else:
            waiting = {pin.pin_id: "no position of this unit has come yet" for pin in pins}
        for pin_id, why in waiting.items():
            verdicts.setdefault(pin_id, {})[unit_id] = PinVerdict("waiting", text=why)
        results[unit_id] = SolvedUnit(None, [])
        if solution is not None and history is not None:
            for pin_id, verdict in solution.verdicts.items():
                judged = _verdict_of(site, pin_id, unit_id, verdict)
                verdicts.setdefault(pin_id, {})[unit_id] = judged
            if any(verdict.used for verdict in solution.verdicts.values()):
                path = solution.paths[unit_id]
                trail = trail_of(state, unit_id, history.arrays(), path.places_m)
                results[unit_id] = SolvedUnit(path, trail)
    for pin_id, found in verdicts.items():
        _store_verdict(state.site_of(next(iter(found))), pin_id, found)
    return results


def _store_verdict(site: SiteState, pin_id: str, found: Mapping[str, PinVerdict]) -> None:
    """Store the worst verdict of the units that a pin concerns. Of an encounter one unit may not
    have been solved now: its earlier verdict counts.
    """
    of_units = {**dict(site.pin_verdicts.get(pin_id, WAITING).of_units), **found}
    worst = max(of_units.values(), key=lambda one: _SEVERITY[one.state])
    reasons = [one for one in of_units.values() if one.text]
    worst_reasons = dict.fromkeys(one.text for one in reasons if one.state == worst.state)
    text = ". ".join(worst_reasons) or next((one.text for one in reasons), "")
    verdict = msgspec.structs.replace(worst, text=text, of_units=tuple(of_units.items()))
    site.pin_verdicts[pin_id] = verdict


_SEVERITY = {"waiting": 0, "used": 1, "conflict": 2}


def trail_of(
    state: StationState, unit_id: str, points: PathArrays, places_m: Floats
) -> list[TrailStep]:
    """A path (n, 3) as the consoles draw it: thinned evenly, since the incident began."""
    incident = state.incident_of(state.units[unit_id]) if unit_id in state.units else None
    since_ns = 0 if incident is None else incident.opened_ns
    rows = np.flatnonzero(points.t_ns >= since_ns)
    gaps_before = np.cumsum(np.diff(points.t_ns, prepend=points.t_ns[:1]) > TRAIL_GAP_NS)
    if len(rows) > TRAIL_POINTS:
        rows = rows[np.linspace(0, len(rows) - 1, TRAIL_POINTS).round().astype(int)]
    floors = floors_along(state.site_of(unit_id), points, places_m)
    after_gap = np.diff(gaps_before[rows], prepend=gaps_before[rows[:1]]) > 0
    return [
        TrailStep(
            int(points.t_ns[row]),
            float(places_m[row, 0]),
            float(places_m[row, 1]),
            floors[row],
            gap,
        )
        for row, gap in zip(rows, after_gap.tolist(), strict=True)
    ]


def floors_along(site: SiteState, points: PathArrays, places_m: Floats) -> list[int | None]:
    """Floor of each point by its height and the storeys known now; without storeys, the floor as
    estimated live.
    """
    floors: list[int | None] = []
    live_floors = points.floor.tolist()
    for (north_m, east_m, down_m), live_floor in zip(places_m.tolist(), live_floors, strict=True):
        storeys = site.storeys_at(north_m, east_m)
        held = floors[-1] if floors else None
        known = None if live_floor == NO_FLOOR else live_floor
        floors.append(floor_at(storeys, down_m, held) if storeys else known)
    return floors


def renumbered_trail(
    site: SiteState, trail: Sequence[TrailStep], points: PathArrays
) -> list[TrailStep]:
    """A trail as it was drawn, with the floors of the storeys that are known now."""
    again: list[TrailStep] = []
    rows = np.searchsorted(points.t_ns, [step.t_ns for step in trail]).clip(0, len(points) - 1)
    for step, down_m in zip(trail, points.down_m[rows].tolist(), strict=True):
        storeys = site.storeys_at(step.north_m, step.east_m)
        held = again[-1].floor if again else None
        floor = floor_at(storeys, down_m, held) if storeys else step.floor
        again.append(msgspec.structs.replace(step, floor=floor))
    return again


def _places(
    state: StationState,
    solver: PathSolver,
    unit_id: str,
    history: PathHistory,
    pins: Sequence[Pin],
) -> tuple[list[PositionConstraint], dict[str, str]]:
    """Position constraints of a unit's pins, and for other pins the reason for which they wait."""
    places: list[PositionConstraint] = []
    waiting: dict[str, str] = {}
    for pin in pins:
        if pin.kind == "meeting":
            place = _met(state, solver, unit_id, history, pin)
        else:
            place = place_of(state.site_of(unit_id), history, pin)
        if isinstance(place, str):
            waiting[pin.pin_id] = place
        else:
            places.append(place)
    return places, waiting


def _met(
    state: StationState, solver: PathSolver, unit_id: str, history: PathHistory, pin: Pin
) -> PositionConstraint | str:
    """Position constraint of an encounter: the place of the other unit, solved without
    encounters.
    """
    t_ns = time_of(history, pin)
    if isinstance(t_ns, str):
        return f"{unit_id}: {t_ns}"
    other_id = pin.other_id if pin.unit_id == unit_id else pin.unit_id
    other = state.paths.get(other_id)
    if other is None or other.begin_ns is None:
        return f"no position of {other_id} has come yet"
    there_ns = time_of(other, pin)
    if isinstance(there_ns, str):
        return f"{other_id}: {there_ns}"
    path = solver.alone(state, other_id, other)
    row = int(np.searchsorted(path.t_ns, there_ns).clip(0, len(path.t_ns) - 1))
    spread_m = max(float(path.std_north_m[row]), float(path.std_east_m[row]))
    if spread_m > MEETING_MOST_M:
        return f"the position of {other_id} was not known well enough"
    return PositionConstraint(
        name=pin.pin_id,
        t_ns=t_ns,
        north_m=float(path.north_m[row]),
        east_m=float(path.east_m[row]),
        std_m=math.hypot(pin.std_m, spread_m),
        down_m=float(path.down_m[row]),
        down_std_m=math.hypot(ON_FLOOR_STD_M, float(path.std_down_m[row])),
        source=other_id,
    )


def _await(history: PathHistory, pins: Sequence[Pin]) -> None:
    """Note when the path will have come to the first pin ahead of it, whether that waits or counts
    for where the path has come to.
    """
    end_ns = history.end_ns or 0
    times = [pin.t_ns for pin in pins if pin.t_ns > end_ns + AHEAD_NS]
    history.awaited_ns = min(times, default=None)


def _verdict_of(site: SiteState, pin_id: str, unit_id: str, verdict: Verdict) -> PinVerdict:
    """Verdict of a pin for one unit's path, with a text for a person."""
    if verdict.used:
        return PinVerdict("used", verdict.residual_m, verdict.sigmas)
    pin, other = site.pins[pin_id], site.pins.get(verdict.against)
    path, of = "the path walked", ""
    if pin.kind == "meeting":
        path, of = f"the path of {unit_id}", f" for {unit_id}"
    against = f"{path} and the satellite fixes"
    if other is not None:
        against = f"{_describe(other, pin)} and {path}"
    away, end = f"{verdict.residual_m:.0f} m from", f"kept, and not used{of}"
    if verdict.above_m:
        away = f"{verdict.residual_m:.0f} m {'above' if verdict.above_m > 0.0 else 'below'}"
        end += " unless another pin confirms it"
    text = f"{away} where {against} lead: {verdict.sigmas:.0f} times what is to be expected; {end}"
    return PinVerdict("conflict", verdict.residual_m, verdict.sigmas, text)


def _describe(pin: Pin, of: Pin) -> str:
    """A pin that another contradicts, as people know it: by its note, else by when it was; one of
    where the path begins has no time.
    """
    if pin.kind == "meeting":
        name = f"the meeting with {pin.unit_id if pin.unit_id != of.unit_id else pin.other_id}"
    elif pin.other_id:
        name = f"{pin.kind} {pin.other_id}"
    elif pin.note:
        return f"the pin {pin.note!r}"
    elif pin.t_ns == 0:
        return "the pin at the start"
    else:
        name = "the pin"
    if pin.t_ns == 0 or of.t_ns == 0:
        return name
    apart_s = abs(of.t_ns - pin.t_ns) / NS_PER_S
    if apart_s < SAME_TIME_S:
        return f"{name} of the same time"
    return f"{name} of {format_duration(apart_s)} {'before' if pin.t_ns < of.t_ns else 'after'}"
