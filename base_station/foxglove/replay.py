"""Replay of a window of the log, which Foxglove's own time bar plays, pauses and seeks."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from itertools import islice
from pathlib import Path

from foxglove.websocket import (
    PlaybackCommand,
    PlaybackControlRequest,
    PlaybackState,
    PlaybackStatus,
)

from base_station.foxglove.log_topics import topics_in
from base_station.foxglove.playback_clock import PlaybackClock
from base_station.foxglove.server import FoxgloveServer
from shared.clock import NS_PER_S
from shared.mcap_log import PLAN_TOPIC, LogRecord, own_segments, read_log, segments_within

_BURST = 2000  # records of a step: some 20 ms
_LOOKED_BACK_NS = 15 * NS_PER_S  # from where a replay begins: as long as a unit may be silent
_PLAN_LOGGED_NS = 1000 * NS_PER_S  # the plan is logged again as often, and a little more


class LogReplay:
    """Replay that publishes the records of a window in step with its clock; ``step`` is to be
    called regularly.
    """

    def __init__(
        self,
        log: Path,
        window_ns: tuple[int, int],
        server: FoxgloveServer,
        now_ns: int,
        on_damage: Callable[[str], object],
    ) -> None:
        """``window_ns``: first and last station time; ``now_ns``: monotonic."""
        self._log, self._server, self._on_damage = log, server, on_damage
        self._end_ns = window_ns[1]
        self._clock = PlaybackClock(*window_ns, now_ns)
        self._records: Iterator[LogRecord] = iter(())
        self._next: LogRecord | None = None
        segments, _ = own_segments(log)
        server.advertise(sorted(topics_in(segments_within(segments, *window_ns))))
        self._seek(window_ns[0])

    def step(self, now_ns: int) -> bool:
        """Publish the records that are due at the monotonic time ``now_ns``. False if none was
        due.
        """
        requests = self._server.requests()
        for request in requests:
            self._apply(request)
        was_playing = self._clock.is_playing
        published = self._publish_until(self._clock.advance(now_ns))
        if was_playing:
            self._server.show_time(self._clock.at_ns)
            if not self._clock.is_playing:
                self._show_state(did_seek=False)
        self._server.work()
        return bool(requests or published)

    def _apply(self, request: PlaybackControlRequest) -> None:
        clock = self._clock
        before_ns = clock.at_ns
        clock.set_speed(request.playback_speed)
        if request.seek_time is not None:
            clock.seek(request.seek_time)
        if request.playback_command == PlaybackCommand.Play:
            clock.play()
        else:
            clock.pause()
        did_seek = request.seek_time is not None or clock.at_ns != before_ns
        self._show_state(did_seek=did_seek, request_id=request.request_id)
        if did_seek:
            self._seek(clock.at_ns)

    def _show_state(self, *, did_seek: bool, request_id: str = "") -> None:
        clock = self._clock
        status = PlaybackStatus.Playing if clock.is_playing else PlaybackStatus.Paused
        if clock.is_at_end:
            status = PlaybackStatus.Ended
        self._server.show_state(
            PlaybackState(status, clock.at_ns, clock.speed, did_seek, request_id)
        )

    def _seek(self, t_ns: int) -> None:
        """Publish the state at ``t_ns``; later records follow."""
        newest = {
            record[1]: record
            for window_ns, keys in ((_PLAN_LOGGED_NS, {PLAN_TOPIC}), (_LOOKED_BACK_NS, None))
            for record in self._read(max(t_ns - window_ns, 0), t_ns + 1, keys)
        }
        self._server.forget()
        self._server.publish(sorted(newest.values()))
        self._server.show_time(t_ns)
        self._records = self._read(t_ns + 1, self._end_ns + 1)
        self._next = next(self._records, None)

    def _publish_until(self, t_ns: int) -> int:
        """At most a burst; the clock waits where there is more."""
        due = list(islice(self._due(t_ns), _BURST))
        self._server.publish(due)
        if len(due) == _BURST and self._next is not None:
            self._clock.hold(due[-1][0])
        return len(due)

    def _due(self, t_ns: int) -> Iterator[LogRecord]:
        while self._next is not None and self._next[0] <= t_ns:
            record = self._next
            self._next = next(self._records, None)
            yield record

    def _read(
        self, start_ns: int, end_ns: int, keys: set[str] | None = None
    ) -> Iterator[LogRecord]:
        return read_log(self._log, start_ns, end_ns, keys, self._on_damage, derived=True)
