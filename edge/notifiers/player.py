"""Player of notices on one output, in a thread of its own.

An output that hangs, is gone or is broken delays nothing else; it is tried again for ever.
"""

from __future__ import annotations

import math
import time
from collections import deque
from collections.abc import Sequence
from threading import Event, Lock

from edge.fault_texts import fault_of
from edge.notifiers.interface import Notifier
from edge.notifiers.signals import Notice
from edge.sources.sysfs import explain_read_error
from shared.coded_text import coded
from shared.worker import UNTIL_WOKEN, Worker

_RETRY_S = 1.0
_LEAST_WAIT_S = 0.01
_CLOSE_S = 1.0
_PLAYED_MAX = 1000


class NoticePlayer:
    """Plays the notices that are shown by turns: of those that are due the one that was played
    longest ago, and of several that were never played the most urgent.

    A notice that is due and more urgent than the one that is being played interrupts it; one that
    is shown no more ends at once.
    """

    def __init__(self, title: str, notifier: Notifier) -> None:
        """``title``: of the output, for a person."""
        self._title = title
        self._notifier = notifier
        self._lock = Lock()
        self._shown: tuple[Notice, ...] = ()
        self._ended_s: dict[Notice, float] = {}  # when each that is shown was last played
        self._playing: Notice | None = None
        self._interrupt = Event()
        self._played: deque[Notice] = deque(maxlen=_PLAYED_MAX)
        self._faults: deque[str] = deque(maxlen=_PLAYED_MAX)
        self._reported = ""
        self._worker = Worker(
            f"output {title}", self._step, f"the output {title} fails", at_end=notifier.close
        )

    def start(self) -> None:
        self._worker.start()

    def show(self, notices: Sequence[Notice]) -> None:
        """Set what the wearer is to be notified of from now on; never waits."""
        with self._lock:
            if tuple(notices) == self._shown:
                return
            self._shown = tuple(notices)
            self._ended_s = {one: at for one, at in self._ended_s.items() if one in self._shown}
            if self._playing is not None and self._is_superseded(self._playing):
                self._interrupt.set()
        self._worker.wake()

    def take_played(self) -> tuple[Notice, ...]:
        """Return notices that were played to their end since the last call, for the first time."""
        return tuple(self._played.popleft() for _ in range(len(self._played)))

    def take_faults(self) -> tuple[str, ...]:
        return tuple(self._faults.popleft() for _ in range(len(self._faults)))

    def close(self) -> None:
        self._worker.stop()
        self._interrupt.set()
        self._worker.join(_CLOSE_S)

    def _step(self) -> float:
        with self._lock:
            self._playing = self._next()
            self._interrupt.clear()
            if self._playing is None:
                return self._wait_s()
        try:
            self._notifier.play(self._playing, self._interrupt)
        except OSError as error:
            self._report(explain_read_error(error))
            return _RETRY_S
        finally:
            with self._lock:
                playing, self._playing = self._playing, None
        self._reported = ""
        with self._lock:
            if not self._interrupt.is_set() and playing in self._shown:
                if playing not in self._ended_s:
                    self._played.append(playing)
                self._ended_s[playing] = time.monotonic()
        return 0.0

    def _next(self) -> Notice | None:
        due = [one for one in self._shown if self._due_s(one) <= time.monotonic()]
        return min(due, key=lambda one: (self._ended_s.get(one, 0.0), _rank(one)), default=None)

    def _is_superseded(self, playing: Notice) -> bool:
        urgent = (one for one in self._shown if _rank(one) < _rank(playing))
        now_s = time.monotonic()
        return playing not in self._shown or any(self._due_s(one) <= now_s for one in urgent)

    def _due_s(self, notice: Notice) -> float:
        """Return when a notice is to be played, on the monotonic clock; at once for the first."""
        ended_s = self._ended_s.get(notice)
        return 0.0 if ended_s is None else ended_s + notice.pause_s

    def _wait_s(self) -> float:
        wait_s = min(map(self._due_s, self._shown), default=math.inf) - time.monotonic()
        return UNTIL_WOKEN if math.isinf(wait_s) else max(wait_s, _LEAST_WAIT_S)

    def _report(self, reason: str) -> None:
        if reason != self._reported:
            self._reported = reason
            output = coded("device-output", "output {name}", name=self._title)
            self._faults.append(fault_of(output, reason))


def _rank(notice: Notice) -> int:
    return notice.signal.urgency
