"""Emergencies as TAK has them: one alert for a person while any emergency alarm is open, then its
cancellation.  Both are repeated, as an alert may not have arrived; none is dropped.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field

from base_station.core.alarms.interface import EMERGENCY
from base_station.views.wire import AlarmView
from shared.clock import NS_PER_S

REPEAT_NS = 10 * NS_PER_S
CANCELLED_TIMES = 6  # a minute: longer than a dead connection is taken for a live one
_RESOLVED = "resolved"
_RECENTLY_MS = 600_000  # an earlier run of the program may have raised alerts that ended since


@dataclass(slots=True)
class EmergencyAlert:
    """Alert of one unit's wearer."""

    unit_id: str
    alarms: dict[str, str] = field(default_factory=dict)  # open: rule by alarm id
    due_ns: int = 0  # monotonic
    is_sent: bool = False
    cancellations_left: int = 0

    @property
    def is_open(self) -> bool:
        return bool(self.alarms)

    @property
    def rules(self) -> tuple[str, ...]:
        return tuple(sorted(set(self.alarms.values())))


class Emergencies:
    """Alerts by unit; times are monotonic."""

    def __init__(self) -> None:
        self._alerts: dict[str, EmergencyAlert] = {}
        self._has_picture = False

    def use_picture(self, alarms: Iterable[AlarmView], now_ms: int) -> None:
        """Use the alarms of a new picture, which has every open one."""
        present = {alarm.alarm_id: alarm for alarm in alarms}
        for alert in list(self._alerts.values()):
            for alarm_id in [one for one in alert.alarms if one not in present]:
                self._end(alert, alarm_id)
        for alarm in present.values():
            is_recent = now_ms - alarm.changed_ms < _RECENTLY_MS
            if not self._has_picture and is_recent and _is_emergency(alarm) and _is_over(alarm):
                self._cancel_of_earlier_run(alarm.unit_id)
        for alarm in present.values():
            self.note(alarm)
        self._has_picture = True

    def note(self, alarm: AlarmView) -> None:
        """Use one alarm in its present state."""
        alert = self._alerts.get(alarm.unit_id)
        if _is_over(alarm) or not _is_emergency(alarm):
            if alert is not None and alarm.alarm_id in alert.alarms:
                self._end(alert, alarm.alarm_id)
            return
        if alert is None:
            alert = self._alerts[alarm.unit_id] = EmergencyAlert(alarm.unit_id)
        if alarm.alarm_id not in alert.alarms:
            alert.alarms[alarm.alarm_id] = alarm.rule
            alert.due_ns = alert.cancellations_left = 0

    def _end(self, alert: EmergencyAlert, alarm_id: str) -> None:
        del alert.alarms[alarm_id]
        alert.due_ns = 0
        if alert.is_open:
            return
        if alert.is_sent:
            alert.cancellations_left = CANCELLED_TIMES
        else:  # it was not sent yet
            del self._alerts[alert.unit_id]

    def _cancel_of_earlier_run(self, unit_id: str) -> None:
        self._alerts[unit_id] = EmergencyAlert(
            unit_id, is_sent=True, cancellations_left=CANCELLED_TIMES
        )

    def repeat_all(self) -> None:
        """Make all alerts due at once, because the connection is a new one."""
        for alert in self._alerts.values():
            alert.due_ns = 0

    def due(self, now_ns: int) -> Iterator[EmergencyAlert]:
        """Alerts that are to be sent now."""
        yield from [alert for alert in self._alerts.values() if alert.due_ns <= now_ns]

    def note_sent(self, alert: EmergencyAlert, now_ns: int) -> None:
        alert.due_ns = now_ns + REPEAT_NS
        alert.is_sent = True
        if alert.is_open:
            return
        alert.cancellations_left -= 1
        if alert.cancellations_left <= 0:
            del self._alerts[alert.unit_id]

    @property
    def open_units(self) -> tuple[str, ...]:
        return tuple(alert.unit_id for alert in self._alerts.values() if alert.is_open)

    @property
    def next_due_ns(self) -> int | None:
        return min((alert.due_ns for alert in self._alerts.values()), default=None)


def _is_emergency(alarm: AlarmView) -> bool:
    return alarm.priority == EMERGENCY and bool(alarm.unit_id)


def _is_over(alarm: AlarmView) -> bool:
    return alarm.state == _RESOLVED
