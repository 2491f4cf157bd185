"""Worker: a thread that repeats one step until it is stopped, and goes on after a step that failed.

A step does what is due and returns after how many seconds the next one is due: 0.0 at once,
``UNTIL_WOKEN`` when there is something to do again.  A step that raises is logged once for as long
as the same error comes, and repeated; what the step had begun is the step's own concern.
"""

from __future__ import annotations

import logging
import math
from collections.abc import Callable
from threading import Event, Thread

from shared.log_on_change import LogOnChange

logger = logging.getLogger(__name__)

UNTIL_WOKEN = math.inf
_RETRY_S = 1.0
_FAILURES_MAX = 30  # in succession: more are no passing fault

Step = Callable[[], float]


class Worker:
    """Thread of one task; ``start`` once, ``wake`` and ``stop`` from any thread."""

    def __init__(
        self,
        name: str,
        step: Step,
        failing: str,
        *,
        retry_s: float = _RETRY_S,
        first_after_s: float = 0.0,
        at_end: Callable[[], None] | None = None,
        daemon: bool = True,
    ) -> None:
        """``failing``: sentence for the log while steps fail, without its cause; ``retry_s``: pause
        after a failed step; ``at_end``: called in the thread after the last step.
        """
        self.stopping = Event()
        self._step = step
        self._retry_s = retry_s
        self._first_after_s = first_after_s
        self._at_end = at_end
        self._fault_log = LogOnChange(logger, failing)
        self._failures = 0  # in succession
        self._woken = Event()
        self._thread = Thread(target=self._run, name=name, daemon=daemon)

    @classmethod
    def periodic(
        cls, name: str, every_s: float, task: Callable[[Event], object], failing: str
    ) -> Worker:
        """Return a worker that calls ``task`` every ``every_s``, first after that time.

        A task that takes long returns when the event that it is called with is set.
        """

        def step() -> float:
            task(worker.stopping)
            return every_s

        worker = cls(name, step, failing, retry_s=every_s, first_after_s=every_s)
        return worker

    def start(self) -> None:
        self._thread.start()

    @property
    def is_alive(self) -> bool:
        return self._thread.is_alive()

    @property
    def is_working(self) -> bool:
        """False when the thread is not running, or thirty steps in succession have failed."""
        return self.is_alive and self._failures < _FAILURES_MAX

    @property
    def fault(self) -> str:
        """Cause of the last step's failure; empty when it succeeded."""
        return self._fault_log.fault

    def wake(self) -> None:
        """Make the next step due at once."""
        self._woken.set()

    def wait(self, timeout_s: float) -> bool:
        """Wait within a step until woken, stopped or the time is over; return True when stopped."""
        self._woken.wait(timeout_s)
        self._woken.clear()
        return self.stopping.is_set()

    def stop(self) -> None:
        """Let the step under way be the last."""
        self.stopping.set()
        self._woken.set()

    def join(self, timeout_s: float | None = None) -> bool:
        """Wait for the end of the thread; return False when it has not ended in time.

        One that was never started has ended, and a thread does not wait for itself.
        """
        if self._thread.ident is not None:
            self._thread.join(timeout_s)
        return not self.is_alive

    def close(self, timeout_s: float | None = None) -> bool:
        """Stop, and wait for the end; return False when it has not ended in time."""
        self.stop()
        return self.join(timeout_s)

    def _run(self) -> None:
        pause_s = self._first_after_s
        while not self._pause(pause_s):
            pause_s = self._attempt()
        if self._at_end is not None:
            try:
                self._at_end()
            except Exception as error:  # noqa: BLE001  # logged as that of any step
                self._fault_log.note_failure(error)

    def _pause(self, seconds: float) -> bool:
        """Wait for the next step; return True when there is to be none."""
        if seconds > 0.0 and not self.stopping.is_set():  # a step's wait may have taken the wake
            self._woken.wait(None if seconds == UNTIL_WOKEN else seconds)
        self._woken.clear()  # before the step looks: what comes while it does is not missed
        return self.stopping.is_set()

    def _attempt(self) -> float:
        """Take one step; return the pause after it."""
        try:
            pause_s = self._step()
        except Exception as error:  # noqa: BLE001  # a worker that ended would never do its task
            self._failures += 1
            self._fault_log.note_failure(error)
            return self._retry_s
        self._failures = 0
        self._fault_log.note_success()
        return pause_s
