"""What one station asks the other: questions under its keys, asked in rounds."""

from __future__ import annotations

import logging
from collections.abc import Callable, Iterable, Mapping
from threading import Event, Thread

from base_station.program.recurring_trouble import RecurringTrouble
from base_station.standby.words import key_of
from shared.bus import Bus, QueryHandler

logger = logging.getLogger(__name__)

_TIMEOUT_S = 5.0


class Answers:
    """Serves a station's answers until it is closed."""

    def __init__(self, station: str, bus: Bus, answers: Mapping[str, QueryHandler]) -> None:
        self._serving = [
            bus.serve(key_of(station, what), answer) for what, answer in answers.items()
        ]

    def close(self) -> None:
        for subscription in self._serving:
            subscription.close()


def ask(bus: Bus, station: str, what: str, payload: bytes = b"") -> Iterable[bytes]:
    """What the station answers; nothing where it is not there, or has nothing to say."""
    return bus.query(key_of(station, what), payload, _TIMEOUT_S)


class Rounds:
    """Calls ``look`` every ``every_s``, in a thread of its own.

    No failure ends the thread: it is logged behind ``failing`` (half a sentence), and the next
    round tries again.  A ``look`` that takes long ends when the event that it is given is set.
    """

    def __init__(
        self, name: str, every_s: float, look: Callable[[Event], None], failing: str
    ) -> None:
        self._every_s = every_s
        self._look = look
        self._failing = failing
        self._trouble = RecurringTrouble(logger, failing)
        self._closing = Event()
        self._thread = Thread(target=self._run, name=name, daemon=True)

    def start(self) -> None:
        self._thread.start()

    def close(self) -> None:
        self._closing.set()
        self._thread.join()

    def _run(self) -> None:
        while not self._closing.wait(self._every_s):
            try:
                with self._trouble:
                    self._look(self._closing)
            except Exception:
                logger.exception("%s; it is tried again", self._failing)
