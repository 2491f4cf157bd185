"""Player that makes all decisions again: as a proof, and to play a log without recorded pictures of
consoles.
"""

from __future__ import annotations

from collections.abc import Iterator

from base_station.engine.console_publisher import ConsolePublisher
from base_station.engine.ports import LiveSink, Trails
from base_station.replay.playback import Archive, Playback
from base_station.replay.record_gaps import RecordGap
from base_station.replay.version_check import VersionCheck
from base_station.storage.db.known_people import PersonLookup
from base_station.views.wire import ReplayView, Snapshot


class RecomputedPlayer:
    is_lost = False

    def __init__(self, archive: Archive, sink: LiveSink, people: PersonLookup) -> None:
        self._playback = Playback(archive)
        self._publisher = ConsolePublisher(archive.make_pipeline(None), sink, people)

    @property
    def at_ns(self) -> int:
        return self._playback.at_ns

    @property
    def gap(self) -> RecordGap | None:
        return self._playback.gap

    def version_check(self, until_ns: int) -> VersionCheck:
        """Return the version check of the records that are about to be shown."""
        return VersionCheck(self._playback, until_ns)

    def seek(self, t_ns: int) -> Iterator[None]:
        yield from self._playback.seek(t_ns)
        self._playback.show_unrecorded()
        self._publisher.use_pipeline(self._playback.pipeline)

    def advance(self, t_ns: int) -> bool:
        outputs = self._playback.advance(t_ns)
        is_done = outputs is None
        self._publisher.mark_changed(outputs or self._playback.show_unrecorded())
        return not is_done

    def reset(self, view: ReplayView) -> None:
        self._publisher.reset(view)

    def publish(self, view: ReplayView, *, whole: bool) -> None:
        self._publisher.publish_delta(whole, view)

    def snapshot(self, view: ReplayView) -> tuple[Snapshot, Trails]:
        return self._publisher.snapshot(view)
