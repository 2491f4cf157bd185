"""A replay in a process of its own: commands come on its line, pictures for consoles go back."""

from __future__ import annotations

import threading

import msgspec

from base_station.engine.ports import Trails
from base_station.replay.playback import Archive
from base_station.replay.processes.frame_channel import FrameChannel
from base_station.replay.processes.jobs import ReplayJob
from base_station.replay.processes.wire import (
    Command,
    DeltaFrame,
    Pause,
    People,
    Play,
    Seek,
    SetSpeed,
    SnapshotFrame,
    SnapshotRequest,
    ViewFrame,
    read_command,
)
from base_station.replay.session import ReplaySession, ReplayWindow
from base_station.storage.db.known_people import KnownPerson, person_lookup
from base_station.views.changes import UnitChanges
from base_station.views.wire import Delta, Snapshot
from shared.clock import Clock
from shared.errors import StoreError


def replay(job: ReplayJob, archive: Archive, clock: Clock, line: FrameChannel) -> None:
    """Until the line is closed, or the replay breaks off."""
    window = ReplayWindow(job.incident_id, job.start_ns, job.end_ns)
    work = _ReplayWork(line)
    session = ReplaySession(archive, window, job.speed, work, work.person, clock)
    work.begin(session)
    while (encoded := line.receive()) is not None:
        work.follow(read_command(encoded))
    session.close()


class _ReplayWork:
    """The replay's ``LiveSink``, and who moves it."""

    def __init__(self, line: FrameChannel) -> None:
        self._line = line
        self._encoder = msgspec.json.Encoder()
        self._changes = UnitChanges()
        self._known: dict[str, KnownPerson] = {}
        self._commands = 0
        self._begun = threading.Event()
        self._session: ReplaySession

    def begin(self, session: ReplaySession) -> None:
        self._session = session
        self._begun.set()
        threading.Thread(target=self._watch, name="replay-watch", daemon=True).start()

    def follow(self, command: Command) -> None:
        session = self._session
        match command:
            case Play():
                session.play()
            case Pause():
                session.pause()
            case Seek(t_ns):
                session.seek(t_ns)
            case SetSpeed(speed):
                session.set_speed(speed)
            case People(known):
                self._known = known
            case SnapshotRequest():
                session.request_snapshot(self._deliver)
        self._commands += 1

    # ---- in the replay's thread

    def person(self, person_id: str) -> KnownPerson:
        return person_lookup(self._known)(person_id)

    def delta(self, delta: Delta) -> None:
        self._send_view()
        whole, changes = map(self._encoder.encode, (delta, self._changes.of(delta)))
        self._send(DeltaFrame(whole, changes, tuple(delta.trails)))

    def reset(self, snapshot: Snapshot, trails: Trails) -> None:
        self._show(snapshot, trails, requested=False)

    def _deliver(self, snapshot: Snapshot, trails: Trails) -> None:
        self._show(snapshot, trails, requested=True)

    def _show(self, snapshot: Snapshot, trails: Trails, *, requested: bool) -> None:
        self._send_view()
        self._changes.note_snapshot(snapshot)
        points = {unit_id: bytes(raw) for unit_id, raw in trails.items()}
        self._send(SnapshotFrame(self._encoder.encode(snapshot), points, requested))

    def _send_view(self) -> None:
        """Sends the state as it is after the commands that are counted."""
        self._begun.wait()
        commands = self._commands
        self._send(ViewFrame(self._session.view(), commands))

    def _send(self, frame: DeltaFrame | SnapshotFrame | ViewFrame) -> None:
        try:
            self._line.send(frame)
        except StoreError:  # no console is connected any more: the reader of commands ends, too
            self._session.end()

    def _watch(self) -> None:
        """A replay that breaks off takes its process along."""
        self._session.wait_until_over()
        self._line.hang_up()
