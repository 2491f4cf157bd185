"""The thread that runs the live station: feed, log, pipeline, and everybody who wants to know.

What arrives is written to the log first and stepped second.  Time (ticks) and people's actions
become log records like any other, so that the log alone gives the same run again.  Nothing in
here waits for the network, the store or a console.
"""

from __future__ import annotations

import logging
import threading
from collections import deque
from collections.abc import Callable, Iterable, Sequence
from concurrent.futures import Future
from dataclasses import dataclass
from typing import Protocol

import msgspec

from base_station import command_book
from base_station.api.wire import Snapshot
from base_station.backfill import Held, Report
from base_station.checkpoints import Checkpoints
from base_station.command_state import Order
from base_station.events import Output, Refused, StationEvent, event_of
from base_station.foxglove_topics import FoxgloveTopics
from base_station.picture import Picture
from base_station.pipeline import StationPipeline
from base_station.playback import is_decision
from base_station.projector import Projector
from base_station.self_watch import SelfWatch
from base_station.sinks import ActionDone, LiveSink, PhotoUrls, ProjectionSink
from base_station.views import StationFacts
from shared.channels import (
    OPERATOR,
    TICK,
    Channel,
    Direction,
    Qos,
    channel_of,
    is_backfilled,
    parse_key,
    tracked_unit,
)
from shared.clock import NS_PER_S, Clock
from shared.codec import decode, encode
from shared.envelope import Stamper
from shared.errors import StoreError, UnknownChannelError, WireError
from shared.messages import STATION_ID, AlarmChange, FusedPosition, OperatorAction, Tick
from shared.messages.station import Action, SendCommand

TICK_NS = NS_PER_S
DELTA_NS = NS_PER_S // 20
CHECKPOINT_NS = 30 * NS_PER_S  # what a restart steps at most; at 1,000 events/s some 2 s
STOP_TIMEOUT_S = 10.0

Record = tuple[int, str, bytes]  # station time, key, payload
log = logging.getLogger(__name__)


class Feed(Protocol):
    """Where records come from while the station is live."""

    def take(self, timeout_s: float) -> Sequence[Record]:
        """What came since, in order; waits for something to come or for ``wake``."""
        ...

    def wake(self) -> None:
        """From any thread: end the wait of ``take``."""
        ...


class Log(Protocol):
    """Where records are kept; never waits long and never raises for a disk that fails."""

    @property
    def problem(self) -> str:
        """Why records are not kept, as a sentence for a person; empty: they are."""
        ...

    @property
    def is_behind(self) -> bool:
        """Whether records of a second ago may not be on the disk yet."""
        ...

    def write(self, t_ns: int, key: str, payload: bytes) -> bool:
        """Keep a record, soon on the disk; False: it is lost."""
        ...

    def flush(self) -> bool:
        """Bring to the disk what was written so far; whether that was done in time."""
        ...


@dataclass(frozen=True)
class Surroundings:
    """What the drive works with."""

    feed: Feed
    log: Log
    live: LiveSink
    projection: ProjectionSink
    checkpoints: Checkpoints
    photo_urls: PhotoUrls
    facts: Callable[[], StationFacts]  # asked once a second; messages a second are filled in
    report: Callable[[Report], None]  # hears once a second what is there of each linked unit
    say: Callable[[Sequence[Order]], None]  # hears what no unit has answered
    clock: Clock
    boot_id: int


@dataclass
class _Due:
    """Monotonic times at which something is to be done next."""

    tick_ns: int
    delta_ns: int
    checkpoint_ns: int


class StationDrive:
    """``OperatorGate`` and ``LiveSource`` of the live station."""

    def __init__(self, pipeline: StationPipeline, surroundings: Surroundings) -> None:
        self._pipeline = pipeline
        self._around = surroundings
        self._stamper = Stamper(STATION_ID, surroundings.boot_id, surroundings.clock)
        self._picture = Picture(pipeline, surroundings.live, surroundings.photo_urls)
        self._projector = Projector()
        self._foxglove = FoxgloveTopics()
        self._inbox: deque[tuple[str, Action, Future[ActionDone]]] = deque()
        self._asked: deque[Callable[[Snapshot], None]] = deque()
        self._stopping = threading.Event()
        self._thread = threading.Thread(target=self._run, name="station-drive")
        now_ns = surroundings.clock.monotonic_ns()
        self._due = _Due(now_ns, now_ns, now_ns + CHECKPOINT_NS)
        self._events_at_t = 0  # stepped at the pipeline's present time
        self._messages_before = 0
        self._health_due = False  # consoles hear of the station's health with the next delta
        self._urgent = False  # something was written that must be on the disk before it is told
        self._watch = SelfWatch()
        self._failed: dict[str, str] = {}  # parts that failed since the last tick, and how

    # ---- from any thread

    def start(self) -> None:
        self._thread.start()

    def stop(self) -> None:
        """Finish what was taken, and end."""
        self._stopping.set()
        self._around.feed.wake()
        self._thread.join(STOP_TIMEOUT_S)

    def submit(self, by: str, action: Action) -> Future[ActionDone]:
        future: Future[ActionDone] = Future()
        self._inbox.append((by, action, future))
        self._around.feed.wake()
        if self._stopping.is_set() and not self._thread.is_alive():
            self._refuse_waiting()
        return future

    def request_snapshot(self, deliver: Callable[[Snapshot], None]) -> None:
        self._asked.append(deliver)
        self._around.feed.wake()

    # ---- before the thread runs

    def rebuild(self, records: Iterable[Record], after: tuple[int, int] = (0, 0)) -> int:
        """Step what a log says happened; gives the number of events stepped.

        ``after`` is the place (time, events at that time) of the checkpoint with which the
        pipeline was made.  Decisions that a crash kept from the log are written to it now.
        """
        from_ns, skip = after
        self._events_at_t = skip
        unlogged: list[FusedPosition | AlarmChange] = []
        told = False  # whether the log has a decision that followed the last event
        stepped = 0
        for t_ns, key, payload in records:
            if is_decision(key):
                del unlogged[:1]
                told = True
                continue
            if t_ns == from_ns and skip > 0:
                skip -= 1
                continue
            stepped += 1
            if told:
                unlogged.clear()
                told = False
            outputs = self._step(event_of(t_ns, key, payload))
            unlogged += [o for o in outputs if isinstance(o, FusedPosition | AlarmChange)]
        for output in unlogged:
            self._keep_output(output)
        self._settle()
        return stepped

    # ---- in the thread

    def _run(self) -> None:
        while not self._stopping.is_set():
            self._guarded("drive", self._turn)
        self._finish()

    def _turn(self) -> None:
        """Take what came, then do whatever is due."""
        clock, due = self._around.clock, self._due
        wait_ns = min(due.tick_ns, due.delta_ns) - clock.monotonic_ns()
        for t_ns, key, payload in self._around.feed.take(max(wait_ns, 0) / NS_PER_S):
            self._hear(t_ns, key, payload)
        self._take_actions()
        now_ns = clock.monotonic_ns()
        if now_ns >= due.tick_ns:
            due.tick_ns = max(due.tick_ns + TICK_NS, now_ns)
            self._tick()
        if now_ns >= due.checkpoint_ns:
            due.checkpoint_ns = now_ns + CHECKPOINT_NS
            self._save_checkpoint()
        self._settle()
        if now_ns >= due.delta_ns:
            due.delta_ns = now_ns + DELTA_NS
            self._tell()
        while self._asked:
            self._asked.popleft()(self._picture.snapshot())

    def _hear(self, t_ns: int, key: str, payload: bytes) -> None:
        """A record from the bus."""
        try:
            channel = parse_key(key)[1]
        except UnknownChannelError:
            channel = None  # kept, counted and shown as what could not be read
        if channel is not None and not channel.logged:
            return
        if channel is not None and channel.direction is Direction.STATION:
            self._failed["bus"] = f"Somebody on the bus speaks as the station ({key}): not believed"
            return
        if channel is not None and is_backfilled(key) and self._is_kept(key, channel, payload):
            return
        self._urgent = self._urgent or (channel is not None and channel.qos is Qos.ALERT)
        self._keep_and_step(t_ns, key, payload)

    def _is_kept(self, key: str, channel: Channel, payload: bytes) -> bool:
        """Whether what was fetched came live after all, while it was asked for."""
        try:
            message = decode(channel, payload)
        except WireError:
            return False  # kept, counted and shown as what could not be read
        unit_id = parse_key(key)[0]
        tracked = tracked_unit(unit_id)
        unit = self._pipeline.state.units.get(tracked or unit_id)
        sender = unit if unit is None or tracked is None else unit.tracker
        return sender is not None and sender.has(message.header)

    def _take_actions(self) -> None:
        while self._inbox:
            by, action, future = self._inbox.popleft()
            done = self._do(by, action)
            self._settle()
            if isinstance(action, SendCommand):
                self._around.say(command_book.unanswered(self._pipeline.state))
            if future.set_running_or_notify_cancel():
                future.set_result(done)

    def _do(self, by: str, action: Action) -> ActionDone:
        header = self._stamper.header()
        action_id = f"{header.boot_id:016x}-{header.seq}"
        message = OperatorAction(header, action_id, by, action)
        self._urgent = True
        outputs = self._keep_and_step(header.t_utc_ns, OPERATOR.key(STATION_ID), encode(message))
        refused = next((output for output in outputs if isinstance(output, Refused)), None)
        return ActionDone(action_id, self._pipeline.state.t_ns, refused)

    def _tick(self) -> None:
        header = self._stamper.header()
        t_ns = max(header.t_utc_ns, self._pipeline.state.t_ns)
        self._keep_and_step(t_ns, TICK.key(STATION_ID), encode(Tick(header, t_ns)))
        self._report_problems()
        if not self._around.log.is_behind:  # what is reported may be acknowledged to its unit
            self._around.report(self._held())
        self._around.say(command_book.unanswered(self._pipeline.state))
        messages = self._pipeline.state.counts.messages
        self._picture.facts = msgspec.structs.replace(
            self._around.facts(), messages_per_s=float(messages - self._messages_before)
        )
        self._messages_before = messages
        self._health_due = True

    def _keep_and_step(self, t_ns: int, key: str, payload: bytes) -> list[Output]:
        """Station time never goes back, whatever the machine's clock does."""
        t_ns = max(t_ns, self._pipeline.state.t_ns)
        self._around.log.write(t_ns, key, payload)
        outputs = self._step(event_of(t_ns, key, payload))
        for output in outputs:
            if isinstance(output, FusedPosition | AlarmChange):
                self._keep_output(output)
        return outputs

    def _step(self, event: StationEvent) -> list[Output]:
        same_time = event.t_ns == self._pipeline.state.t_ns
        self._events_at_t = self._events_at_t + 1 if same_time else 1
        outputs: list[Output] = []
        self._guarded("pipeline", lambda: outputs.extend(self._pipeline.step(event)))
        self._picture.note(outputs)
        self._projector.note(event, outputs)
        return outputs

    def _keep_output(self, output: FusedPosition | AlarmChange) -> None:
        self._urgent = self._urgent or isinstance(output, AlarmChange)
        t_ns = output.header.t_utc_ns
        self._around.log.write(t_ns, channel_of(output).key(STATION_ID), encode(output))
        shown = self._foxglove.of(output, self._pipeline.state.anchor)
        if shown is not None:
            self._around.log.write(t_ns, *shown)

    def _settle(self) -> None:
        """What is urgent reaches the disk before anybody hears of it."""
        if self._urgent:
            self._urgent = False
            self._around.log.flush()
        self._project()

    def _project(self) -> None:
        projection = self._projector.take(self._pipeline.state.t_ns)
        if projection is not None:
            self._around.projection.project(projection)

    def _tell(self) -> None:
        health, self._health_due = self._health_due, False
        self._picture.flush(health)

    def _save_checkpoint(self) -> None:
        if not self._around.log.flush():
            return  # it must not know what a crash would take from the log
        try:
            self._around.checkpoints.save(
                self._pipeline.state.t_ns, self._events_at_t, self._pipeline.checkpoint()
            )
        except OSError as error:
            self._failed["checkpoint"] = f"The live state cannot be saved ({error}): free the disk"

    def _report_problems(self) -> None:
        """A part that fails, or is well again, is an event like any other."""
        now = {"log": self._around.log.problem, "store": self._around.projection.problem()}
        now |= self._failed
        self._failed = {}
        for report in list(self._watch.check(now, self._pipeline.state.problems)):
            log.warning("%s: %s", report.part, report.text or "works again")
            self._do(STATION_ID, report)

    def _held(self) -> Report:
        state = self._pipeline.state
        return {
            sender.unit_id: tuple(
                Held(boot.boot_id, tuple(boot.seen.runs())) for boot in sender.boots
            )
            for unit in state.units.values()
            if unit.registered
            for sender in (unit, unit.tracker)
            if sender is not None and sender.link_at(state.t_ns) == "live"
        }

    def _guarded(self, part: str, function: Callable[[], None]) -> None:
        """A mistake in one event's handling must not end the station."""
        try:
            function()
        except Exception as error:
            log.exception("the station's %s failed", part)
            self._failed[part] = f"The station's {part} failed: {error!r}; please report it"

    def _finish(self) -> None:
        self._guarded("drive", self._turn)
        self._save_checkpoint()
        self._refuse_waiting()

    def _refuse_waiting(self) -> None:
        while self._inbox:
            future = self._inbox.popleft()[2]
            future.set_exception(StoreError("the station is stopping; do it again when it runs"))
