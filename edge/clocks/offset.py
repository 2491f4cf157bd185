"""Offset of the station's clock from a unit's monotonic clock, from exchanges of four
timestamps.

Pure.  An exchange bounds the offset: it is the middle of what is possible give or take half the
round trip (Mills, "Network Time Protocol", RFC 5905, section 8), so quick exchanges count for much
more than those that were queued.  The asymmetry between the two directions cannot be observed: it
stays in the uncertainty for good, however many exchanges there were.  Offset and drift are the two
states of a Kalman filter.
"""

from __future__ import annotations

import math
from collections import deque
from typing import NamedTuple

import numpy as np

from shared.clock import NS_PER_S

_RECENT = 64  # exchanges among which the quickest is looked for
_STAMP_STD_S = 2e-4  # of taking a timestamp on a busy machine
_DRIFT_STD = 5e-5  # of any quartz, before anything is known of this one
_DRIFT_WALK = 1e-8  # change of the drift with temperature, per root second
_SIGMAS = 5.0
_SLACK_S = 5e-3
_SET_AFTER = 3  # impossible exchanges in a row: the station's clock was set, or it is another


class Exchange(NamedTuple):
    """Exchange of timestamps: query and reply by the unit's monotonic clock, receipt and answer
    by the station's.
    """

    query_ns: int
    received_utc_ns: int
    sent_utc_ns: int
    reply_ns: int

    @property
    def round_trip_s(self) -> float:
        at_station_ns = self.sent_utc_ns - self.received_utc_ns
        return (self.reply_ns - self.query_ns - at_station_ns) / NS_PER_S

    @property
    def offset_ns(self) -> int:
        """Station time less monotonic time, if both ways took the same."""
        forward_ns = self.received_utc_ns - self.query_ns
        return (forward_ns + self.sent_utc_ns - self.reply_ns) // 2


class ClockEstimate(NamedTuple):
    offset_ns: int  # station time less monotonic time
    std_s: float
    drift: float  # of the station's clock against the monotonic one, seconds a second


class ClockOffsetFilter:
    """Kalman filter; ``note`` exchanges as they come; one that was overtaken by a later one is
    not used.
    """

    def __init__(self) -> None:
        self._round_trips_s: deque[float] = deque(maxlen=_RECENT)
        self._impossible = 0
        self._base_ns: int | None = None  # the states are relative to it; None: nothing is known
        self._t_ns = 0  # monotonic time of the states
        self._state = np.zeros(2)  # offset beyond the base in s, drift
        self._cov = np.zeros((2, 2))

    def note(self, exchange: Exchange) -> bool:
        """Use an exchange; return False where no such exchange is possible."""
        if exchange.round_trip_s < 0.0 or exchange.sent_utc_ns < exchange.received_utc_ns:
            return False
        middle_ns = (exchange.query_ns + exchange.reply_ns) // 2
        if self._base_ns is None:
            self._begin(exchange, middle_ns)
            return True
        if middle_ns < self._t_ns:
            return False
        state, cov = self._predicted(middle_ns)
        innovation_s = (exchange.offset_ns - self._base_ns) / NS_PER_S - float(state[0])
        most_s = exchange.round_trip_s / 2.0 + _SIGMAS * math.sqrt(cov[0, 0]) + _SLACK_S
        if abs(innovation_s) > most_s + self._quickest_s / 2.0:
            self._impossible += 1
            if self._impossible < _SET_AFTER:
                return False
            self._begin(exchange, middle_ns)
            return True
        self._impossible = 0
        self._round_trips_s.append(exchange.round_trip_s)
        gain = cov[:, 0] / (cov[0, 0] + _var(exchange.round_trip_s))
        self._state = state + gain * innovation_s
        self._cov = cov - np.outer(gain, cov[0])
        self._t_ns = middle_ns
        return True

    def at(self, t_mono_ns: int) -> ClockEstimate | None:
        """Return the estimate at a time; None before the first exchange."""
        if self._base_ns is None:
            return None
        state, cov = self._predicted(t_mono_ns)
        return ClockEstimate(
            self._base_ns + round(float(state[0]) * NS_PER_S),
            math.sqrt(float(cov[0, 0]) + _var(self._quickest_s)),
            float(state[1]),
        )

    @property
    def _quickest_s(self) -> float:
        return min(self._round_trips_s)

    def _begin(self, exchange: Exchange, middle_ns: int) -> None:
        self._round_trips_s.clear()
        self._round_trips_s.append(exchange.round_trip_s)
        self._impossible = 0
        self._base_ns, self._t_ns = exchange.offset_ns, middle_ns
        self._state = np.zeros(2)
        self._cov = np.diag([_var(exchange.round_trip_s), _DRIFT_STD**2])

    def _predicted(self, t_mono_ns: int) -> tuple[np.ndarray, np.ndarray]:
        """Return states and their covariance at a time, also one before the last exchange."""
        dt_s = (t_mono_ns - self._t_ns) / NS_PER_S
        step = np.array([[1.0, dt_s], [0.0, 1.0]])
        span_s = abs(dt_s)
        walk = _DRIFT_WALK**2 * np.array(
            [[span_s**3 / 3.0, span_s**2 / 2.0], [span_s**2 / 2.0, span_s]]
        )
        return step @ self._state, step @ self._cov @ step.T + walk


def _var(round_trip_s: float) -> float:
    """Return the variance of an offset that lies evenly within half the round trip."""
    return (round_trip_s / 2.0) ** 2 / 3.0 + _STAMP_STD_S**2
