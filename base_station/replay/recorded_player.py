"""Player of the recorded pictures of consoles: it decides nothing."""

from __future__ import annotations

import logging
from collections.abc import Iterator

import msgspec

from base_station.engine.console_recorder import KEYFRAME_NS
from base_station.engine.ports import LiveSink, Trails
from base_station.replay.console_recording import ConsoleRecording, Frame
from base_station.replay.playback import ReadLog
from base_station.replay.record_gaps import LONGEST_NS, RecordGap
from base_station.replay.recorded_picture import RecordedPicture
from base_station.storage.db.known_people import PersonLookup
from base_station.views.wire import ReplayView, Snapshot
from shared.clock import NS_PER_MS

BURST = 20  # frames

_log = logging.getLogger(__name__)


class RecordedPlayer:
    """Lost where the log has no recording of a time of which it has records."""

    def __init__(self, read: ReadLog, sink: LiveSink, people: PersonLookup) -> None:
        self._recording = ConsoleRecording(read)
        self._sink, self._people = sink, people
        self._seq = 0
        self._at_ns = 0
        self._begin(iter(()))

    def _begin(self, frames: Iterator[Frame]) -> None:
        self._frames = frames
        self._picture = RecordedPicture()
        self._shown_ns: int | None = None  # log time of the frame that is shown
        self._looked_ns: int | None = None  # of the frame behind which it was looked for a gap
        self._stretch: RecordGap | None = None  # the gap that was found
        self._is_unreadable = False
        self._next = self._following()

    @property
    def at_ns(self) -> int:
        return self._at_ns

    @property
    def is_lost(self) -> bool:
        if self._shown_ns is None or self._is_unreadable:
            return True
        return self._is_far and self._stretch is None

    @property
    def gap(self) -> RecordGap | None:
        stretch = self._stretch if self._is_far else None
        if stretch is None or self._at_ns <= stretch.from_ns:
            return None
        is_over = stretch.until_ns is not None and self._at_ns >= stretch.until_ns
        return None if is_over else stretch

    def seek(self, t_ns: int) -> Iterator[None]:
        is_near = self._shown_ns is not None and 0 <= t_ns - self._at_ns < KEYFRAME_NS
        if not is_near or self.is_lost:
            keyframe_ns = self._recording.keyframe_before(t_ns)
            self._begin(iter(()) if keyframe_ns is None else self._recording.frames(keyframe_ns))
        while self.advance(t_ns):
            yield

    def advance(self, t_ns: int) -> bool:
        for _ in range(BURST):
            if self._next is None or self._next.t_ns > t_ns or self._is_apart(self._next):
                break
            self._picture.apply(self._next)
            self._shown_ns = self._at_ns = self._next.t_ns
            self._next = self._following()
        else:
            return True
        self._at_ns = t_ns
        self._read_following_stretch()
        if self._next is None or self._next.t_ns > t_ns or self.is_lost:
            return False
        self._picture.apply(self._next)  # on the other side of a gap
        self._shown_ns = self._next.t_ns
        self._next = self._following()
        return True

    def reset(self, view: ReplayView) -> None:
        self._picture.note_shown()
        self._sink.reset(*self._picture.snapshot(self._seq, self._now_ms, self._people, view))

    def publish(self, view: ReplayView, *, whole: bool) -> None:
        if self._picture.is_new:
            self.reset(view)
            return
        if self._now_ms > self._picture.now_ms:
            self._picture.age()
        self._seq += 1
        self._sink.delta(
            self._picture.delta(self._seq, self._now_ms, self._people, view, whole=whole)
        )

    def snapshot(self, view: ReplayView) -> tuple[Snapshot, Trails]:
        self.publish(view, whole=False)
        return self._picture.snapshot(self._seq, self._now_ms, self._people, view)

    def _following(self) -> Frame | None:
        try:
            return next(self._frames, None)
        except msgspec.MsgspecError as error:
            _log.warning("what consoles were shown cannot be read, and is decided again: %s", error)
            self._is_unreadable = True
            return None

    @property
    def _now_ms(self) -> int:
        """In a gap it is as late as it stands."""
        return self._picture.now_ms if self.gap is None else self._at_ns // NS_PER_MS

    @property
    def _is_far(self) -> bool:
        """It stands far behind the frame that is shown."""
        return self._shown_ns is not None and self._at_ns - self._shown_ns > LONGEST_NS

    def _is_apart(self, frame: Frame) -> bool:
        return self._shown_ns is not None and frame.t_ns - self._shown_ns > LONGEST_NS

    def _read_following_stretch(self) -> None:
        """Once behind each frame from which it stands far away."""
        if self._shown_ns is None or not self._is_far or self._looked_ns == self._shown_ns:
            return
        self._looked_ns = self._shown_ns
        next_ns = None if self._next is None else self._next.t_ns
        self._stretch = self._recording.stretch_behind(self._shown_ns, next_ns)
