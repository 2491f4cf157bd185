"""A replay that runs in a process of its own, as the console's API sees it."""

from __future__ import annotations

import logging
import threading
from collections import deque
from collections.abc import Callable, Iterable, Mapping
from contextlib import suppress
from dataclasses import dataclass
from typing import Protocol

import msgspec

from base_station.core.pipeline import StationPipeline
from base_station.engine.console_publisher import ConsolePublisher
from base_station.engine.ports import LiveSink, Trails
from base_station.replay.processes.frame_channel import FrameChannel
from base_station.replay.processes.jobs import ArchivedLog, ReplayJob
from base_station.replay.processes.server import ReplayProcesses
from base_station.replay.processes.wire import (
    Command,
    Damage,
    DeltaFrame,
    Pause,
    People,
    Play,
    ReplayReport,
    Seek,
    SetSpeed,
    SnapshotFrame,
    SnapshotRequest,
    ViewFrame,
    read_replay,
)
from base_station.replay.session import GRACE_S, PAUSED_S, ReplayWindow, checked_speed
from base_station.storage.db.known_people import KnownPerson, person_lookup
from base_station.storage.missing_segments import KnownSegment
from base_station.views.recorded import read_snapshot
from base_station.views.wire import ReplayView, Snapshot
from shared.clock import NS_PER_MS
from shared.errors import StoreError

_LOOK_S = 0.1  # while the process is not there yet
_log = logging.getLogger(__name__)


class EncodedSink(LiveSink, Protocol):
    """A ``LiveSink`` that also takes encoded messages (``base_station.api.hub.Hub``)."""

    def broadcast_delta(self, whole: bytes, changes: bytes, redrawn: tuple[str, ...]) -> None: ...

    def broadcast_reset(self, message: bytes, trails: Trails) -> None: ...


@dataclass(frozen=True)
class ReplayContext:
    """Parts of the station that a replay needs."""

    processes: ReplayProcesses
    log: str
    checkpoints: str
    prepare: Callable[[], object]  # brings recorded data to the disk
    note_damage: Callable[[str], None]  # of the log
    people: Callable[[], Mapping[str, KnownPerson]]  # by id
    empty_pipeline: Callable[[], StationPipeline]
    known_segments: Callable[[], Iterable[KnownSegment]] = tuple  # of the log, by the database


class ReplayProcess:
    """A ``ReplayPlayer``: commands go to the process, pictures for consoles come from it.

    Until it is loaded, consoles see that the replay is on its way.
    """

    def __init__(
        self,
        place: ReplayContext,
        window: ReplayWindow,
        speed: float,
        sink: EncodedSink,
        archived: ArchivedLog | None = None,
    ) -> None:
        """It plays from the window's beginning; ``archived``: the copy in the place of the log.
        Raises UserError for an impossible speed.

        Disk and process are left to a thread: the caller does not wait.
        """
        self._place, self._window, self._sink = place, window, sink
        self._archived = archived
        self._lock = threading.Lock()  # guards the fields below
        self._line: FrameChannel | None = None  # to the process, as soon as that is there
        self._unsent: list[Command] = []
        self._commands = 0  # given so far
        self._view = _first_view(window, checked_speed(speed))
        self._asked: deque[Callable[[Snapshot, Trails], None]] = deque()
        self._people: Mapping[str, KnownPerson] = {}  # as the process knows them
        self._is_shown = False  # pictures of the process are shown
        self._closed = threading.Event()
        self._over = threading.Event()
        self._thread = threading.Thread(target=self._run, name="replay", daemon=True)
        self._thread.start()

    # ---- from any thread

    def play(self) -> None:
        """At the end it begins again."""
        with self._lock:
            at_end = self._view.at_ms >= self._view.end_ms
            at_ms = self._view.start_ms if at_end else self._view.at_ms
            self._give(Play(), playing=True, at_ms=at_ms)

    def pause(self) -> None:
        with self._lock:
            self._give(Pause(), playing=False)

    def seek(self, t_ns: int) -> None:
        with self._lock:
            self._give(Seek(t_ns), at_ms=self._window.place_of(t_ns) // NS_PER_MS)

    def set_speed(self, speed: float) -> None:
        """Raises UserError for an impossible speed."""
        with self._lock:
            self._give(SetSpeed(checked_speed(speed)), speed=speed)

    def view(self) -> ReplayView:
        with self._lock:
            return self._view

    def request_snapshot(self, deliver: Callable[[Snapshot, Trails], None]) -> None:
        with self._lock:
            self._asked.append(deliver)
            if self._is_shown:
                self._ask()

    @property
    def is_over(self) -> bool:
        return self._over.is_set()

    def close(self) -> None:
        self._closed.set()
        with self._lock:
            if self._line is not None:
                self._line.hang_up()
        self._thread.join(GRACE_S)

    def _give(self, command: Command, **changes: object) -> None:
        """Send a command.  The view changes at once; older views of the process are left out."""
        self._view = msgspec.structs.replace(self._view, **changes)
        self._commands += 1
        if self._line is None:
            self._unsent.append(command)
        else:
            self._send(command)

    def _ask(self) -> None:
        people = dict(self._place.people())
        if people != self._people:
            self._people = people
            self._commands += 1
            self._send(People(people))
        self._commands += 1
        self._send(SnapshotRequest())

    def _send(self, command: Command) -> None:
        assert self._line is not None
        with suppress(StoreError):  # the thread finds that it is over, and logs it
            self._line.send(command)

    # ---- in the thread

    def _run(self) -> None:
        try:
            line = self._begin()
            if line is not None:
                self._follow(line)
                line.close()
        except Exception:  # noqa: BLE001  # consoles get no more, and the end is logged
            _log.exception("the replay of %s broke off", self._window.incident_id)
        if not self._closed.is_set():
            _log.error(
                "the replay of %s broke off: its process has ended; it can be begun again",
                self._window.incident_id,
            )
        self._over.set()

    def _begin(self) -> FrameChannel | None:
        self._place.prepare()
        window = self._window
        job = ReplayJob(
            log=self._place.log,
            checkpoints=self._place.checkpoints,
            incident_id=window.incident_id,
            start_ns=window.start_ns,
            end_ns=window.end_ns,
            speed=self.view().speed,
            known_segments=tuple(self._place.known_segments()),
            archived=self._archived,
        )
        line = self._place.processes.start(job)
        with self._lock:
            self._line = line
            self._people = dict(self._place.people())
            self._commands += 1
            for command in (People(dict(self._people)), *self._unsent):
                self._send(command)
            if self._closed.is_set():
                line.close()
                return None
        return line

    def _follow(self, line: FrameChannel) -> None:
        people = person_lookup(self._people)
        publisher = ConsolePublisher(self._place.empty_pipeline(), self._sink, people)
        waited_s = 0.0
        while not self._is_shown:
            if not line.has_message(_LOOK_S):
                waited_s += _LOOK_S
                self._publish_loading(publisher, is_due=waited_s < PAUSED_S)
                waited_s %= PAUSED_S
            elif not self._take_next(line):
                return
        with self._lock:
            if self._asked:
                self._ask()
        while self._take_next(line):
            pass

    def _publish_loading(self, publisher: ConsolePublisher, *, is_due: bool) -> None:
        """Show consoles that the replay is alive."""
        view = self.view()
        if not is_due:
            publisher.publish_delta(replay=view)
        while self._asked:
            self._asked.popleft()(*publisher.snapshot(view))

    def _take_next(self, line: FrameChannel) -> bool:
        encoded = line.receive()
        if encoded is None or self._closed.is_set():
            return False
        self._take(read_replay(encoded))
        return True

    def _take(self, report: ReplayReport) -> None:
        match report:
            case ViewFrame(view, commands):
                with self._lock:
                    if commands >= self._commands:
                        self._view = view
            case DeltaFrame(whole, changes, redrawn):
                self._sink.broadcast_delta(whole, changes, redrawn)
            case SnapshotFrame(encoded, trails, requested):
                points = {unit_id: msgspec.Raw(raw) for unit_id, raw in trails.items()}
                self._show(encoded, points, requested=requested)
            case Damage(what):
                self._place.note_damage(what)

    def _show(self, encoded: bytes, trails: Trails, *, requested: bool) -> None:
        self._is_shown = True
        if not requested:
            self._sink.broadcast_reset(encoded, trails)
            return
        with self._lock:
            asked, self._asked = self._asked, deque()
        snapshot = read_snapshot(encoded)
        for deliver in asked:
            deliver(snapshot, trails)


def _first_view(window: ReplayWindow, speed: float) -> ReplayView:
    return ReplayView(
        incident_id=window.incident_id,
        start_ms=window.start_ns // NS_PER_MS,
        end_ms=window.end_ns // NS_PER_MS,
        at_ms=window.start_ns // NS_PER_MS,
        speed=speed,
        playing=True,
        seeking=True,  # until the process shows its beginning
    )
