"""State of a forwarder's connection, for its line on the console and for its problem."""

from __future__ import annotations

import logging

from shared.clock import NS_PER_S, Clock

logger = logging.getLogger(__name__)


class ConnectionStatus:
    """State that the forwarder's thread alone writes and any thread reads."""

    def __init__(self, name: str, clock: Clock) -> None:
        """``name`` of the connection, for the log."""
        self._name, self._clock = name, clock
        self._away_since_ns: int | None = clock.monotonic_ns()  # None: connected, or not to be
        self.state = "connecting"
        self.reason = ""
        self.since_ns: int | None = None  # station time of the last change
        self.sent = 0  # since the start

    @property
    def away_s(self) -> float:
        """Seconds for which it has been trying to connect; 0 if it is connected, or is not to
        be.
        """
        since_ns = self._away_since_ns
        return 0.0 if since_ns is None else (self._clock.monotonic_ns() - since_ns) / NS_PER_S

    def set(self, state: str, reason: str = "") -> None:
        """Set the state: connecting, connected or standby.  ``reason``: a phrase for a person."""
        if state != self.state:
            self.state, self.since_ns = state, self._clock.utc_ns()
            logger.info("%s: %s %s", self._name, state, reason)
        if state != "connecting":
            self._away_since_ns = None
        elif self._away_since_ns is None:
            self._away_since_ns = self._clock.monotonic_ns()
        self.reason = reason
