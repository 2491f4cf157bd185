"""Synchronous acknowledgement: an action is confirmed when both stations have it, or after a
moment without the standby.
"""

from __future__ import annotations

import time
from collections import deque
from collections.abc import Callable, Sequence
from concurrent.futures import Future
from functools import partial
from threading import Lock
from typing import NamedTuple, TypeVar

from base_station.core.log_position import START, LogPosition
from base_station.engine.ports import ActionResult, DeliveryResult, EngineGate
from shared.clock import NS_PER_S, Clock
from shared.errors import StoreError
from shared.messages.station import Action

_BEHIND_NS = 2 * NS_PER_S
_GOODBYE_NS = 2 * NS_PER_S
_LOOK_S = 0.02
_MOST_MARKS = 1000
_STANDBY_TIMEOUT_NS = 3 * NS_PER_S  # without an acknowledgement

Result = TypeVar("Result")


class _Waiting(NamedTuple):
    place: LogPosition
    until_ns: int
    answer: Callable[[], None]


class ReplicaProgress:
    """Place up to which the standby has this station's log on its disk.  From any thread."""

    def __init__(self, clock: Clock, place: Callable[[], LogPosition], confirm_s: float) -> None:
        self._clock = clock
        self._place = place
        self._confirm_ns = round(confirm_s * NS_PER_S)
        self._lock = Lock()
        self._has = START
        self._received_ns: int | None = None
        self._marks: deque[tuple[int, LogPosition]] = (
            deque()
        )  # of this log, not there yet; with times
        self._waiting: deque[_Waiting] = deque()
        self._reported = (START, START)  # places at the last two reports

    def note(self, place: LogPosition) -> None:
        """The standby acknowledges a place; an earlier one where another machine replaced it."""
        with self._lock:
            self._has = place
            self._received_ns = self._clock.monotonic_ns()
            ready = self._take_ready()
        _confirm(ready)

    def check(self) -> None:
        """Several times a second."""
        now_ns = self._clock.monotonic_ns()
        with self._lock:
            self._marks.append((now_ns, self._place()))
            while self._marks and self._marks[0][1] <= self._has:
                self._marks.popleft()
            if len(self._marks) > _MOST_MARKS:  # no standby for hours: the first one matters
                self._marks = deque(list(self._marks)[::2])
            ready = self._take_ready()
            alone = [one for one in self._waiting if now_ns >= one.until_ns]
            for one in alone:
                self._waiting.remove(one)
        _confirm([*ready, *alone])

    @property
    def is_followed(self) -> bool:
        """True if a standby fetches this log."""
        now_ns = self._clock.monotonic_ns()
        return self._received_ns is not None and now_ns - self._received_ns < _STANDBY_TIMEOUT_NS

    @property
    def is_behind(self) -> bool:
        with self._lock:
            oldest_ns = self._marks[0][0] if self._marks else None
        return oldest_ns is not None and self._clock.monotonic_ns() - oldest_ns > _BEHIND_NS

    def note_report_received(self) -> None:
        """The station reports to units which of their messages it has."""
        with self._lock:
            self._reported = self._reported[1], self._place()

    def previous_report_is_durable(self) -> bool:
        """True if the messages of the report before the last one are on the standby's disk too."""
        with self._lock:
            return START < self._reported[0] <= self._has

    def confirm(self, done: Result, confirmed: Future[Result]) -> None:
        """Hand on what was done when the standby has it too, or it takes too long."""
        with self._lock:
            place = self._place()
            until_ns = self._clock.monotonic_ns() + self._confirm_ns
            if self._has < place and self.is_followed:
                self._waiting.append(_Waiting(place, until_ns, partial(confirmed.set_result, done)))
                return
        confirmed.set_result(done)

    def drain(self) -> None:
        """Wait until the standby has all of it, where it answers."""
        end_ns = self._clock.monotonic_ns() + _GOODBYE_NS
        while (
            self.is_followed and self._has < self._place() and self._clock.monotonic_ns() < end_ns
        ):
            time.sleep(_LOOK_S)

    def close(self) -> None:
        """Confirm all that still wait."""
        with self._lock:
            left = list(self._waiting)
            self._waiting.clear()
        _confirm(left)

    def _take_ready(self) -> list[_Waiting]:
        ready = [one for one in self._waiting if one.place <= self._has]
        for one in ready:
            self._waiting.remove(one)
        return ready


class LeaderOnlyGate:
    """An ``EngineGate``: people act at the station that leads, and at no other; what units post is
    taken there alone.
    """

    def __init__(
        self, gate: EngineGate, copy: ReplicaProgress, refusal: Callable[[], str | None]
    ) -> None:
        """``refusal``: why nothing can be done here, as a sentence; None: it can."""
        self._gate = gate
        self._copy = copy
        self._refusal = refusal

    def submit(self, by: str, action: Action, action_id: str = "") -> Future[ActionResult]:
        return self._confirmed(lambda: self._gate.submit(by, action, action_id))

    def deliver(self, messages: Sequence[tuple[str, bytes]]) -> Future[DeliveryResult]:
        return self._confirmed(lambda: self._gate.deliver(messages))

    def _confirmed(self, begin: Callable[[], Future[Result]]) -> Future[Result]:
        """Result of ``begin`` once the standby has it; it is not called where this one follows."""
        confirmed: Future[Result] = Future()
        refusal = self._refusal()
        if refusal is not None:
            confirmed.set_exception(StoreError(refusal))
            return confirmed

        def forward_result(done: Future[Result]) -> None:
            error = done.exception()
            if error is not None:
                confirmed.set_exception(error)
            else:
                self._copy.confirm(done.result(), confirmed)

        begin().add_done_callback(forward_result)
        return confirmed


def _confirm(ready: list[_Waiting]) -> None:
    for one in ready:
        one.answer()
