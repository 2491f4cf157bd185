"""Report on an incident's positions: the accuracy stated at the time beside later knowledge."""

from __future__ import annotations

import math
from bisect import bisect_left
from collections.abc import Mapping, Sequence
from itertools import pairwise

import msgspec
import numpy as np

from base_station.core.pins.evidence import location_of
from base_station.core.state import SiteState, StationState
from base_station.core.state.trust_tally import TrustTally
from base_station.fusion.smoothing.interface import Verdict
from base_station.replay.assessment.figures import (
    Figures,
    errors_against,
    figures_of,
    floor_probability,
    stated_figures,
    stated_m,
)
from base_station.storage.db.records import TrackSample
from base_station.views.answer import Answer
from base_station.views.wire import TextCodeView
from shared.clock import NS_PER_S

AWAY_M = 15.0  # a wearer who was so far from the beginning
BACK_M = 3.0  # and came so near to it again has closed a loop
GAP_NS = 60 * NS_PER_S  # without a fix, after which the next one is a re-entry
NEAR_NS = 5 * NS_PER_S  # half of the time between two points of a trail, at most
SETTLING_NS = 20 * NS_PER_S  # about a re-entry

Tracks = Mapping[str, Sequence[TrackSample]]


class PinResidual(Answer, frozen=True):
    """Distance of a pin from the position shown at its time, and from the smoothed trail."""

    pin_id: str
    note: str
    used: bool
    shown_m: float | None
    trail_m: float
    sigmas: float
    floor_right: bool | None  # was the floor shown the pin's?  None: one of them is not known


class TrustReport(Answer, frozen=True):
    """For how long the light was which, in seconds, and why it was not green."""

    green_s: float
    amber_s: float
    red_s: float
    causes: tuple[tuple[str, float], ...]  # longest first


class UnitReport(Answer, frozen=True):
    unit_id: str
    seconds: float
    walked_m: float
    stated: Figures | None  # by the stated standard deviations
    against_smoothed: Figures | None  # shown positions compared with the smoothed trail
    floor_probability: float | None  # by the stated standard deviations of height
    floor_right: float | None  # fraction of the time, by later knowledge
    trust: TrustReport
    pin_residuals: tuple[PinResidual, ...]
    loop_closure_m: float | None  # by the unit's own path alone
    loop_closure_percent: float | None  # of the way walked until then
    reentry_jumps_m: tuple[float, ...]  # of the shown positions, when fixes came back
    not_used: tuple[tuple[str, int], ...] = ()  # fixes and sightings; by reason, most first
    people: tuple[str, ...] = ()  # its wearers; not kept, so that people can be forgotten


class IncidentReport(Answer, frozen=True):
    incident_id: str
    smoother: str
    made_ms: int
    units: tuple[UnitReport, ...]
    stated: Figures | None  # over all units
    against_smoothed: Figures | None
    flaws: tuple[str, ...] = ()  # of the log that it was made of
    flaw_codes: tuple[TextCodeView, ...] = ()  # of ``flaws``, in their order
    is_newest: bool = True  # False: more of it is coming out of a journal; not kept


def assess(
    incident_id: str,
    smoother: str,
    made_ms: int,
    state: StationState,
    verdicts: Mapping[str, Verdict],
    live: Tracks,
    smoothed: Tracks,
    raw: Tracks,
) -> IncidentReport:
    """``state`` is that of the incident's end; ``live``: shown positions."""
    units, stated, errors = [], [], []
    for unit_id in sorted(live):  # one by one: all tracks together are large
        shown, known, own = live[unit_id], smoothed.get(unit_id, ()), raw.get(unit_id, ())
        units.append(_unit(state, verdicts, unit_id, shown, known, own))
        stated.append(stated_m(shown))
        errors.append(errors_against(shown, known))
    return IncidentReport(
        incident_id=incident_id,
        smoother=smoother,
        made_ms=made_ms,
        units=tuple(units),
        stated=stated_figures(np.concatenate(stated)) if stated else None,
        against_smoothed=figures_of(np.concatenate(errors)) if errors else None,
    )


def _unit(
    state: StationState,
    verdicts: Mapping[str, Verdict],
    unit_id: str,
    live: Sequence[TrackSample],
    smoothed: Sequence[TrackSample],
    raw: Sequence[TrackSample],
) -> UnitReport:
    closure = _loop_closure(smoothed, raw)
    return UnitReport(
        unit_id=unit_id,
        seconds=(live[-1].t_ns - live[0].t_ns) / NS_PER_S if live else 0.0,
        walked_m=round(_length_m(raw), 1),
        stated=stated_figures(stated_m(live)),
        against_smoothed=figures_of(errors_against(live, smoothed)),
        floor_probability=_floor_probability(state.site_of(unit_id), live),
        floor_right=_floor_accuracy(live, smoothed),
        trust=_trust(state, unit_id),
        pin_residuals=_pin_residuals(state, verdicts, unit_id, live),
        loop_closure_m=None if closure is None else round(closure[0], 2),
        loop_closure_percent=None if closure is None else round(closure[1], 2),
        reentry_jumps_m=_reentry_jumps(state, unit_id, live, smoothed),
        not_used=_not_used(state, unit_id),
    )


def _floor_probability(site: SiteState, live: Sequence[TrackSample]) -> float | None:
    if not live:
        return None
    middle = live[len(live) // 2]
    downs = sorted(storey.down_m for storey in site.storeys_at(middle.north_m, middle.east_m))
    heights = [b - a for a, b in pairwise(downs)]
    return floor_probability(live, min(heights)) if heights and min(heights) > 0.0 else None


def _floor_accuracy(live: Sequence[TrackSample], smoothed: Sequence[TrackSample]) -> float | None:
    """Fraction of samples whose shown floor is the one of the smoothed trail; None: no floors."""
    with_floor = [one for one in live if one.floor is not None]
    right = []
    for one in with_floor:
        since = _at(smoothed, one.t_ns)
        if since is not None and since.floor is not None:
            right.append(since.floor == one.floor)
    return round(sum(right) / len(right), 4) if right else None


def _trust(state: StationState, unit_id: str) -> TrustReport:
    unit = state.units.get(unit_id)
    tally = TrustTally() if unit is None else unit.trust
    causes = sorted(tally.causes.items(), key=lambda one: (-one[1], one[0]))
    return TrustReport(
        round(tally.green_s, 1),
        round(tally.amber_s, 1),
        round(tally.red_s, 1),
        tuple((cause, round(lasted_s, 1)) for cause, lasted_s in causes),
    )


def _not_used(state: StationState, unit_id: str) -> tuple[tuple[str, int], ...]:
    unit = state.units.get(unit_id)
    counts = {} if unit is None else unit.rejected_counts
    return tuple(sorted(counts.items(), key=lambda one: (-one[1], one[0])))


def with_people(report: IncidentReport, people: Mapping[str, Sequence[str]]) -> IncidentReport:
    """``people``: wearers of each unit."""
    units = tuple(
        msgspec.structs.replace(unit, people=tuple(people.get(unit.unit_id, ())))
        for unit in report.units
    )
    return msgspec.structs.replace(report, units=units)


def _pin_residuals(
    state: StationState,
    verdicts: Mapping[str, Verdict],
    unit_id: str,
    live: Sequence[TrackSample],
) -> tuple[PinResidual, ...]:
    found = []
    site = state.site_of(unit_id)
    for pin in site.pins.values():
        verdict = verdicts.get(pin.pin_id)
        if pin.unit_id != unit_id or verdict is None:
            continue
        place = location_of(site, pin)
        shown = _at(live, pin.t_ns)
        shown_m = None
        if shown is not None and place.north_m is not None and place.east_m is not None:
            apart_m = math.hypot(shown.north_m - place.north_m, shown.east_m - place.east_m)
            shown_m = round(apart_m, 2)
        floor_right = None
        if shown is not None and shown.floor is not None and place.floor is not None:
            floor_right = shown.floor == place.floor
        found.append(
            PinResidual(
                pin.pin_id,
                pin.note,
                verdict.used,
                shown_m,
                round(verdict.residual_m, 2),
                round(verdict.sigmas, 2),
                floor_right,
            )
        )
    return tuple(found)


def _loop_closure(
    smoothed: Sequence[TrackSample], raw: Sequence[TrackSample]
) -> tuple[float, float] | None:
    """By how much the own path misses, where the wearer was last near the beginning again."""
    if not smoothed or len(raw) != len(smoothed):
        return None
    first = smoothed[0]
    apart_m = [
        math.hypot(one.north_m - first.north_m, one.east_m - first.east_m) for one in smoothed
    ]
    away = next((row for row, one in enumerate(apart_m) if one > AWAY_M), None)
    back = [row for row, one in enumerate(apart_m) if one < BACK_M]
    if away is None or not back or back[-1] < away:
        return None
    row = back[-1]
    own = raw[row].north_m - raw[0].north_m, raw[row].east_m - raw[0].east_m
    true = smoothed[row].north_m - first.north_m, smoothed[row].east_m - first.east_m
    missed_m = math.dist(own, true)
    return missed_m, 100.0 * missed_m / max(_length_m(raw[: row + 1]), 1.0)


def _reentry_jumps(
    state: StationState,
    unit_id: str,
    live: Sequence[TrackSample],
    smoothed: Sequence[TrackSample],
) -> tuple[float, ...]:
    """The furthest that the place shown moved against the smoothed trail from one second to the
    next, each time when fixes came back.
    """
    history = state.paths.get(unit_id)
    if history is None or history.begin_ns is None or not live or not smoothed:
        return ()
    fixes = history.arrays().fix_t_ns
    jumps = []
    for row in np.flatnonzero(np.diff(fixes) > GAP_NS):
        t_ns = int(fixes[row + 1])
        near = [one for one in live if abs(one.t_ns - t_ns) <= SETTLING_NS]
        errors = errors_against(near, smoothed)[:, :2]
        if len(errors) > 1:
            moved = np.linalg.norm(np.diff(errors, axis=0), axis=1)
            jumps.append(round(float(moved.max()), 2))
    return tuple(jumps)


def _at(samples: Sequence[TrackSample], t_ns: int) -> TrackSample | None:
    """Sample nearest to a time, within a few seconds; of time 0 the first."""
    row = bisect_left(samples, t_ns, key=lambda one: one.t_ns)
    near = samples[max(row - 1, 0) : row + 1]
    nearest = min(near, key=lambda one: abs(one.t_ns - t_ns), default=None)
    if nearest is None or (t_ns != 0 and abs(nearest.t_ns - t_ns) > NEAR_NS):
        return None
    return nearest


def _length_m(samples: Sequence[TrackSample]) -> float:
    places = np.array([(one.north_m, one.east_m) for one in samples]).reshape(-1, 2)
    return float(np.linalg.norm(np.diff(places, axis=0), axis=1).sum()) if len(places) > 1 else 0.0
