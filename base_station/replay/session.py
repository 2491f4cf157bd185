"""A past incident in a console, as it was: play, pause, seek, speed."""

from __future__ import annotations

import logging
import math
import threading
from collections import deque
from collections.abc import Callable, Iterator
from dataclasses import dataclass

from base_station.engine.ports import LiveSink, Trails
from base_station.replay.incident_sink import IncidentSink
from base_station.replay.playback import Archive
from base_station.replay.player import Player
from base_station.replay.recomputed_player import RecomputedPlayer
from base_station.replay.record_gaps import RecordGap
from base_station.replay.recorded_player import RecordedPlayer
from base_station.replay.version_check import DIFFERS, VersionCheck
from base_station.storage.db.known_people import PersonLookup
from base_station.views.text_code import coded_views
from base_station.views.wire import GapView, ReplayView, Snapshot
from shared.clock import NS_PER_MS, NS_PER_S, Clock
from shared.coded_text import coded, text_of_error
from shared.errors import ArchiveError, UserError
from shared.log_on_change import LogOnChange

SLOWEST, FASTEST = 0.25, 1000.0  # times real time; the fastest is as fast as this machine goes
DELTA_S = 0.05
CHECK_NS = 20 * NS_PER_MS  # of each turn, for the check of the log for flaws
WHOLE_NS = NS_PER_S  # live, consoles receive the station's health and backfilled trails as often
GRACE_S = 2.0  # for its thread to end
PAUSED_S = 1.0  # a console without messages for longer treats its link as lost
MOST_FLAWS = 20  # that are published: with every change

_log = logging.getLogger(__name__)


@dataclass(frozen=True)
class ReplayWindow:
    """Window of a replay, in station time."""

    incident_id: str
    start_ns: int
    end_ns: int

    def place_of(self, t_ns: int) -> int:
        """Times before the beginning give the beginning; the last millisecond and later times give
        the end, for a console knows it to a millisecond.
        """
        is_end = t_ns // NS_PER_MS >= self.end_ns // NS_PER_MS
        return self.end_ns if is_end else max(t_ns, self.start_ns)


class ReplaySession:
    """One replay with its thread; a ``LiveSource``.  Methods may be called from any thread."""

    def __init__(
        self,
        archive: Archive,
        window: ReplayWindow,
        speed: float,
        sink: LiveSink,
        people: PersonLookup,
        clock: Clock,
    ) -> None:
        """It plays from the window's beginning.  Raises UserError for an impossible speed.

        The disk is left to the thread: while it hangs, the caller does not wait.
        """
        self._window = window
        self._clock = clock
        self._archive = archive
        self._was_changed: Callable[[], bool]
        self._checking = LogOnChange(_log, "what the log lacks cannot be seen")
        self._trouble = LogOnChange(_log, "whether the past was changed cannot be seen")
        self._sink, self._people = IncidentSink(sink, window.incident_id), people
        self._player: Player  # that is shown
        self._recorded: RecordedPlayer | None  # of the recorded pictures of consoles
        self._recomputed: RecomputedPlayer | None  # once it is needed
        self._version_check: VersionCheck | None = None  # until something was decided again
        self._looked_ns = self._whole_ns = clock.monotonic_ns()
        self._is_behind = False  # playback is limited by the speed of reading
        self._is_shown = False  # a picture
        self._asked: deque[Callable[[Snapshot, Trails], None]] = deque()
        self._lock = threading.Lock()  # guards the fields below
        self._speed = checked_speed(speed)
        self._playing = True
        self._at_ns = window.start_ns
        self._seek_ns: int | None = window.start_ns
        self._seeking = False
        self._gap: RecordGap | None = None  # in which it stands
        self._away = ""  # reason why the archive does not give the data
        self._moved_ns = clock.monotonic_ns()  # until when time has gone by for the picture
        self._news = threading.Event()
        self._closed = threading.Event()
        self._thread = threading.Thread(target=self._run, name="replay", daemon=True)
        self._thread.start()

    # ---- from any thread

    def play(self) -> None:
        """At the end it begins again."""
        with self._lock:
            if self._at_ns >= self._window.end_ns:
                self._seek_ns = self._window.start_ns
            if not self._playing:
                self._moved_ns = self._clock.monotonic_ns()
            if self._away and self._seek_ns is None:
                self._seek_ns = self._at_ns  # the seek is repeated
            self._playing = True
        self._news.set()

    def pause(self) -> None:
        with self._lock:
            self._playing = False
        self._news.set()

    def seek(self, t_ns: int) -> None:
        with self._lock:
            self._seek_ns = self._at_ns = self._window.place_of(t_ns)
        self._news.set()

    def set_speed(self, speed: float) -> None:
        """Raises UserError for an impossible speed."""
        with self._lock:
            self._speed = checked_speed(speed)
        self._news.set()

    def view(self) -> ReplayView:
        with self._lock:
            flaws = self._flaws()
            return ReplayView(
                incident_id=self._window.incident_id,
                start_ms=self._window.start_ns // NS_PER_MS,
                end_ms=self._window.end_ns // NS_PER_MS,
                at_ms=self._at_ns // NS_PER_MS,
                speed=self._speed,
                playing=self._playing,
                seeking=self._seeking,
                flaws=tuple(map(str, flaws)),
                flaw_codes=coded_views(flaws),
                gap=None if self._gap is None else self._gap_view(self._gap),
            )

    def _gap_view(self, gap: RecordGap) -> GapView:
        """As far as it is in the window."""
        start_ns, end_ns = self._window.start_ns, self._window.end_ns
        until_ns = end_ns if gap.until_ns is None else gap.until_ns
        return GapView(
            from_ms=max(gap.from_ns, start_ns) // NS_PER_MS,
            until_ms=min(until_ns, end_ns) // NS_PER_MS,
        )

    def _flaws(self) -> tuple[str, ...]:
        flaws = (*filter(None, (self._away,)), *self._archive.flaws())
        more = len(flaws) - MOST_FLAWS
        if more <= 0:
            return flaws
        rest = coded("flaws-more", "and {count} more, which the terminal names", count=more)
        return (*flaws[:MOST_FLAWS], rest)

    def request_snapshot(self, deliver: Callable[[Snapshot, Trails], None]) -> None:
        self._asked.append(deliver)
        self._news.set()

    @property
    def is_over(self) -> bool:
        return self._closed.is_set()

    def wait_until_over(self) -> None:
        self._closed.wait()

    def end(self) -> None:
        """Its thread ends soon; one that waits for a disk that hangs, when that answers."""
        self._closed.set()
        self._news.set()

    def close(self) -> None:
        self.end()
        self._thread.join(GRACE_S)

    # ---- in the thread

    def _run(self) -> None:
        try:
            self._play()
        except Exception:  # noqa: BLE001  # consoles get no more, and the end is logged
            _log.exception("the replay of %s broke off", self._window.incident_id)
            self._closed.set()

    def _play(self) -> None:
        self._open()
        while not self._closed.is_set():
            self._follow_changes()
            try:
                self._follow_seek()
                if self._closed.is_set():
                    return  # amid a seek the picture is not that of where it has got to
                self._move()
            except ArchiveError as error:
                self._stop_for_archive(error)
            if self._seek_ns is not None:
                continue  # a picture now would be of another time than asked for
            self._answer()
            has_more = self._check_log()
            if not self._is_behind:
                self._news.wait(DELTA_S if self._playing or has_more else PAUSED_S)
            self._news.clear()

    def _stop_for_archive(self, error: ArchiveError) -> None:
        """Pause until a user plays or seeks.  Raises the error where nothing was shown yet."""
        if not self._is_shown:
            raise error
        _log.warning("the replay of %s stands still: %s", self._window.incident_id, error)
        shown = self._player
        self._open()  # a reader that failed would take the place of its failure for the end
        self._player = shown
        with self._lock:
            self._away, self._playing, self._seeking = text_of_error(error), False, False
        self._publish()

    def _check_log(self) -> bool:
        """Check the log for ``CHECK_NS`` at most; True if there is more to check.

        A seek passes over most of the log: playing alone would not find all of its flaws.
        """
        until_ns = self._clock.monotonic_ns() + CHECK_NS
        has_more = True
        with self._checking:
            while has_more and self._clock.monotonic_ns() < until_ns:
                has_more = self._checks_version() or self._archive.check_next_chunk()
        return has_more

    def _checks_version(self) -> bool:
        """Check one more record; False: the check is over, or too much is missing for it."""
        if self._recomputed is None:
            return False  # the decisions of that time are played
        if self._version_check is None:
            self._archive.check_next_chunk()  # its first call checks the list of files
            self._version_check = self._recomputed.version_check(self._window.end_ns)
        differs = None if self._archive.flaws() else self._version_check.check_next_record()
        if differs:
            self._archive.note(DIFFERS)
        return differs is False

    def _open(self) -> None:
        """The log as it is now, from its beginning."""
        self._was_changed = self._archive.watch()
        self._recomputed = self._version_check = None
        read = self._archive.console
        self._recorded = None if read is None else RecordedPlayer(read, self._sink, self._people)
        self._player = self._recorded or self._recomputing_player()

    def _recomputing_player(self) -> RecomputedPlayer:
        if self._recomputed is None:
            self._recomputed = RecomputedPlayer(self._archive, self._sink, self._people)
        return self._recomputed

    def _players(self) -> Iterator[Player]:
        if self._recorded is not None:
            yield self._recorded
        yield self._recomputing_player()

    def _follow_changes(self) -> None:
        """Show the past as the log has it now, where a person was forgotten since."""
        now_ns = self._clock.monotonic_ns()
        if now_ns - self._looked_ns < WHOLE_NS:
            return
        self._looked_ns = now_ns
        if not self._is_changed():
            return
        if self._archive.own is not None:
            self._archive.own.clear()  # states of a past that is another now
        self._open()
        with self._lock:
            if self._seek_ns is None:
                self._seek_ns = self._at_ns

    def _is_changed(self) -> bool:
        """True if the log was changed; False also where it cannot be read now."""
        with self._trouble:
            return self._was_changed()
        return False

    def _follow_seek(self) -> None:
        with self._lock:
            seek_ns, self._seek_ns = self._seek_ns, None
        if seek_ns is None:
            return
        published_ns = self._clock.monotonic_ns()
        for player in self._players():
            for _ in player.seek(seek_ns):
                if self._closed.is_set() or self._seek_ns is not None:
                    return
                if self._clock.monotonic_ns() - published_ns >= PAUSED_S * NS_PER_S:
                    published_ns = self._clock.monotonic_ns()
                    self._publish_seeking()
            if not player.is_lost:
                break
        self._player = player
        with self._lock:
            self._at_ns, self._seeking, self._gap = seek_ns, False, player.gap
            self._away = ""
        player.reset(self.view())
        self._is_shown = True
        with self._lock:
            self._moved_ns = self._clock.monotonic_ns()  # the way there is not played

    def _publish_seeking(self) -> None:
        """Show consoles that the replay is alive on a long way, and where it goes."""
        with self._lock:
            self._seeking = True
        self._player.publish(self.view(), whole=False)
        self._answer()

    def _answer(self) -> None:
        while self._asked:
            view = self.view()
            if self._seek_ns is not None:
                return  # the view is of the time asked for, the picture is not yet
            shown = self._player.snapshot(view)
            self._asked.popleft()(*self._sink.of_incident(*shown))

    def _move(self) -> None:
        """Let as much of the past go by as follows from the clock and the speed."""
        self._is_behind = False
        with self._lock:
            now_ns = self._clock.monotonic_ns()
            elapsed_ns, self._moved_ns = now_ns - self._moved_ns, now_ns
            if not self._playing or self._seek_ns is not None:
                until_ns = None
            else:
                until_ns = min(self._at_ns + round(elapsed_ns * self._speed), self._window.end_ns)
        if until_ns is None:
            self._publish()
            return
        began_ns, player = self._clock.monotonic_ns(), self._player
        while player.advance(until_ns):
            if self._clock.monotonic_ns() - began_ns > DELTA_S * NS_PER_S:
                until_ns = player.at_ns
                self._is_behind = True  # as fast as it goes
                break
        with self._lock:
            if self._seek_ns is None:
                self._at_ns, self._gap = until_ns, player.gap
                self._playing = self._playing and until_ns < self._window.end_ns
                if player.is_lost:  # behind what consoles were shown, and the log goes on
                    self._seek_ns = until_ns
        self._publish()

    def _publish(self) -> None:
        now_ns = self._clock.monotonic_ns()
        whole = now_ns - self._whole_ns >= WHOLE_NS
        if whole:
            self._whole_ns = now_ns
        self._player.publish(self.view(), whole=whole)


def checked_speed(speed: float) -> float:
    if not (math.isfinite(speed) and SLOWEST <= speed <= FASTEST):
        raise UserError(
            coded(
                "replay-speed",
                "a replay runs at {slowest} to {fastest:.0f} times real time, not {speed}",
                slowest=SLOWEST,
                fastest=FASTEST,
                speed=speed,
            )
        )
    return speed
