"""Reader of the wearer's button, in a thread of its own.

A button that is gone is looked for again for ever; why it cannot be read is reported once, until it
has been read for ten seconds.
"""

from __future__ import annotations

import logging
import time
from collections import deque

from edge.fault_texts import fault_of, program_error
from edge.samples import ButtonPress
from edge.sources.sysfs import explain_read_error
from edge.wearer.gestures import HOLD_NS, STUCK_NS, ButtonStuck, Gesture, GestureRecognizer
from edge.wearer.interface import ButtonDriver, ButtonError
from shared.clock import NS_PER_S, Clock
from shared.coded_text import coded, text_of_error
from shared.worker import Worker

logger = logging.getLogger(__name__)

_RETRY_S = 1.0
_IDLE_S = 0.2
_WATCHFUL_S = 0.02  # while the wearer does something
_RECOVERED_NS = 10 * NS_PER_S
_DECIDED_S = 3.5  # any gesture that has begun is over by then
_JOIN_TIMEOUT_S = 1.0  # one that hangs is left behind


class ButtonReader:
    """``start``, then ``take`` the presses; see ``edge.sources.interface.AuxiliarySource``."""

    def __init__(
        self, title: str, driver: ButtonDriver, clock: Clock, hold_ns: int = HOLD_NS
    ) -> None:
        """``title``: for a person.  ``hold_ns``: after which a hold is a mayday."""
        self._title = title
        self._driver = driver
        self._clock = clock
        self._gestures = GestureRecognizer(hold_ns)
        self._presses: deque[ButtonPress] = deque()
        self._faults: deque[str] = deque()
        self._reasons: set[str] = set()  # reported, and not over yet
        self._has_looked = False  # at the button, or for it
        self._is_open = False
        self._opened_ns = 0
        self._worker = Worker(
            "button", self._step, f"{title} cannot be read", retry_s=_RETRY_S, at_end=driver.close
        )

    def start(self) -> None:
        self._worker.start()

    def take(self) -> tuple[ButtonPress, ...]:
        return tuple(self._presses.popleft() for _ in range(len(self._presses)))

    def take_faults(self) -> tuple[str, ...]:
        return tuple(self._faults.popleft() for _ in range(len(self._faults)))

    def close(self) -> None:
        """Stop when the wearer's gesture under way is decided: a mayday that is being called as the
        agent ends is not cut off, not even where it ends as it begins.
        """
        end_s = time.monotonic() + _DECIDED_S
        while self._is_deciding and time.monotonic() < end_s:
            time.sleep(_WATCHFUL_S)
        if not self._worker.close(_JOIN_TIMEOUT_S):
            logger.warning("%s hangs, and is left behind", self._title)

    @property
    def _is_deciding(self) -> bool:
        is_undecided = not self._has_looked or self._gestures.is_undecided
        return self._worker.is_alive and is_undecided

    def _step(self) -> float:
        try:
            return self._read() if self._is_open else self._open()
        except ButtonError as error:
            reason = text_of_error(error)
        except OSError as error:
            reason = explain_read_error(error)
        except Exception as error:  # a driver may fail in any way; it is opened again
            reason = program_error(error)
            if reason not in self._reasons:
                logger.exception("%s failed", self._title)
        self._driver.close()
        if self._is_open:
            self._take(self._gestures.lose(self._clock.monotonic_ns()))
        self._is_open = False
        self._has_looked = True
        self._report(reason)
        return _RETRY_S

    def _open(self) -> float:
        self._take(self._gestures.advance(self._clock.monotonic_ns()))
        self._driver.open()
        self._is_open, self._opened_ns = True, self._clock.monotonic_ns()
        return 0.0

    def _read(self) -> float:
        self._driver.wait(_WATCHFUL_S if self._gestures.is_undecided else _IDLE_S)
        now_ns = self._clock.monotonic_ns()  # before it is read: a change after this is not missed
        for change in self._driver.read():
            self._take(self._gestures.push(change))
        self._take(self._gestures.advance(now_ns))
        self._has_looked = True
        if self._reasons and now_ns - self._opened_ns > _RECOVERED_NS:
            logger.info("%s can be read again", self._title)
            self._reasons.clear()
        return 0.0

    def _take(self, gestures: list[Gesture]) -> None:
        for found in gestures:
            if isinstance(found, ButtonStuck):
                self._add_fault(
                    coded(
                        "button-stuck",
                        "pressed for {pressed_s:.0f} s: it is stuck, or something lies on it; "
                        "until it is released no gesture can be made with it",
                        pressed_s=STUCK_NS / NS_PER_S,
                    )
                )
            else:
                logger.info("%s: %s", self._title, found.button)
                self._presses.append(found)

    def _report(self, reason: str) -> None:
        if reason not in self._reasons:
            self._reasons.add(reason)
            self._add_fault(coded("button-unreadable", "cannot be read: {reason}", reason=reason))

    def _add_fault(self, fault: str) -> None:
        text = fault_of(self._title, fault)
        logger.warning(text)
        self._faults.append(text)
