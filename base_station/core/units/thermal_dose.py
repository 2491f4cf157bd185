"""Thermal dose of a unit, from the intervals in which its temperature is known.

The radio loses readings, and a backfill brings them later, in pieces.  The dose that was assumed
for a gap is then replaced by that of the readings, in whatever order they come.

The number of intervals is bounded.  Beyond that the shortest gap counts as known: the dose that was
assumed for it stays, and late readings in it change nothing.

Classes after NIST Technical Note 1474 (Donnelly et al.): I to 100 degC for 25 min, II to 160 degC
for 15 min, III to 260 degC for 5 min, IV above for less than 1 min.  Below 60 degC (ours) nothing
counts.  The dose is no measure of the wearer's own condition.
"""

from __future__ import annotations

from itertools import pairwise

from base_station.core.state.unit_heat import ExposureInterval
from shared.clock import NS_PER_S

CAUTION_DEGC = 100.0
WARNING_DEGC = 160.0
CRITICAL_DEGC = 260.0

# (above this temperature, time in which the whole dose is used up), hottest first
BANDS_DEGC_S = (
    (CRITICAL_DEGC, 60.0),
    (WARNING_DEGC, 300.0),
    (CAUTION_DEGC, 900.0),
    (60.0, 1500.0),
)
LONGEST_STEP_S = 10.0  # without readings, for which the last temperature counts on
JOINED_NS = 3 * NS_PER_S // 2  # nothing is missing between readings so near, one a second
MAX_INTERVALS = 500  # stretches


def add_live(intervals: list[ExposureInterval], boot_id: int, t_ns: int, degc: float) -> float:
    """Add a live reading; returns the increment of the dose."""
    new = ExposureInterval(boot_id, t_ns, degc, t_ns, degc)
    last = intervals[-1] if intervals else None
    if last is None or last.boot_id != boot_id or t_ns < last.last_ns:  # its clock may be set back
        _append_interval(intervals, new)
        return 0.0
    added = _dose_between(last, new)
    if t_ns - last.last_ns <= JOINED_NS:
        last.last_ns, last.last_degc = t_ns, degc
    else:
        _append_interval(intervals, new)
    return added


def add_late(intervals: list[ExposureInterval], boot_id: int, t_ns: int, degc: float) -> float:
    """Add a late reading; gives the change of the dose."""
    if any(one.boot_id == boot_id and one.first_ns <= t_ns <= one.last_ns for one in intervals):
        return 0.0
    new = ExposureInterval(boot_id, t_ns, degc, t_ns, degc)
    row = _insertion_row(intervals, new)
    before = _of_run(intervals, row - 1, boot_id)
    after = _of_run(intervals, row, boot_id)
    added = _dose_between(before, new) + _dose_between(new, after) - _dose_between(before, after)
    intervals.insert(row, new)
    _join_with_previous(intervals, row + 1)
    _join_with_previous(intervals, row)
    _limit_count(intervals)
    return added


def restart_intervals(intervals: list[ExposureInterval]) -> None:
    """Restart the dose with the next reading."""
    del intervals[:-1]
    for last in intervals:
        last.first_ns, last.first_degc = last.last_ns, last.last_degc


def _insertion_row(intervals: list[ExposureInterval], new: ExposureInterval) -> int:
    """Row for a new interval: before the later ones of its run, else behind all of that run."""
    rows = [row for row, one in enumerate(intervals) if one.boot_id == new.boot_id]
    later = (row for row in rows if intervals[row].first_ns > new.last_ns)
    return next(later, rows[-1] + 1 if rows else 0)


def _of_run(intervals: list[ExposureInterval], row: int, boot_id: int) -> ExposureInterval | None:
    is_there = 0 <= row < len(intervals) and intervals[row].boot_id == boot_id
    return intervals[row] if is_there else None


def _dose_between(before: ExposureInterval | None, after: ExposureInterval | None) -> float:
    """Dose of a gap, by the cooler of the temperatures at its ends beyond the first seconds."""
    if before is None or after is None:
        return 0.0
    elapsed_s = max(after.first_ns - before.last_ns, 0) / NS_PER_S
    known_s = min(elapsed_s, LONGEST_STEP_S)
    cooler_degc = min(before.last_degc, after.first_degc)
    return dose_of(before.last_degc, known_s) + dose_of(cooler_degc, elapsed_s - known_s)


def _join_with_previous(intervals: list[ExposureInterval], row: int) -> None:
    """Join an interval with the one before, where no reading is missing between them."""
    if not 0 < row < len(intervals):
        return
    silent_ns = _silence_ns(intervals[row - 1], intervals[row])
    if silent_ns is not None and silent_ns <= JOINED_NS:
        _merge_with_previous(intervals, row)


def _append_interval(intervals: list[ExposureInterval], new: ExposureInterval) -> None:
    intervals.append(new)
    _limit_count(intervals)


def _limit_count(intervals: list[ExposureInterval]) -> None:
    """Bound the number of intervals; of runs without a silence between any two the oldest goes."""
    if len(intervals) <= MAX_INTERVALS:
        return
    silences = ((_silence_ns(*both), row) for row, both in enumerate(pairwise(intervals), start=1))
    known = [(silent_ns, row) for silent_ns, row in silences if silent_ns is not None]
    if known:
        _merge_with_previous(intervals, min(known)[1])
    else:
        del intervals[0]


def _silence_ns(before: ExposureInterval, after: ExposureInterval) -> int | None:
    """Length of a gap; None across two boots, or where the unit's clock was set back."""
    if before.boot_id != after.boot_id or after.first_ns < before.last_ns:
        return None
    return after.first_ns - before.last_ns


def _merge_with_previous(intervals: list[ExposureInterval], row: int) -> None:
    """Merge an interval with the one before; later readings between them are ignored."""
    before, after = intervals[row - 1], intervals[row]
    before.last_ns, before.last_degc = after.last_ns, after.last_degc
    del intervals[row]


def dose_of(temperature_degc: float, duration_s: float) -> float:
    """Part of the thermal dose limit that this time at this temperature uses up."""
    for above_degc, limit_s in BANDS_DEGC_S:
        if temperature_degc > above_degc:
            return duration_s / limit_s
    return 0.0
