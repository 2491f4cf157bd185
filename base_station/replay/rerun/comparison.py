"""Comparison of a re-run with the live result: trails, floors and alarms, as data for JSON."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from enum import StrEnum

import msgspec
import numpy as np

from base_station.storage.db.records import TrackSample
from shared.clock import NS_PER_MS, NS_PER_S

_SAME_ALARM_NS = 120 * NS_PER_S  # further apart, two alarms are about two matters


class TrailDifference(msgspec.Struct, frozen=True):
    """Distances between both trails at the same seconds, in metres; None: no common second."""

    unit_id: str
    tracker: str  # of the re-run; empty: the unit was not tracked again
    positions: int  # that the unit sent
    retracked: int  # of those, out of a recording
    seconds: int  # that both trails have
    median_m: float | None = None
    p95_m: float | None = None
    max_m: float | None = None
    end_m: float | None = None
    vertical_p95_m: float | None = None
    other_floor_s: int = 0
    floor_changes: tuple[FloorChange, ...] = ()


class FloorChange(msgspec.Struct, frozen=True):
    """A time for which the re-run has another floor; ms since 1970, UTC; None: not known."""

    from_ms: int
    until_ms: int
    shown: int | None
    rerun: int | None


class AlarmOutcome(StrEnum):
    SAME = "same"
    EARLIER = "earlier"
    LATER = "later"
    MISSED = "missed"  # raised at the time alone
    ADDED = "added"  # raised by the re-run alone


class RaisedAlarm(msgspec.Struct, frozen=True):
    rule: str
    unit_id: str
    raised_ns: int


class AlarmDifference(msgspec.Struct, frozen=True):
    """One alarm; ms since 1970, UTC; None: it was not raised."""

    rule: str
    unit_id: str
    outcome: AlarmOutcome
    shown_ms: int | None
    rerun_ms: int | None


class RerunReport(msgspec.Struct, frozen=True):
    incident_id: str
    tracker: str  # as asked for; empty: that of each unit
    calibration: str  # name of the file; empty: that of each unit
    settings: tuple[str, ...]
    version: str
    trails: tuple[TrailDifference, ...]
    alarms: tuple[AlarmDifference, ...]
    notes: tuple[str, ...]  # parts that could not be compared, and flaws of the record


def compare_trail(
    unit_id: str,
    tracker: str,
    counts: tuple[int, int],
    shown: Sequence[TrackSample],
    rerun: Sequence[TrackSample],
) -> TrailDifference:
    """``counts``: positions that the unit sent, and those of them out of a recording."""
    by_second = {one.t_ns // NS_PER_S: one for one in shown}
    pairs = [
        (then, now) for now in rerun if (then := by_second.get(now.t_ns // NS_PER_S)) is not None
    ]
    if not pairs:
        return TrailDifference(unit_id, tracker, *counts, seconds=0)
    off_m = np.array(
        [
            (now.north_m - then.north_m, now.east_m - then.east_m, now.down_m - then.down_m)
            for then, now in pairs
        ]
    )
    level_m = np.hypot(off_m[:, 0], off_m[:, 1])
    changes = tuple(_floor_changes(pairs))
    return TrailDifference(
        unit_id,
        tracker,
        *counts,
        seconds=len(pairs),
        median_m=float(np.median(level_m)),
        p95_m=float(np.percentile(level_m, 95)),
        max_m=float(level_m.max()),
        end_m=float(level_m[-1]),
        vertical_p95_m=float(np.percentile(np.abs(off_m[:, 2]), 95)),
        other_floor_s=sum(then.floor != now.floor for then, now in pairs),
        floor_changes=changes,
    )


def compare_alarms(
    shown: Iterable[RaisedAlarm], rerun: Iterable[RaisedAlarm]
) -> tuple[AlarmDifference, ...]:
    """Pair alarms of one rule and unit that were raised within two minutes, the nearest first."""
    left = list(rerun)
    found = []
    for then in sorted(shown, key=lambda one: one.raised_ns):
        same = [
            one
            for one in left
            if (one.rule, one.unit_id) == (then.rule, then.unit_id)
            and abs(one.raised_ns - then.raised_ns) <= _SAME_ALARM_NS
        ]
        now = min(same, key=lambda one: abs(one.raised_ns - then.raised_ns), default=None)
        if now is not None:
            left.remove(now)
        found.append(_alarm_difference(then, now))
    found += [_alarm_difference(None, one) for one in left]
    return tuple(sorted(found, key=lambda one: one.shown_ms or one.rerun_ms or 0))


def _alarm_difference(then: RaisedAlarm | None, now: RaisedAlarm | None) -> AlarmDifference:
    either = then or now
    assert either is not None
    outcome = AlarmOutcome.SAME
    if now is None:
        outcome = AlarmOutcome.MISSED
    elif then is None:
        outcome = AlarmOutcome.ADDED
    elif now.raised_ns != then.raised_ns:
        is_earlier = now.raised_ns < then.raised_ns
        outcome = AlarmOutcome.EARLIER if is_earlier else AlarmOutcome.LATER
    return AlarmDifference(either.rule, either.unit_id, outcome, _raised_ms(then), _raised_ms(now))


def _raised_ms(alarm: RaisedAlarm | None) -> int | None:
    return None if alarm is None else alarm.raised_ns // NS_PER_MS


def _floor_changes(pairs: Iterable[tuple[TrackSample, TrackSample]]) -> Iterable[FloorChange]:
    """Runs of seconds with the same two floors that differ."""
    change: FloorChange | None = None
    for then, now in pairs:
        t_ms = now.t_ns // NS_PER_MS
        if change is not None and (change.shown, change.rerun) == (then.floor, now.floor):
            change = msgspec.structs.replace(change, until_ms=t_ms)
            continue
        if change is not None:
            yield change
        change = None
        if then.floor != now.floor:
            change = FloorChange(t_ms, t_ms, then.floor, now.floor)
    if change is not None:
        yield change
