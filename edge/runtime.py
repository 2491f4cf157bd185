"""Runs one unit: source to pipeline to journal to link, until told to stop.

One thread steps the pipeline, stamps what is sent and takes commands, so sequence numbers
rise in the order of the journal.  Reading the source, writing the journal and holding the
link have threads of their own: none of them keeps the unit from the rest.
"""

from __future__ import annotations

import logging
from contextlib import ExitStack
from dataclasses import dataclass
from queue import Empty, SimpleQueue
from threading import Event

import msgspec

from edge.clocks.station import StationClock
from edge.clocks.timeline import Timeline
from edge.commands import CommandDesk
from edge.journal.spool import Spool
from edge.journal.writer import JournalWriter
from edge.link import Link
from edge.outbox import Outbox
from edge.pipeline import TrackerPipeline
from edge.raw.stream import RawStream, batch_of
from edge.recording.black_box import BlackBox
from edge.samples import ACKNOWLEDGE, ButtonPress
from edge.source_reader import PlacedBatch, SourceReader
from edge.sources.port import Source
from shared.bus import ReplyHandler
from shared.channels import COMMAND, clock_key
from shared.clock import NS_PER_S
from shared.codec import decode
from shared.envelope import Stamper
from shared.errors import RecordingError, WireError
from shared.messages import Command, EventKind, Heartbeat, UnitEvent
from shared.messages.event import FAILED
from shared.service_manager import ServiceManager

logger = logging.getLogger(__name__)

_TURN_S = 0.05
_HEARTBEAT_NS = NS_PER_S
_SILENT_NS = 2 * NS_PER_S
_CLOCK_TIMEOUT_S = 5.0


@dataclass(frozen=True, slots=True)
class Parts:
    """What an agent is made of; the composition root chooses each."""

    source: Source
    reader: SourceReader
    raw: RawStream
    pipeline: TrackerPipeline
    desk: CommandDesk
    stamper: Stamper
    clock: StationClock
    black_box: BlackBox
    spool: Spool
    journal: JournalWriter
    outbox: Outbox
    link: Link
    commands: SimpleQueue[bytes]  # filled by the link
    manager: ServiceManager


class Agent:
    """``run`` once."""

    def __init__(self, parts: Parts) -> None:
        self._parts = parts
        self._timeline = Timeline()
        self._next_heartbeat_ns = 0
        self._last_batch_ns = 0
        self._silence_told = False
        self._storage_faults = ["", "", ""]
        self._time_cannot_be_asked = False
        self.commands_not_understood = 0

    def run(self, stop: Event, *, for_s: float | None = None) -> None:
        """Until the source ends, ``stop`` is set or ``for_s`` is over; says why at the end.

        Raises RecordingError, when everything is closed, where the source failed.
        """
        parts = self._parts
        started_ns = self._last_batch_ns = parts.clock.monotonic_ns()
        end_ns = None if for_s is None else started_ns + round(for_s * NS_PER_S)
        reason = FAILED
        try:
            parts.outbox.put(parts.pipeline.start())
            parts.reader.start()
            parts.manager.ready()
            while not stop.is_set() and not parts.reader.ended:
                if end_ns is not None and parts.clock.monotonic_ns() >= end_ns:
                    reason = "the time that was set is over"
                    return
                self._turn()
            if stop.is_set():
                reason = "told to stop"
            elif parts.reader.failure is None:
                reason = "the source ended"
        finally:
            self._end(reason)
        if parts.reader.failure is not None:
            raise RecordingError(f"the source has failed: {parts.reader.failure}")

    def _turn(self) -> None:
        placed = self._parts.reader.take(_TURN_S)
        if placed is not None:
            self._take_batch(placed)
        self._take_commands()
        self._parts.clock.turn(self._ask_time)
        self._watch()
        if self._parts.clock.monotonic_ns() >= self._next_heartbeat_ns:
            self._beat()

    def _take_batch(self, placed: PlacedBatch) -> None:
        parts = self._parts
        raw = parts.raw.messages(placed.batch)
        parts.black_box.write(raw)
        self._timeline = placed.timeline
        if len(placed.batch.imu):
            self._last_batch_ns = parts.clock.monotonic_ns()
            self._silence_told = False
        parts.pipeline.note_journal(parts.spool.pending)
        batch = batch_of(raw)
        parts.outbox.put(parts.pipeline.step(batch, placed.timeline))
        if any(isinstance(one, ButtonPress) and one.button == ACKNOWLEDGE for one in batch.others):
            parts.outbox.put(parts.desk.acknowledge())
        down = any(
            outage.start_s <= placed.since_start_s < outage.start_s + outage.duration_s
            for outage in parts.source.radio_outages
        )
        parts.link.set_up(up=not down)

    def _take_commands(self) -> None:
        parts = self._parts
        while True:
            try:
                payload = parts.commands.get_nowait()
                command = decode(COMMAND, payload)
            except Empty:
                return
            except WireError as error:
                self.commands_not_understood += 1
                logger.warning("a command that cannot be understood: %s", error)
                continue
            assert isinstance(command, Command)
            parts.outbox.put((parts.desk.take(command),))

    def _watch(self) -> None:
        """Notice what has stopped working, and say so once."""
        parts = self._parts
        if not parts.outbox.is_working:
            raise RuntimeError("the outbox has stopped; see the log before this")
        if not parts.journal.is_working:
            raise RuntimeError("the journal has stopped; see the log before this")
        if not parts.link.is_working:
            raise RuntimeError("the link has stopped; see the log before this")
        self._tell_storage_faults()
        for detail in parts.reader.take_faults():
            self._say(EventKind.SENSOR_FAULT, detail)
        silent_ns = parts.clock.monotonic_ns() - self._last_batch_ns
        if parts.source.is_live and silent_ns > _SILENT_NS and not self._silence_told:
            self._silence_told = True
            self._say(EventKind.SENSOR_FAULT, "the source has been silent for 2 s")

    def _tell_storage_faults(self) -> None:
        """Each by itself: one that lasts hides none of the others."""
        parts = self._parts
        faults = [parts.spool.damage, parts.journal.fault or "", parts.black_box.fault or ""]
        for fault, before in zip(faults, self._storage_faults, strict=True):
            if fault and not before:
                self._say(EventKind.STORAGE_FAULT, fault)
        self._storage_faults = faults

    def _beat(self) -> None:
        parts = self._parts
        self._next_heartbeat_ns = parts.clock.monotonic_ns() + _HEARTBEAT_NS
        parts.manager.working()
        clock, spool = parts.clock.estimate(), parts.spool
        heartbeat = Heartbeat(
            parts.stamper.header(),
            spool.first_seq,
            spool.last_seq,
            never_saved=parts.journal.never_saved,
            given_up=spool.rows_freed,
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
        """A bus that fails ends nothing: the link opens it anew."""
        selector = clock_key(self._parts.stamper.unit_id)
        try:
            self._parts.link.ask(selector, _CLOCK_TIMEOUT_S, on_reply)
        except Exception:
            if not self._time_cannot_be_asked:
                logger.exception("the station cannot be asked for the time")
            self._time_cannot_be_asked = True
        else:
            self._time_cannot_be_asked = False

    def _end(self, reason: str) -> None:
        """Send what is left, in order, and let go of everything."""
        parts = self._parts
        ended = parts.reader.ended
        with ExitStack() as last:  # each is closed, whatever the others do
            last.callback(parts.spool.close)
            last.callback(parts.link.close)
            last.callback(parts.black_box.close)
            last.callback(parts.journal.close)
            last.callback(parts.outbox.close)
            parts.reader.close()
            parts.outbox.put(parts.pipeline.finish(self._timeline))
            if ended:
                self._say(EventKind.SOURCE_ENDED, parts.reader.failure or "the source has no more")
            self._say(EventKind.STOPPED, reason)

    def _say(self, kind: EventKind, detail: str) -> None:
        logger.info("%s: %s", kind.name, detail)
        self._parts.outbox.put((UnitEvent(self._parts.stamper.header(), kind, detail),))
