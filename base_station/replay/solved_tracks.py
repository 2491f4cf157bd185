"""Tracks that follow from a solved incident, by unit: the smoothed one, and the unit's own path."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from base_station.core.pins.pin_registry import units_of
from base_station.core.pins.pin_solver import floors_along
from base_station.core.state import StationState
from base_station.fusion.lazy_mapping import LastValueMapping
from base_station.fusion.odometry.points import NO_FLOOR, RESTART, PathArrays
from base_station.fusion.smoothing.interface import SmoothedPath, Solution
from base_station.storage.db.models import IncidentRow
from base_station.storage.db.records import TrackSample
from shared.quality import Quality

Tracks = Mapping[str, Sequence[TrackSample]]
OPEN_END_NS = 2**63 - 1  # end of an open incident: all later records belong to it
UNSURE_M = 5.0  # a smoothed place known no better than this is called degraded


@dataclass(frozen=True)
class SolvedIncident:
    """Everything at an incident's end, and the trails that follow from it."""

    state: StationState
    solution: Solution
    is_outdated: Callable[[], bool]  # a person was forgotten since


def smoothed_tracks(incident: IncidentRow, known: SolvedIncident) -> Tracks:
    return LastValueMapping(
        _within(incident, known), lambda unit_id: _samples(incident, known, unit_id)
    )


def raw_tracks(incident: IncidentRow, known: SolvedIncident) -> Tracks:
    return LastValueMapping(
        _within(incident, known), lambda unit_id: _raw(incident, known, unit_id)
    )


def _within(incident: IncidentRow, known: SolvedIncident) -> list[str]:
    """Units that were in it at its end and of which anything is known while it was open."""
    units, paths = known.state.units, known.solution.paths.items()
    return [
        unit_id
        for unit_id, path in paths
        if units[unit_id].incident_id == incident.incident_id and _rows_within(incident, path)
    ]


def _samples(incident: IncidentRow, known: SolvedIncident, unit_id: str) -> list[TrackSample]:
    """With the floors that were known at the end; they may have been learnt late."""
    path = known.solution.paths[unit_id]
    points = known.state.paths[unit_id].arrays()
    is_placed = _is_placed(known, unit_id, points)
    floors = floors_along(known.state.site_of(unit_id), points, path.places_m)
    heading_rad = (path.turn_rad + points.heading_rad) % (2.0 * np.pi)
    return [
        TrackSample(
            t_ns=int(path.t_ns[row]),
            north_m=float(path.north_m[row]),
            east_m=float(path.east_m[row]),
            down_m=float(path.down_m[row]),
            std_north_m=float(path.std_north_m[row]),
            std_east_m=float(path.std_east_m[row]),
            std_down_m=float(path.std_down_m[row]),
            heading_rad=float(heading_rad[row]),
            floor=floors[row],
            quality=_quality(path, row, is_placed=is_placed),
        )
        for row in _rows_within(incident, path)
    ]


def _is_placed(known: SolvedIncident, unit_id: str, points: PathArrays) -> bool:
    """True if anything ties its path to the incident frame; else it lies about its own start."""
    verdicts, state = known.solution.verdicts, known.state
    pins = (
        pin_id for pin_id, pin in state.site_of(unit_id).pins.items() if unit_id in units_of(pin)
    )
    is_pinned = any(pin_id in verdicts and verdicts[pin_id].used for pin_id in pins)
    has_start = state.paths[unit_id].start.in_path is not None
    return has_start or is_pinned or len(points.fix_t_ns) > 0


def _raw(incident: IncidentRow, known: SolvedIncident, unit_id: str) -> list[TrackSample]:
    path, points = known.solution.paths[unit_id], known.state.paths[unit_id].arrays()
    begins = np.flatnonzero((points.flags & RESTART) != 0)
    begins = np.concatenate(([0], begins[begins > 0]))
    begin = begins[np.searchsorted(begins, np.arange(len(points)), side="right") - 1]
    since = points.own_m - points.own_m[begin]
    cosine, sine = np.cos(path.turn_rad[begin]), np.sin(path.turn_rad[begin])
    north_m = path.north_m[begin] + cosine * since[:, 0] - sine * since[:, 1]
    east_m = path.east_m[begin] + sine * since[:, 0] + cosine * since[:, 1]
    heading_rad = (path.turn_rad[begin] + points.heading_rad) % (2.0 * np.pi)
    return [
        TrackSample(
            t_ns=int(points.t_ns[row]),
            north_m=float(north_m[row]),
            east_m=float(east_m[row]),
            down_m=float(points.down_m[row]),
            std_north_m=float(points.std_m[row]),
            std_east_m=float(points.std_m[row]),
            std_down_m=float(points.down_std_m[row]),
            heading_rad=float(heading_rad[row]),
            floor=_floor(points, row),
            quality=Quality.GOOD.name.lower(),
        )
        for row in _rows_within(incident, path)
    ]


def _rows_within(incident: IncidentRow, path: SmoothedPath) -> list[int]:
    until_ns = incident.closed_ns or OPEN_END_NS
    rows: list[int] = np.flatnonzero(
        (path.t_ns >= incident.opened_ns) & (path.t_ns <= until_ns)
    ).tolist()
    return rows


def _floor(points: PathArrays, row: int) -> int | None:
    floor = int(points.floor[row])
    return None if floor == NO_FLOOR else floor


def _quality(path: SmoothedPath, row: int, *, is_placed: bool) -> str:
    spread_m = np.hypot(path.std_north_m[row], path.std_east_m[row])
    is_good = is_placed and spread_m <= UNSURE_M
    return (Quality.GOOD if is_good else Quality.DEGRADED).name.lower()
