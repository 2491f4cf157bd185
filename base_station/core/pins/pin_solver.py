"""Solver of units' past paths with their pins.  A meeting pins each of the two at the other's
position, which is solved without that meeting: so no unit's own error comes back as evidence.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import reduce

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
from shared.coded_text import Measure, code_of_text, coded

Floats = NDArray[np.float64]

AHEAD_NS = NS_PER_S // 2  # no wearer gets far meanwhile
_NO_POSITION = coded("pin-no-position", "no position of this unit has come yet")
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
        """Solve a unit's path by all evidence except its meetings, once for all of these."""
        if unit_id not in self._alone:
            places = own_places(state, unit_id, history)
            self._alone[unit_id] = self.solve(state, unit_id, places).paths[unit_id]
        return self._alone[unit_id]


@dataclass(frozen=True)
class SolvedUnit:
    """Result of one unit."""

    path: SmoothedPath | None  # None: no pin can be used
    trail: list[TrailStep]


def with_partners(state: StationState, unit_ids: Iterable[str]) -> list[str]:
    """Return these units and those that met them, in a fixed order: their paths are coupled."""
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
            places, waiting = _pin_constraints(state, solver, unit_id, history, pins)
            _await_next_pin(history, pins)
            if places:
                solution = solver.solve(state, unit_id, places)
        else:
            waiting = {pin.pin_id: _NO_POSITION for pin in pins}
        for pin_id, why in waiting.items():
            verdicts.setdefault(pin_id, {})[unit_id] = PinVerdict.of("waiting", why)
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
    """Store the worst verdict of the units that a pin concerns.  Where only one unit of an
    encounter was solved now, the other's earlier verdict counts.
    """
    of_units = {**dict(site.pin_verdicts.get(pin_id, WAITING).of_units), **found}
    worst = max(of_units.values(), key=lambda one: _SEVERITY[one.state])
    reasons = [one for one in of_units.values() if one.text]
    worst_reasons = dict.fromkeys(one.coded_text for one in reasons if one.state == worst.state)
    text = reduce(_joined_reasons, worst_reasons or [one.coded_text for one in reasons[:1]], "")
    site.pin_verdicts[pin_id] = msgspec.structs.replace(
        worst, text=str(text), text_code=code_of_text(text), of_units=tuple(of_units.items())
    )


def _joined_reasons(before: str, last: str) -> str:
    return coded("pin-reasons", "{before}. {last}", before=before, last=last) if before else last


_SEVERITY = {"waiting": 0, "used": 1, "conflict": 2}


def trail_of(
    state: StationState, unit_id: str, points: PathArrays, places_m: Floats
) -> list[TrailStep]:
    """Return a path (n, 3) as the consoles draw it: evenly thinned, from the beginning of the
    incident.
    """
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
    """Return a trail with the floor numbers of the storeys that are known now."""
    again: list[TrailStep] = []
    rows = np.searchsorted(points.t_ns, [step.t_ns for step in trail]).clip(0, len(points) - 1)
    for step, down_m in zip(trail, points.down_m[rows].tolist(), strict=True):
        storeys = site.storeys_at(step.north_m, step.east_m)
        held = again[-1].floor if again else None
        floor = floor_at(storeys, down_m, held) if storeys else step.floor
        again.append(msgspec.structs.replace(step, floor=floor))
    return again


def _pin_constraints(
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
            place = _encounter_constraint(state, solver, unit_id, history, pin)
        else:
            place = place_of(state.site_of(unit_id), history, pin)
        if isinstance(place, str):
            waiting[pin.pin_id] = place
        else:
            places.append(place)
    return places, waiting


def _encounter_constraint(
    state: StationState, solver: PathSolver, unit_id: str, history: PathHistory, pin: Pin
) -> PositionConstraint | str:
    """Position constraint of an encounter: the place of the other unit, solved without
    encounters.
    """
    t_ns = time_of(history, pin)
    if isinstance(t_ns, str):
        return _of_unit(unit_id, t_ns)
    other_id = pin.other_id if pin.unit_id == unit_id else pin.unit_id
    other = state.paths.get(other_id)
    if other is None or other.begin_ns is None:
        return coded("pin-no-position-of", "no position of {unit} has come yet", unit=other_id)
    there_ns = time_of(other, pin)
    if isinstance(there_ns, str):
        return _of_unit(other_id, there_ns)
    path = solver.alone(state, other_id, other)
    row = int(np.searchsorted(path.t_ns, there_ns).clip(0, len(path.t_ns) - 1))
    spread_m = max(float(path.std_north_m[row]), float(path.std_east_m[row]))
    if spread_m > MEETING_MOST_M:
        return coded(
            "pin-position-poor",
            "the position of {unit} was not known well enough",
            unit=other_id,
        )
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


def _of_unit(unit_id: str, reason: str) -> str:
    return coded("pin-reason-of-unit", "{unit}: {reason}", unit=unit_id, reason=reason)


def _await_next_pin(history: PathHistory, pins: Sequence[Pin]) -> None:
    """Note the time of the first pin after the end of the path; at that time the path is solved
    again.
    """
    end_ns = history.end_ns or 0
    times = [pin.t_ns for pin in pins if pin.t_ns > end_ns + AHEAD_NS]
    history.awaited_ns = min(times, default=None)


def _verdict_of(site: SiteState, pin_id: str, unit_id: str, verdict: Verdict) -> PinVerdict:
    """Verdict of a pin for one unit's path, with a text for a person."""
    if verdict.used:
        return PinVerdict("used", verdict.residual_m, verdict.sigmas)
    text = _conflict_text(site.pins[pin_id], site.pins.get(verdict.against), unit_id, verdict)
    return PinVerdict.of("conflict", text, verdict.residual_m, verdict.sigmas)


def _conflict_text(pin: Pin, other: Pin | None, unit_id: str, verdict: Verdict) -> str:
    """Text of a pin in conflict; ``other``: the pin that it contradicts, None: no single one."""
    is_meeting = pin.kind == "meeting"
    path = (
        coded("pin-path-of", "the path of {unit}", unit=unit_id)
        if is_meeting
        else coded("pin-path-walked", "the path walked")
    )
    against = (
        coded("pin-against-fixes", "{path} and the satellite fixes", path=path)
        if other is None
        else coded("pin-against-pin", "{pin} and {path}", pin=_pin_name(other, pin), path=path)
    )
    away = Measure(verdict.residual_m, f"{verdict.residual_m:.0f} m")
    times = round(verdict.sigmas)
    if verdict.above_m > 0.0:
        return coded(
            "pin-conflict-above",
            "{away_m} above where {against} lead: {times} times what is to be expected; kept, and "
            "not used for {unit} unless another pin confirms it",
            away_m=away,
            against=against,
            times=times,
            unit=unit_id,
        )
    if verdict.above_m:
        return coded(
            "pin-conflict-below",
            "{away_m} below where {against} lead: {times} times what is to be expected; kept, and "
            "not used for {unit} unless another pin confirms it",
            away_m=away,
            against=against,
            times=times,
            unit=unit_id,
        )
    if is_meeting:
        return coded(
            "pin-conflict-meeting",
            "{away_m} from where {against} lead: {times} times what is to be expected; kept, and "
            "not used for {unit}",
            away_m=away,
            against=against,
            times=times,
            unit=unit_id,
        )
    return coded(
        "pin-conflict",
        "{away_m} from where {against} lead: {times} times what is to be expected; kept, and not "
        "used",
        away_m=away,
        against=against,
        times=times,
    )


def _pin_name(pin: Pin, of: Pin) -> str:
    """Name a contradicted pin for a person: by its note, else by its time; a start has no time."""
    if pin.kind == "meeting":
        partner = pin.unit_id if pin.unit_id != of.unit_id else pin.other_id
        name = coded("pin-named-meeting", "the meeting with {unit}", unit=partner)
    elif pin.kind == "beacon":
        name = coded("pin-named-beacon", "beacon {beacon}", beacon=pin.other_id)
    elif pin.kind == "tag":
        name = coded("pin-named-tag", "tag {tag}", tag=pin.other_id)
    elif pin.note:
        return coded("pin-named-note", "the pin '{note}'", note=pin.note)
    elif pin.t_ns == 0:
        return coded("pin-named-start", "the pin at the start")
    else:
        name = coded("pin-named", "the pin")
    if pin.t_ns == 0 or of.t_ns == 0:
        return name
    apart_s = abs(of.t_ns - pin.t_ns) / NS_PER_S
    if apart_s < SAME_TIME_S:
        return coded("pin-same-time", "{pin} of the same time", pin=name)
    apart = Measure(apart_s, format_duration(apart_s))
    if pin.t_ns < of.t_ns:
        return coded("pin-before", "{pin} of {apart_s} before", pin=name, apart_s=apart)
    return coded("pin-after", "{pin} of {apart_s} after", pin=name, apart_s=apart)
