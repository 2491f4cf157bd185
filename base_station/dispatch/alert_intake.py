"""Intake of alerts: adds them to the plan, and removes those that later alerts replace."""

from __future__ import annotations

from collections.abc import Callable
from threading import Lock

import msgspec

from base_station.dispatch.cap import CapAlert, marker_ids
from shared.messages import ExternalMarker

REMEMBERED = 1000  # alerts that others have replaced

Deliver = Callable[[tuple[ExternalMarker, ...], tuple[str, ...]], None]


class AlertIntake:
    """Intake.  Thread-safe."""

    def __init__(self, deliver: Deliver) -> None:
        """``deliver`` receives markers, and the ids of removed ones."""
        self._deliver = deliver
        self._replaced: dict[str, None] = {}  # oldest first
        self._lock = Lock()

    def take(self, alert: CapAlert) -> CapAlert:
        """Read an alert, and return it with its outcome.  One that comes after its own update or
        cancellation is not shown.
        """
        with self._lock:
            if alert.alert_id in self._replaced:
                alert = msgspec.structs.replace(alert, outcome="replaced", markers=())
            for one in alert.replaced:
                self._replaced.pop(one, None)
                self._replaced[one] = None
            while len(self._replaced) > REMEMBERED:
                del self._replaced[next(iter(self._replaced))]
            shown = {marker.marker_id for marker in alert.markers}
            # An alert that comes again may have fewer areas than before.
            gone = [
                marker_id
                for one in (alert.alert_id, *alert.replaced)
                for marker_id in marker_ids(one)
                if marker_id not in shown
            ]
            self._deliver(alert.markers, tuple(gone))
        return alert
