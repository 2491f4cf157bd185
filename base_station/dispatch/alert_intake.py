"""Intake of alerts: puts them on the plan, and takes off those that later alerts replace."""

from __future__ import annotations

from collections.abc import Callable
from threading import Lock

import msgspec

from base_station.dispatch.cap import CapAlert, marker_ids
from shared.messages import ExternalMarker

REMEMBERED = 1000  # alerts that others have replaced

Deliver = Callable[[tuple[ExternalMarker, ...], tuple[str, ...]], None]


class AlertIntake:
    """For requests of any thread."""

    def __init__(self, deliver: Deliver) -> None:
        """``deliver``: takes markers, and the ids of those that are gone."""
        self._deliver = deliver
        self._replaced: dict[str, None] = {}  # oldest first
        self._lock = Lock()

    def take(self, alert: CapAlert) -> CapAlert:
        """Gives the alert with its outcome: one that comes behind its own update or cancellation is
        not shown.
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
