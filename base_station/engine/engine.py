"""Engine: the thread that runs the live station, with feed, log, pipeline and publishing.

A record is written to the log first and applied second (``write_ahead``).  Time (ticks) and
operator actions become log records like any other.  Nothing in here waits for the network, the
database or a console.
"""

from __future__ import annotations

import logging
import time
from collections import deque
from collections.abc import Callable, Iterable, Iterator, Sequence
from concurrent.futures import Future
from dataclasses import dataclass

import msgspec

from base_station.core.commands import command_tracker
from base_station.core.pipeline import StationPipeline
from base_station.engine.action_queue import ActionQueue
from base_station.engine.admission import Admission, classify, mark_missing, rejection_reason
from base_station.engine.checkpoint_writer import CheckpointWriter
from base_station.engine.console_publisher import ConsolePublisher
from base_station.engine.console_recorder import ConsoleRecorder
from base_station.engine.delivery_queue import DeliveryQueue
from base_station.engine.delta_pace import DeltaPace
from base_station.engine.external_queue import ExternalQueue
from base_station.engine.health_monitor import HealthMonitor
from base_station.engine.message_report import message_report
from base_station.engine.ports import ActionResult, DeliveryResult, EnginePorts, Record, Trails
from base_station.engine.projector import Projector
from base_station.engine.write_ahead import WriteAhead
from base_station.unit_sync.log_gap_detector import Lost
from base_station.views.wire import Snapshot
from shared.channels import OPERATOR, TICK
from shared.clock import NS_PER_S
from shared.codec import encode
from shared.header_factory import HeaderFactory
from shared.messages import STATION_ID, ExternalMarker, Tick
from shared.messages.station import (
    AcknowledgeAlarm,
    Action,
    CloseIncident,
    ConfirmCommand,
    SendCommand,
    UndoConfirmation,
)
from shared.worker import Worker

TICK_NS = NS_PER_S
SOONER_TICK_NS = TICK_NS // 4  # at most, where links come and go all the time
STALLED_NS = 5 * NS_PER_S  # between two rounds: the machine was suspended or overloaded
RECEIVE_FIRST_NS = 2 * NS_PER_S  # before the next tick after a stall, for its links
CHECKPOINT_NS = 15 * NS_PER_S  # of log that a restart applies: a second's work at 1,000 events/s
CHECKPOINTS_SHARE = 100  # at most a hundredth of the engine's time is for checkpoints
REBUILT_NS = 5 * 60 * NS_PER_S  # of log between checkpoints at a start
MANY_STEPPED = 1000  # events at a start, after which a checkpoint is written at once
FINISH_NS = 2 * NS_PER_S  # at the end, for records that wait in the feed
STOP_TIMEOUT_S = 10.0

_OPERATOR_KEY = OPERATOR.key(STATION_ID)
# Commands to units change with these at once; with all else at the next tick.
_CHANGES_ORDERS = (
    SendCommand,
    ConfirmCommand,
    UndoConfirmation,
    AcknowledgeAlarm,
    CloseIncident,
)

log = logging.getLogger(__name__)


@dataclass
class _Due:
    """Monotonic times at which work is due next."""

    tick_ns: int
    sooner_tick_ns: int  # where links are gone
    checkpoint_ns: int


class StationEngine:
    """``EngineGate`` and ``LiveSource`` of the live station."""

    def __init__(self, pipeline: StationPipeline, ports: EnginePorts) -> None:
        self._pipeline = pipeline
        self._ports = ports
        self._header_factory = HeaderFactory(STATION_ID, ports.boot_id, ports.clock)
        self._health = HealthMonitor()
        self._publisher = ConsolePublisher(pipeline, ports.live, ports.people)
        self._console_recorder = ConsoleRecorder(pipeline, ports.log)
        self._projector = Projector()
        publishers = self._publisher, self._console_recorder.publisher
        self._write_ahead = WriteAhead(
            pipeline, ports.log, publishers, self._projector, self._health
        )
        self._checkpoint_writer = CheckpointWriter(ports.log, ports.checkpoints, self._health)
        self._actions = ActionQueue(pipeline, self._write_ahead, self._header_factory)
        self._deliveries = DeliveryQueue(pipeline, ports.log, ports.clock)
        self._lost: deque[Lost] = deque()
        self._external = ExternalQueue(self._write_ahead.append_and_apply, self._header_factory)
        self._snapshot_requests: deque[Callable[[Snapshot, Trails], None]] = deque()
        self._unlinked: frozenset[str] = frozenset()  # as reported last
        self._receives_first = False
        self._worker = Worker(
            "station-drive",
            self._step,
            "the station's engine does not go on",
            at_end=self._finish,
            daemon=False,
        )
        now_ns = self._last_run_ns = ports.clock.monotonic_ns()
        self._due = _Due(now_ns, now_ns, now_ns + CHECKPOINT_NS)
        self._messages_before = 0
        self._repeated = 0  # messages that were in the log already
        self._delta_pace = DeltaPace(now_ns)
        self._health_due = False  # the next delta carries the station's health

    # ---- from any thread

    def start(self) -> None:
        self._last_run_ns = self._ports.clock.monotonic_ns()
        self._worker.start()

    def stop(self) -> None:
        """Process all received events, then end."""
        self._worker.stop()
        self._ports.feed.wake()
        self._worker.join(STOP_TIMEOUT_S)

    def submit(self, by: str, action: Action, action_id: str = "") -> Future[ActionResult]:
        future = self._actions.put(by, action, action_id)
        self._ports.feed.wake()
        if self._has_ended:
            self._actions.refuse_waiting()
        return future

    def deliver(self, messages: Sequence[tuple[str, bytes]]) -> Future[DeliveryResult]:
        future = self._deliveries.put(messages)
        self._ports.feed.wake()
        if self._has_ended:
            self._deliveries.refuse_waiting()
        return future

    @property
    def _has_ended(self) -> bool:
        return self._worker.stopping.is_set() and not self._worker.is_alive

    def save_soon(self) -> None:
        """Write a checkpoint at once, because those on disk were deleted."""
        self._due.checkpoint_ns = 0
        self._ports.feed.wake()

    def mark_missing(self, lost: Lost) -> None:
        """Mark messages as missing that the log has lost."""
        self._lost.append(lost)
        self._ports.feed.wake()

    def note_external(self, markers: tuple[ExternalMarker, ...], removed: tuple[str, ...]) -> None:
        """Queue people and markers of other teams (``ExternalQueue``)."""
        self._external.put(markers, removed)
        self._ports.feed.wake()

    def request_snapshot(self, deliver: Callable[[Snapshot, Trails], None]) -> None:
        self._snapshot_requests.append(deliver)
        self._ports.feed.wake()

    # ---- before the thread runs

    @property
    def log_position(self) -> tuple[int, int]:
        """Position in the log: time of the last event, and number of events with that time."""
        return self._write_ahead.log_position

    def rebuild(self, records: Iterable[Record], after: tuple[int, int] = (0, 0)) -> int:
        """Step the pipeline with the events of a log, and return their number.

        ``after`` is the position (time, number of events with that time) of the checkpoint from
        which the pipeline was made.
        """
        stepped = self._write_ahead.rebuild(self._with_checkpoints(records), after)
        self._flush_urgent()
        if stepped >= MANY_STEPPED:  # killed sooner than it saves, it would step more every time
            self._due.checkpoint_ns = 0
        return stepped

    def _with_checkpoints(self, records: Iterable[Record]) -> Iterator[Record]:
        """Pass on records and write checkpoints meanwhile, so that a start that is killed need not
        apply all of them again.
        """
        due_ns = 0
        for record in records:
            if record[0] >= due_ns:
                if due_ns:
                    self._save_checkpoint()
                due_ns = record[0] + REBUILT_NS
            yield record

    # ---- in the thread

    def _step(self) -> float:
        with self._health.guard("drive"):
            self._run_once()  # waits in the feed for the next record or due time
        return 0.0

    def _run_once(self) -> bool:
        """Process received events, then all work that is due.  True if events were received."""
        clock, due = self._ports.clock, self._due
        wait_ns = min(due.tick_ns, self._delta_pace.due_ns) - clock.monotonic_ns()
        records = self._ports.feed.take(max(wait_ns, 0) / NS_PER_S)
        follows = self._ports.feed.follows
        for t_ns, key, payload in records:
            try:
                if follows:
                    self._write_ahead.append_and_apply(t_ns, key, payload)
                    if key == _OPERATOR_KEY:
                        self._record_console(at_once=True)
                else:
                    self._admit(t_ns, key, payload)
            except Exception as error:  # noqa: BLE001  # costs this record, not those behind it
                self._health.report_bug("drive", error)
        if not follows:  # a follower's log may end before the events that an action needs
            self._take_actions()
            self._external.apply_waiting(self._actions.not_before_ns)
            self._deliveries.admit_waiting(self._admit)
        self._mark_missing()
        now_ns = clock.monotonic_ns()
        self._advance_time(now_ns, follows=follows)
        if now_ns >= due.checkpoint_ns and not self._checkpoint_writer.is_under_way:
            self._save_checkpoint()
            spent_ns = clock.monotonic_ns() - now_ns
            due.checkpoint_ns = now_ns + max(CHECKPOINT_NS, spent_ns * CHECKPOINTS_SHARE)
        self._flush_urgent()
        pace = self._delta_pace
        if now_ns >= (pace.urgent_due_ns if self._publisher.is_urgent else pace.due_ns):
            before_ns = time.thread_time_ns()
            try:
                self._publish()
            finally:  # also after an error
                pace.note_sent(now_ns, time.thread_time_ns() - before_ns)
        while self._snapshot_requests:
            snapshot = (
                self._publisher.snapshot()
            )  # where it cannot be made, the caller keeps waiting
            self._snapshot_requests.popleft()(*snapshot)
        return bool(records)

    def _advance_time(self, now_ns: int, *, follows: bool) -> None:
        """Tick once a second, and at once when a link is gone."""
        due, unlinked = self._due, self._ports.unlinked()
        last_run_ns, self._last_run_ns = self._last_run_ns, now_ns
        if now_ns - last_run_ns > STALLED_NS and not self._receives_first:
            # Else all units would be lost: their messages could not be received meanwhile.
            due.tick_ns = due.sooner_tick_ns = now_ns + RECEIVE_FIRST_NS
            self._receives_first = True  # once, so that time advances in slow rounds too
        is_due = now_ns >= due.tick_ns
        if is_due:
            due.tick_ns = max(due.tick_ns + TICK_NS, now_ns)
            self._receives_first = False
        if is_due or (unlinked - self._unlinked and now_ns >= due.sooner_tick_ns):
            self._unlinked = unlinked
            due.sooner_tick_ns = now_ns + SOONER_TICK_NS
            if not follows:  # else the other station's ticks advance the time
                self._tick()
        if is_due:
            self._update_health()

    def _admit(self, t_ns: int, key: str, payload: bytes) -> Admission:
        """Classify a unit's message; log and apply it if it is accepted."""
        event = self._write_ahead.event_of(max(t_ns, self._actions.not_before_ns), key, payload)
        admission = classify(key, event, self._pipeline.state)
        if admission is Admission.ACCEPT:  # nearly always
            self._write_ahead.append(event, key, payload)
        elif admission is Admission.ACCEPT_URGENT:
            self._write_ahead.append(event, key, payload, urgent=True)
        elif admission is Admission.DUPLICATE:
            self._repeated += 1
        elif reason := rejection_reason(admission, key):
            self._health.report("bus", reason)
        return admission

    def _take_actions(self) -> None:
        for done in self._actions.perform_waiting(lambda: self._checkpoint_writer.is_under_way):
            self._flush_urgent()
            self._record_console(at_once=True)
            if isinstance(done.action, _CHANGES_ORDERS):
                self._ports.send_orders(command_tracker.open_orders(self._pipeline.state))
            done.answer()
            self._delta_pace.send_at_once()  # its operator sees it at once

    def _mark_missing(self) -> None:
        for _ in range(len(self._lost)):
            for (sender_id, boot_id), runs in self._lost.popleft().items():
                for seq in (seq for run in runs for seq in range(run.first, run.last + 1)):
                    mark_missing((sender_id, boot_id, seq), self._pipeline.state)

    def _tick(self) -> None:
        header = self._header_factory.header()
        t_ns = max(header.t_utc_ns, self._pipeline.state.t_ns, self._actions.not_before_ns)
        tick = Tick(header, t_ns, tuple(sorted(self._unlinked & self._pipeline.state.units.keys())))
        self._write_ahead.append_and_apply(t_ns, TICK.key(STATION_ID), encode(tick))
        self._report_problems()
        is_behind = self._ports.log.is_behind  # reported messages may then be in memory only
        if not (is_behind and self._ports.log.refuses):  # else fetched messages would be lost
            held = message_report(self._pipeline.state, self._ports.linked())
            self._ports.report(held, is_behind)
        self._ports.send_orders(command_tracker.open_orders(self._pipeline.state))

    def _update_health(self) -> None:
        messages = self._pipeline.state.counts.messages
        self._publisher.facts = msgspec.structs.replace(
            self._ports.facts(),
            messages_per_s=float(messages - self._messages_before),
            repeated=self._repeated,
        )
        self._messages_before = messages
        self._health_due = True

    def _flush_urgent(self) -> None:
        """Flush urgent records to disk before the database or a console gets them."""
        self._write_ahead.flush_urgent()
        if self._projector.is_urgent:
            self._project()

    def _project(self) -> None:
        projection = self._projector.take(self._pipeline.state.t_ns)
        if projection is not None:
            self._ports.projection.project(projection)

    def _publish(self) -> None:
        self._project()
        health, self._health_due = self._health_due, False
        self._publisher.publish_delta(health)
        self._record_console()

    def _record_console(self, *, at_once: bool = False) -> None:
        with self._health.guard("console recorder"):
            self._console_recorder.record(at_once=at_once)

    def _save_checkpoint(self) -> None:
        with self._health.guard("checkpoint"):
            self._checkpoint_writer.begin(
                self._write_ahead.log_position, self._pipeline.checkpoint()
            )

    def _report_problems(self) -> None:
        """Log as events which parts fail, and which work again."""
        self._checkpoint_writer.check()
        seen = {
            "log": self._ports.log.problem,
            "disk": self._ports.log.low_disk_space,
            "store": self._ports.projection.problem(),
        }
        for report in list(self._health.check(seen, self._pipeline.state.problems)):
            log.warning("%s: %s", report.part, report.text or "works again")
            self._actions.perform(STATION_ID, report)

    def _finish(self) -> None:
        until_ns = self._ports.clock.monotonic_ns() + FINISH_NS
        with self._health.guard("drive"):
            while self._run_once() and self._ports.clock.monotonic_ns() < until_ns:
                pass
        self._project()
        self._save_checkpoint()
        self._checkpoint_writer.finish()
        self._actions.refuse_waiting()
        self._deliveries.refuse_waiting()
