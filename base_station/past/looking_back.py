"""Looks back on what closed lately, beside all else that a station does: of a long incident it
takes minutes.
"""

from __future__ import annotations

import logging
from collections.abc import Callable, Iterable
from threading import Event, Thread

from base_station.db.models import Incident
from base_station.past.hindsight import Hindsight, Tracks
from base_station.program.recurring_trouble import RecurringTrouble

EVERY_S = 5.0
GRACE_S = 2.0  # whoever stops the station does not wait for what can be worked out again
_log = logging.getLogger(__name__)


class LookingBack:
    """While it is entered."""

    def __init__(
        self,
        hindsight: Hindsight,
        incidents: Callable[[], Iterable[Incident]],
        shown: Callable[[Incident], Tracks],
    ) -> None:
        self._hindsight = hindsight
        self._incidents = incidents
        self._shown = shown
        self._closed = Event()
        self._thread = Thread(target=self._run, name="looking back", daemon=True)

    def __enter__(self) -> LookingBack:
        self._thread.start()
        return self

    def __exit__(self, *_: object) -> None:
        self._closed.set()
        self._thread.join(GRACE_S)

    def _run(self) -> None:
        trouble = RecurringTrouble(_log, "what closed lately cannot be looked up")
        while not self._closed.wait(EVERY_S):
            with trouble:
                self._hindsight.catch_up(self._incidents(), self._shown)
