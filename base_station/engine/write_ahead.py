"""Write-ahead log: each event is written to the log first and applied by the pipeline second, and
its decisions are logged too.  The log alone gives the same run again.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from base_station.core.events import Output, StationEvent, event_of, is_decision, number_of
from base_station.core.pipeline import StationPipeline
from base_station.engine.admission import mark_missing
from base_station.engine.console_publisher import ConsolePublisher
from base_station.engine.foxglove_topics import FoxgloveTopics
from base_station.engine.health_monitor import HealthMonitor
from base_station.engine.ports import Log, Record
from base_station.engine.projector import Projector
from shared.channels import ALARM, FUSED
from shared.codec import encode
from shared.coded_text import coded
from shared.errors import StoreError
from shared.messages import STATION_ID, AlarmChange, FusedPosition

_DECISIONS = (FusedPosition, AlarmChange)
_KEYS = {FusedPosition: FUSED.key(STATION_ID), AlarmChange: ALARM.key(STATION_ID)}


class WriteAhead:
    """Write-ahead log in front of the pipeline; publishers and projector receive the outputs."""

    def __init__(
        self,
        pipeline: StationPipeline,
        log: Log,
        publishers: Sequence[ConsolePublisher],
        projector: Projector,
        health: HealthMonitor,
    ) -> None:
        self._pipeline = pipeline
        self._log = log
        self._publishers = publishers
        self._projector = projector
        self._health = health
        self._foxglove = FoxgloveTopics()
        self._events_at_t = 0  # stepped at the pipeline's present time
        self._urgent = False  # a record was written that must be on disk before it is published

    @property
    def log_position(self) -> tuple[int, int]:
        """Position in the log: time of the last event, and number of events with that time."""
        return self._pipeline.state.t_ns, self._events_at_t

    def rebuild(self, records: Iterable[Record], after: tuple[int, int]) -> int:
        """Step the pipeline with the events of a log after a position, and return their number.

        Decisions that a crash kept from the log are written to it now.
        """
        from_ns, skip = after
        self._events_at_t = skip
        unlogged: list[FusedPosition | AlarmChange] = []
        has_decisions = False  # whether the log has a decision that followed the last event
        stepped = 0
        for t_ns, key, payload in records:
            if is_decision(key):
                del unlogged[:1]
                has_decisions = True
                continue
            if t_ns == from_ns and skip > 0:
                skip -= 1
                continue
            stepped += 1
            if has_decisions:
                unlogged.clear()
                has_decisions = False
            outputs = self._step(event_of(t_ns, key, payload))
            unlogged += [o for o in outputs if isinstance(o, _DECISIONS)]
        for output in unlogged:
            self._append_output(output)
        return stepped

    def append_and_apply(
        self, t_ns: int, key: str, payload: bytes, *, urgent: bool = False
    ) -> list[Output]:
        """Log and apply a record; return the outputs."""
        return self.append(self.event_of(t_ns, key, payload), key, payload, urgent=urgent)

    def append_or_fail(self, t_ns: int, key: str, payload: bytes) -> list[Output]:
        """Log and apply an operator action, which exists nowhere else.  Raises StoreError if the
        log does not take it; then it is not applied.
        """
        event = self.event_of(t_ns, key, payload)
        self._urgent = True
        if not self._log.write(event.t_ns, key, payload):
            raise StoreError(
                coded(
                    "not-recorded-not-done",
                    "this is not done, as it cannot be recorded: {reason}",
                    reason=self._log.problem,
                )
            )
        return self._apply(event)

    def event_of(self, t_ns: int, key: str, payload: bytes) -> StationEvent:
        """Decode a record to an event whose time is not before that of the last one, whatever the
        machine's clock does.
        """
        return event_of(max(t_ns, self._pipeline.state.t_ns), key, payload)

    def append(
        self, event: StationEvent, key: str, payload: bytes, *, urgent: bool = False
    ) -> list[Output]:
        """Log an event, then apply it; return the outputs."""
        self._urgent = self._urgent or urgent
        is_kept = self._log.write(event.t_ns, key, payload)
        outputs = self._apply(event)
        if not is_kept:
            mark_missing(number_of(event), self._pipeline.state)
        return outputs

    def flush_urgent(self) -> None:
        """Flush urgent records to disk before their outputs are published."""
        if self._urgent:
            self._urgent = False
            self._log.flush()

    def _apply(self, event: StationEvent) -> list[Output]:
        outputs = self._step(event)
        for output in outputs:
            if type(output) is FusedPosition or type(output) is AlarmChange:
                self._append_output(output)
        self._log_plan(event.t_ns)
        return outputs

    def _step(self, event: StationEvent) -> list[Output]:
        same_time = event.t_ns == self._pipeline.state.t_ns
        self._events_at_t = self._events_at_t + 1 if same_time else 1
        try:
            outputs = self._pipeline.step(event)
        except Exception as error:  # noqa: BLE001  # costs one message, not the station
            self._health.report_bug("pipeline", error)
            outputs = []
        for publisher in self._publishers:
            publisher.mark_changed(outputs)
        self._projector.note(event, outputs)
        return outputs

    def _append_output(self, output: FusedPosition | AlarmChange) -> None:
        self._urgent = self._urgent or type(output) is AlarmChange
        t_ns = output.header.t_utc_ns
        self._log.write(t_ns, _KEYS[type(output)], encode(output))
        shown = self._foxglove.of(output, self._pipeline.state.site_of(output.unit_id).anchor)
        if shown is not None:
            self._log.write(t_ns, *shown)

    def _log_plan(self, t_ns: int) -> None:
        state = self._pipeline.state
        shown = self._foxglove.plan(state.site.plan, state.site.anchor, t_ns)
        if shown is not None:
            self._log.write(t_ns, *shown)
