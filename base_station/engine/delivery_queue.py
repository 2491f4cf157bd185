"""Messages of units that wait for an answer.  They are admitted like those from the bus, and
answered once they are on disk.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Sequence
from concurrent.futures import Future

from base_station.core.pipeline import StationPipeline
from base_station.engine.admission import Admission
from base_station.engine.ports import DeliveryResult, Log
from shared.clock import Clock
from shared.codec import header_of
from shared.coded_text import coded
from shared.errors import StoreError

_STOPPING = coded("stopping-send-again", "the station is stopping; send it again when it runs")
_DISK_SLOW = coded("disk-slow", "the disk is slow")

_Waiting = tuple[Sequence[tuple[str, bytes]], Future[DeliveryResult]]


class DeliveryQueue:
    """Messages that wait.  ``put`` may be called from any thread, all else in the engine's thread,
    or when that has ended.
    """

    def __init__(self, pipeline: StationPipeline, log: Log, clock: Clock) -> None:
        self._pipeline = pipeline
        self._log = log
        self._clock = clock
        self._waiting: deque[_Waiting] = deque()

    def put(self, messages: Sequence[tuple[str, bytes]]) -> Future[DeliveryResult]:
        """Queue messages; ``EngineGate.deliver`` describes the future."""
        future: Future[DeliveryResult] = Future()
        self._waiting.append((messages, future))
        return future

    def admit_waiting(self, admit: Callable[[int, str, bytes], Admission]) -> None:
        """Admit the waiting messages, flush them to disk, then answer."""
        results: list[tuple[Future[DeliveryResult], DeliveryResult | None]] = []
        for _ in range(len(self._waiting)):
            messages, future = self._waiting.popleft()
            result = DeliveryResult(
                tuple(admit(self._clock.utc_ns(), key, payload) for key, payload in messages)
            )
            is_kept = all(
                self._is_kept(payload)
                for (_, payload), admission in zip(messages, result.admissions, strict=True)
                if admission is Admission.ACCEPT
            )
            results.append((future, result if is_kept else None))
        is_on_disk = bool(results) and self._log.flush()
        for future, kept in results:
            if not future.set_running_or_notify_cancel():
                continue
            if kept is None or not is_on_disk:
                problem = coded(
                    "not-recorded",
                    "not recorded: {reason}; send it again",
                    reason=self._log.problem or _DISK_SLOW,
                )
                future.set_exception(StoreError(problem))
            else:
                future.set_result(kept)

    def refuse_waiting(self) -> None:
        """Refuse all waiting deliveries, because the engine has ended."""
        while self._waiting:
            future = self._waiting.popleft()[1]
            future.set_exception(StoreError(_STOPPING))

    def _is_kept(self, payload: bytes) -> bool:
        """False for a message that the log did not take; it counts as missing."""
        header = header_of(payload)
        if header is None:
            return False
        sender = self._pipeline.state.sender(header.unit_id)
        return sender is not None and sender.has(header.boot_id, header.seq)
