"""Monitor of the messages of an x-IMU3: counts, and faults for a person."""

from __future__ import annotations

import logging

from edge.sources.ximu3.messages import Inertial, Message
from shared.clock import NS_PER_S
from shared.coded_text import coded
from shared.errors import WireError

logger = logging.getLogger(__name__)

_CHECK_NS = 10 * NS_PER_S
_MANY = 0.01  # of what came: a line that loses more is worth a look
_RATE_OFF = 0.15
_SHOWN = 40  # bytes of a garbled message
_ENOUGH = 100  # samples, for a rate


class MessageMonitor:
    """Monitor; ``rate_hz``: of the inertial messages, as it was set."""

    def __init__(self, rate_hz: float) -> None:
        self._rate_hz = rate_hz
        self._rate_reported = False
        self._loss_reported = False
        self.garbled = 0  # since the start
        self.on_open()

    def on_open(self) -> None:
        """Start again: a connection has just been opened."""
        self._has_inertial = False
        self._reset_counts()

    def _reset_counts(self) -> None:
        self._understood = self._garbled = self._inertial = 0
        self._first_garbled = ""
        self._first_us: int | None = None
        self._last_us = 0
        self._checked_ns: int | None = None

    def count(self, message: Message) -> None:
        self._understood += 1
        if isinstance(message, Inertial):
            self._has_inertial = True
            self._inertial += 1
            self._first_us = message.t_us if self._first_us is None else self._first_us
            self._last_us = message.t_us

    def count_garbled(self, frame: bytes, error: WireError) -> None:
        """The first frame of a serial line is mostly half a message: counted, and no fault."""
        self.garbled += 1
        self._garbled += 1
        self._first_garbled = self._first_garbled or f"{frame[:_SHOWN]!r} ({error})"

    def silence_reason(self) -> str:
        if self._has_inertial:
            return coded("ximu-silent", "it has fallen silent; is it on, in reach and charged?")
        if self._understood > self._garbled:
            return coded(
                "ximu-no-inertial",
                "it sends no inertial messages; set its inertial message rate divisor to 1",
            )
        if self._garbled:
            return coded(
                "ximu-other-device",
                "what comes is no x-IMU3's: {garbled}; is this the right device, and on a serial "
                "line the right ?baud=",
                garbled=self._first_garbled,
            )
        return coded(
            "ximu-nothing",
            "the line is open and nothing comes; is the device on, and are its data messages "
            "switched on for this line?",
        )

    def take_events(self, now_ns: int) -> list[str]:
        """Return faults of the last ten seconds; mostly none."""
        if self._checked_ns is None:
            self._checked_ns = now_ns
        if now_ns - self._checked_ns < _CHECK_NS:
            return []
        faults = [*self._garbled_fault(), *self._rate_fault()]
        self._reset_counts()
        self._checked_ns = now_ns
        return faults

    def _garbled_fault(self) -> list[str]:
        """Once while it lasts: until ten seconds in which nothing was lost."""
        if not self._garbled:
            self._loss_reported = False
            return []
        received = self._garbled + self._understood
        found = coded(
            "ximu-garbled",
            "{garbled} of {received} messages in {within_s:.0f} s could not be read, such as "
            "{first}; look at the cable, the radio or ?baud=",
            garbled=self._garbled,
            received=received,
            within_s=_CHECK_NS / NS_PER_S,
            first=self._first_garbled,
        )
        if self._garbled <= _MANY * received or self._loss_reported:
            logger.info(found)
            return []
        self._loss_reported = True
        return [found]

    def _rate_fault(self) -> list[str]:
        """Compare the rate by the device's own clock, once: it is a setting."""
        if self._rate_reported or self._first_us is None or self._inertial < _ENOUGH:
            return []
        span_us = self._last_us - self._first_us
        if span_us <= 0:
            return []
        rate_hz = (self._inertial - 1) * 1e6 / span_us
        if abs(rate_hz / self._rate_hz - 1.0) < _RATE_OFF:
            return []
        self._rate_reported = True
        return [
            coded(
                "ximu-rate",
                "it sends {rate_hz:.0f} samples a second, configured are {set_hz:g}; set its "
                "inertial message rate divisor to 1 (400 a second), or write ?rate={rate_hz:.0f}",
                rate_hz=round(rate_hz),
                set_hz=self._rate_hz,
            )
        ]
