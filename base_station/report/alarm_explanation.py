"""Explanation of one alarm, live or past: values of its unit from a minute before until a minute
after it was raised, and the threshold that one of them crossed.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Collection, Iterable, Mapping
from dataclasses import dataclass

import msgspec

from base_station.core.alarms import ALARMS
from base_station.core.alarms.thresholds import limits_of, with_thresholds
from base_station.report.contents import Interval, Series
from base_station.report.log_facts import UnitFacts, read_facts, wanted_keys
from base_station.report.thresholds_in_force import thresholds_in_force
from base_station.storage.db.models import AlarmRow
from base_station.storage.db.records import Records
from base_station.storage.db.window import Window
from shared.clock import NS_PER_S
from shared.mcap_log import LogRecord
from shared.messages import EventKind

ABOUT_NS = 60 * NS_PER_S  # before and after
_BUTTONS = frozenset({EventKind.MAYDAY, EventKind.MAYDAY_CANCELLED, EventKind.ACKNOWLEDGED})

# By rule: the series that it judges, and the threshold of each level.
_JUDGED: Mapping[str, tuple[str, Mapping[str, str]]] = {
    "no-motion": ("motionless_s", {"pre-alert": "pre_alert_s", "alarm": "alarm_s"}),
    "heat": (
        "temperature_degc",
        {"caution": "caution_degc", "warning": "warning_degc", "critical": "critical_degc"},
    ),
    "battery": ("battery", {"low": "low"}),
}

ReadLog = Callable[[int, int, Collection[str]], Iterable[LogRecord]]  # from, until before, keys


class Crossing(msgspec.Struct, frozen=True):
    """First value beyond a threshold at the time of the alarm."""

    series: str
    threshold: str
    limit: float
    t_ns: int
    value: float


class AlarmExplanation(msgspec.Struct, frozen=True):
    """Series of values about an alarm, in station time; a series without values is not known."""

    motionless_s: Series
    temperature_degc: Series
    battery: Series  # 0..1
    height_m: Series  # above the origin of the incident frame
    stated_error_m: Series  # one standard deviation, horizontal
    received_ns: tuple[int, ...]  # messages that came live
    buttons_ns: tuple[int, ...]  # presses, and events that a button causes
    thresholds: tuple[tuple[str, float], ...]  # of the rule, at that time
    crossing: Crossing | None  # None: the rule judges no such series


@dataclass(frozen=True)
class AlarmExplainer:
    """Maker of explanations, which writes nothing.  Thread-safe."""

    records: Records
    read_log: ReadLog

    def explain(self, alarm: AlarmRow) -> AlarmExplanation:
        """Explain an alarm.  Raises LogError if the log cannot be opened."""
        about = Interval(alarm.raised_ns - ABOUT_NS, alarm.raised_ns + ABOUT_NS)
        unit_id = alarm.unit_id
        logged = self.read_log(about.from_ns, about.until_ns + 1, wanted_keys([unit_id]))
        around = {unit_id: [about]}
        facts = read_facts(logged, about, around, around, lambda _: None).units[unit_id]
        points = self.records.track(unit_id, Window(about.from_ns, about.until_ns + 1))
        thresholds = self._thresholds(alarm)
        return AlarmExplanation(
            motionless_s=tuple(facts.motionless_s),
            temperature_degc=tuple(facts.temperature_degc),
            battery=tuple(facts.battery),
            height_m=tuple((one.t_ns, -one.down_m) for one in points),
            stated_error_m=tuple(
                (one.t_ns, math.hypot(one.std_north_m, one.std_east_m)) for one in points
            ),
            received_ns=tuple(facts.received_ns),
            buttons_ns=tuple(t_ns for t_ns, kind in facts.events if kind in _BUTTONS),
            thresholds=thresholds,
            crossing=_crossing(alarm, facts, dict(thresholds)),
        )

    def _thresholds(self, alarm: AlarmRow) -> tuple[tuple[str, float], ...]:
        """Thresholds that were in force when the alarm was raised."""
        in_force = thresholds_in_force(self.records, alarm.raised_ns + 1)
        rule = next((one for one in ALARMS if one.name == alarm.rule), None)
        if rule is None:
            return ()
        (changed,) = with_thresholds([rule], in_force)
        return tuple((name, float(getattr(changed, name))) for name in limits_of(changed))


def _crossing(
    alarm: AlarmRow, facts: UnitFacts, thresholds: Mapping[str, float]
) -> Crossing | None:
    """Crossing of the worst threshold that the last value before the alarm reached."""
    series_name, by_level = _JUDGED.get(alarm.rule, ("", {}))
    if not series_name:
        return None
    series: list[tuple[int, float]] = getattr(facts, series_name)
    sign = -1.0 if series_name == "battery" else 1.0
    before = [value for t_ns, value in series if t_ns <= alarm.raised_ns]
    reached = [
        name
        for name in by_level.values()
        if before and name in thresholds and sign * before[-1] >= sign * thresholds[name]
    ]
    if not reached:
        return None
    name = reached[-1]
    limit, found = thresholds[name], None
    for t_ns, value in reversed(series):
        if t_ns > alarm.raised_ns:
            continue
        if sign * value < sign * limit:
            break
        found = Crossing(series_name, name, limit, t_ns, value)
    return found
