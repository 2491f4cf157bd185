"""Runtime loop of one unit: source to pipeline to journal to link, until stopped.

One thread steps the pipeline, numbers the messages and takes commands, so that sequence numbers
rise in the order of the journal.  Reading the source, writing the journal and holding the link have
threads of their own: none of them blocks the others.
"""

from __future__ import annotations

import logging
from collections.abc import Iterable
from contextlib import ExitStack
from queue import Empty
from threading import Event

import msgspec

from edge.agent.agent_parts import AgentParts
from edge.agent.source_reader import TimedBatch
from edge.clocks.timeline import Timeline
from edge.fault_texts import program_error
from edge.sample_codec.codec import batch_of
from edge.samples import ACKNOWLEDGE, CANCEL, ButtonPress, SensorBatch
from shared.bus import ReplyHandler
from shared.channels import COMMAND, clock_key
from shared.clock import NS_PER_S
from shared.codec import decode
from shared.coded_text import coded
from shared.errors import RecordingError, WireError
from shared.messages import (
    Command,
    EventKind,
    Heartbeat,
    Message,
    UnitEvent,
)
from shared.messages.event import FAILED

logger = logging.getLogger(__name__)

_WAIT_S = 0.05
_HEARTBEAT_NS = NS_PER_S
_SILENT_NS = 2 * NS_PER_S
_CLOCK_TIMEOUT_S = 5.0
_COMPILED_S = 3.0  # of samples, after which all of the tracker's code has run once
_EARLY_NS = 10 * NS_PER_S  # after its start: a tracker that fails by then will fail again
_CALLS_NS = 30 * NS_PER_S  # after its start, for which the button works without the tracker


def _logged(messages: tuple[Message, ...]) -> tuple[Message, ...]:
    """Log the faults among the messages, for a person at the unit; return the messages."""
    for message in messages:
        if isinstance(message, UnitEvent) and message.kind is EventKind.SENSOR_FAULT:
            logger.info("%s: %s", message.kind.name, message.detail)
    return messages


class Agent:
    """Agent of one unit; ``run`` it once."""

    def __init__(self, parts: AgentParts) -> None:
        self._parts = parts
        self._timeline = Timeline()
        self._next_heartbeat_ns = 0
        self._last_batch_ns = 0
        self._started_ns = 0
        self._tracked_s = 0.0  # of the source's time
        self._is_ready = False
        self._failure: Exception | None = None  # of the tracker, soon after the start
        self._silence_reported = False
        self._storage_faults = ["", "", "", "", ""]
        self._time_query_failed = False
        self.commands_not_decoded = 0

    def run(self, stop: Event, *, for_s: float | None = None) -> None:
        """Run until the source ends, ``stop`` is set or ``for_s`` is over; report the reason at
        the end.

        Raises RecordingError, when everything is closed, where the source failed.
        """
        parts = self._parts
        self._started_ns = self._last_batch_ns = parts.clock.monotonic_ns()
        end_ns = None if for_s is None else self._started_ns + round(for_s * NS_PER_S)
        reason = FAILED
        try:
            self._put_own(_logged(parts.pipeline.start()))
            parts.reader.start()
            parts.wearer.start()
            if parts.start_check is not None:
                parts.start_check.start(parts.clock.monotonic_ns())
            while not stop.is_set() and not parts.reader.ended:
                if end_ns is not None and parts.clock.monotonic_ns() >= end_ns:
                    reason = "the time that was set is over"
                    return
                self._run_once()
            if stop.is_set():
                reason = "stopped by a signal"
            elif parts.reader.failure is None:
                reason = "the source ended"
        finally:
            self._shut_down(reason)
        if parts.reader.failure is not None:
            raise RecordingError(f"the source has failed: {parts.reader.failure}")

    def _run_once(self) -> None:
        timed = self._parts.reader.take(_WAIT_S)
        if timed is not None:
            self._take_batch(timed)
        self._take_commands()
        self._parts.outbox.put(self._parts.wearer.step())
        self._step_start_check()
        self._parts.clock.turn(self._ask_time)
        self._check_parts()
        self._notify_ready()
        if self._parts.clock.monotonic_ns() >= self._next_heartbeat_ns:
            self._send_heartbeat()

    def _notify_ready(self) -> None:
        """Report the end of the start to the service manager when the tracker is compiled, which
        may take longer than the watchdog allows.  A source without samples is not waited for.
        """
        if self._is_ready or not (self._tracked_s >= _COMPILED_S or self._is_over(_EARLY_NS)):
            return
        self._is_ready = True
        self._parts.manager.ready()

    def _take_batch(self, timed: TimedBatch) -> None:
        parts = self._parts
        presses = tuple(one for one in timed.batch.others if isinstance(one, ButtonPress))
        self._take_presses(presses, timed.timeline)  # first: the rest may fail
        raw = parts.raw.messages(timed.batch)
        parts.black_box.write(raw)
        self._timeline = timed.timeline
        if len(timed.batch.imu):
            self._last_batch_ns = parts.clock.monotonic_ns()
            self._silence_reported = False
        if parts.start_check is not None:
            parts.start_check.push(timed.batch)
        parts.pipeline.set_journal_pending(parts.journal.pending)
        self._step_pipeline(batch_of(raw), timed.timeline)
        self._tracked_s = timed.since_start_s
        down = any(
            outage.start_s <= timed.since_start_s < outage.start_s + outage.duration_s
            for outage in parts.source.radio_outages
        )
        parts.link.set_up(up=not down)

    def _step_pipeline(self, batch: SensorBatch, timeline: Timeline) -> None:
        """Step the pipeline.  A tracker that fails ends the agent, which is started again.  If it
        fails soon after the start, the button works on for a while, so that a mayday can be called.
        """
        parts = self._parts
        if self._failure is not None:
            return
        try:
            parts.outbox.put(_logged(parts.pipeline.step(batch, timeline)))
        except Exception as error:
            if self._is_over(_EARLY_NS):
                raise
            logger.exception("the tracker has failed at its start")
            self._failure = error
            self._send_event(
                EventKind.SENSOR_FAULT,
                coded(
                    "tracker-failed",
                    "the tracker has failed at its start ({error}): the button works, and the "
                    "agent is started again half a minute later",
                    error=program_error(error),
                ),
            )

    def _step_start_check(self) -> None:
        parts = self._parts
        if parts.start_check is None:
            return
        findings = parts.start_check.step(parts.clock.monotonic_ns())
        if findings is not None:
            parts.outbox.put((parts.pipeline.set_preflight(findings),))

    def _take_presses(self, presses: Iterable[ButtonPress], timeline: Timeline) -> None:
        """Send the messages of presses.  A cancellation without an active mayday counts as an
        acknowledgement.
        """
        parts = self._parts
        for press in presses:
            is_mayday_active = parts.pipeline.is_mayday_active
            self._put_own(parts.pipeline.take_presses((press,), timeline))
            parts.mayday_latch.set(is_active=parts.pipeline.is_mayday_active)
            if press.button == ACKNOWLEDGE or (press.button == CANCEL and not is_mayday_active):
                parts.outbox.put(parts.wearer.acknowledge())

    def _put_own(self, messages: tuple[Message, ...]) -> None:
        """Send messages among which a mayday may be."""
        self._parts.wearer.note_sent(messages)
        self._parts.outbox.put(messages)

    def _take_commands(self) -> None:
        parts = self._parts
        while True:
            try:
                payload = parts.commands.get_nowait()
                command = decode(COMMAND, payload)
            except Empty:
                return
            except WireError as error:
                self.commands_not_decoded += 1
                logger.warning("a command that cannot be understood: %s", error)
                continue
            assert isinstance(command, Command)
            parts.outbox.put((parts.wearer.take_command(command),))

    def _check_parts(self) -> None:
        """Detect parts that have stopped working, and report each once."""
        parts = self._parts
        if not parts.outbox.is_working:
            raise RuntimeError("the outbox has stopped; see the log before this")
        if not parts.journal_writer.is_working:
            raise RuntimeError("the journal has stopped; see the log before this")
        if not parts.link.is_working:
            raise RuntimeError("the link has stopped; see the log before this")
        if self._failure is not None and self._is_over(_CALLS_NS):
            raise self._failure
        self._report_storage_faults()
        for detail in (*parts.reader.take_faults(), *parts.wearer.take_faults()):
            self._send_event(EventKind.SENSOR_FAULT, detail)
        silent_ns = parts.clock.monotonic_ns() - self._last_batch_ns
        if parts.source.is_live and silent_ns > _SILENT_NS and not self._silence_reported:
            self._silence_reported = True
            self._send_event(
                EventKind.SENSOR_FAULT,
                coded(
                    "source-silent",
                    "the source has been silent for {silent_s:.0f} s",
                    silent_s=_SILENT_NS / NS_PER_S,
                ),
            )

    def _is_over(self, after_start_ns: int) -> bool:
        return self._parts.clock.monotonic_ns() - self._started_ns > after_start_ns

    def _report_storage_faults(self) -> None:
        """Report each fault of the storage separately, so that a lasting one hides no other."""
        parts = self._parts
        faults = [
            parts.journal.damage,
            parts.journal_writer.fault or "",
            parts.black_box.fault or "",
            parts.mayday_latch.fault,
            parts.wearer.fault,
        ]
        for fault, before in zip(faults, self._storage_faults, strict=True):
            if fault and not before:
                self._send_event(EventKind.STORAGE_FAULT, fault)
        self._storage_faults = faults

    def _send_heartbeat(self) -> None:
        parts = self._parts
        self._next_heartbeat_ns = parts.clock.monotonic_ns() + _HEARTBEAT_NS
        parts.manager.working()
        parts.steps.take(parts.pipeline.walked_step_scales)
        clock, journal = parts.clock.estimate(), parts.journal
        heartbeat = Heartbeat(
            parts.header_factory.header(),
            journal.first_seq,
            journal.last_seq,
            never_saved=parts.journal_writer.never_saved,
            given_up=journal.rows_evicted,
        )
        if clock is not None:
            heartbeat = msgspec.structs.replace(
                heartbeat,
                clock_ahead_s=parts.clock.machine_ahead_s(),
                clock_std_s=clock.std_s,
                clock_drift=clock.drift,
            )
        parts.outbox.put((heartbeat,))

    def _ask_time(self, on_reply: ReplyHandler) -> None:
        """Query the station for the time; a bus that fails is reopened by the link."""
        selector = clock_key(self._parts.header_factory.unit_id)
        try:
            self._parts.link.ask(selector, _CLOCK_TIMEOUT_S, on_reply)
        except Exception:
            if not self._time_query_failed:
                logger.exception("the station cannot be asked for the time")
            self._time_query_failed = True
        else:
            self._time_query_failed = False

    def _shut_down(self, reason: str) -> None:
        """Send the remaining messages, in order, and close everything."""
        parts = self._parts
        ended = parts.reader.ended
        with ExitStack() as last:  # each is closed, whatever the others do
            last.callback(parts.journal.close)
            last.callback(parts.link.close)
            last.callback(parts.black_box.close)
            last.callback(parts.journal_writer.close)
            last.callback(parts.outbox.close)
            last.callback(parts.mayday_latch.close)
            last.callback(parts.steps.close)
            last.callback(parts.wearer.close)
            parts.reader.close()
            self._take_presses(parts.reader.last_presses(), Timeline())
            parts.outbox.put(parts.pipeline.finish(self._timeline))
            parts.steps.take(parts.pipeline.walked_step_scales)
            if ended:
                self._send_event(
                    EventKind.SOURCE_ENDED, parts.reader.failure or "the source has no more"
                )
            self._send_event(EventKind.STOPPED, reason)

    def _send_event(self, kind: EventKind, detail: str) -> None:
        logger.info("%s: %s", kind.name, detail)
        self._parts.outbox.put((UnitEvent.of(self._parts.header_factory.header(), kind, detail),))
