"""Queue of operator actions for the log and the live state."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterator
from concurrent.futures import Future
from typing import NamedTuple

from base_station.core import idempotency
from base_station.core.events import Refused
from base_station.core.pipeline import StationPipeline
from base_station.engine.ports import ActionResult
from base_station.engine.write_ahead import WriteAhead
from shared.channels import OPERATOR
from shared.codec import encode
from shared.coded_text import coded
from shared.errors import StoreError
from shared.header_factory import HeaderFactory
from shared.messages import STATION_ID, OperatorAction
from shared.messages.station import Action, ForgetWearers, ReportProblem, SendCommand

_OPERATOR_KEY = OPERATOR.key(STATION_ID)
_APPLIED_WITHOUT_LOG = (SendCommand, ReportProblem)  # an evacuation waits for no disk


class PerformedAction(NamedTuple):
    """Action that was logged and applied, and is not answered yet."""

    action: Action
    result: ActionResult
    future: Future[ActionResult]

    def answer(self) -> None:
        if self.future.set_running_or_notify_cancel():
            self.future.set_result(self.result)


class ActionQueue:
    """Actions that wait.  ``put`` may be called from any thread, all else in the engine's thread,
    or when that has ended.
    """

    def __init__(
        self, pipeline: StationPipeline, write_ahead: WriteAhead, header_factory: HeaderFactory
    ) -> None:
        self._pipeline = pipeline
        self._write_ahead = write_ahead
        self._header_factory = header_factory
        self._waiting: deque[tuple[str, Action, str, Future[ActionResult]]] = deque()
        # Messages that waited during an action are new to its operator, and so later in the log.
        self.not_before_ns = 0

    def put(self, by: str, action: Action, action_id: str) -> Future[ActionResult]:
        """Queue an action; ``OperatorGate.submit`` describes the future."""
        future: Future[ActionResult] = Future()
        self._waiting.append((by, action, action_id, future))
        return future

    def perform_waiting(self, is_saving: Callable[[], bool]) -> Iterator[PerformedAction]:
        """Perform the waiting actions one after another.  ``is_saving``: a checkpoint is being
        written.
        """
        for _ in range(len(self._waiting)):
            by, action, action_id, future = self._waiting.popleft()
            if isinstance(action, ForgetWearers) and is_saving():
                # The checkpoint in progress holds the person.
                self._waiting.append((by, action, action_id, future))
                continue
            before = ActionResult.before(self._pipeline.state, action_id)
            try:
                result = before or self.perform(by, action, action_id)
            except StoreError as error:
                if future.set_running_or_notify_cancel():
                    future.set_exception(error)
                continue
            yield PerformedAction(action, result, future)

    def perform(self, by: str, action: Action, action_id: str = "") -> ActionResult:
        """Log and apply an action.  Raises StoreError if the log does not take it; then it has no
        effect, except for commands that people must receive in any case.
        """
        header = self._header_factory.header()
        action_id = action_id or f"{header.boot_id:016x}-{header.seq}"
        payload = encode(OperatorAction(header, action_id, by, action))
        t_ns = max(header.t_utc_ns, self.not_before_ns)
        if isinstance(action, _APPLIED_WITHOUT_LOG):
            outputs = self._write_ahead.append_and_apply(t_ns, _OPERATOR_KEY, payload, urgent=True)
        else:
            outputs = self._write_ahead.append_or_fail(t_ns, _OPERATOR_KEY, payload)
        self.not_before_ns = self._pipeline.state.t_ns + 1
        refused = next((output for output in outputs if isinstance(output, Refused)), None)
        return ActionResult(
            action_id, self._pipeline.state.t_ns, refused, idempotency.created_id_of(action)
        )

    def refuse_waiting(self) -> None:
        """Refuse all waiting actions, because the engine has ended."""
        while self._waiting:
            future = self._waiting.popleft()[-1]
            future.set_exception(
                StoreError(
                    coded("station-stopping", "the station is stopping; do it again when it runs")
                )
            )
