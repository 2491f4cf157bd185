"""Recording of the pictures of consoles in a log: keyframes, deltas behind them, and gaps."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field

import msgspec

from base_station.engine.console_recorder import KEYFRAME_NS
from base_station.replay.playback import ReadLog
from base_station.replay.record_gaps import LONGEST_NS, RecordGap
from base_station.views.recorded import RecordedDelta, read_snapshot
from base_station.views.wire import Snapshot, Trail
from shared.mcap_log import DELTA_TOPIC, SNAPSHOT_TOPIC, TRAIL_TOPIC

_TOPICS = frozenset({SNAPSHOT_TOPIC, TRAIL_TOPIC, DELTA_TOPIC})
_LOOK_BACK_NS = KEYFRAME_NS + LONGEST_NS  # of an incident that goes on there is a keyframe
_FURTHER = 8  # times as far, where the log has nothing at all


@dataclass(frozen=True, slots=True)
class Frame:
    """A recorded console message; a snapshot with the trails behind it."""

    t_ns: int  # log time
    message: Snapshot | RecordedDelta
    trails: Mapping[str, msgspec.Raw] = field(default_factory=dict)


class ConsoleRecording:
    def __init__(self, read: ReadLog) -> None:
        self._read = read
        self._trails = msgspec.json.Decoder(Trail)
        self._deltas = msgspec.json.Decoder(RecordedDelta)

    def keyframe_before(self, t_ns: int) -> int | None:
        """Log time of the last snapshot until ``t_ns``; None where there is none, or the log has
        records without any behind it.
        """
        span_ns = _LOOK_BACK_NS
        while True:
            from_ns = max(t_ns - span_ns, 0)
            found = max(
                (one[0] for one in self._read(from_ns, t_ns + 1, {SNAPSHOT_TOPIC})), default=0
            )
            if found:
                return found
            if not from_ns or next(self._read(from_ns, t_ns + 1, None), None) is not None:
                return None
            span_ns *= _FURTHER

    def frames(self, from_ns: int) -> Iterator[Frame]:
        """Raises msgspec.MsgspecError where another version of the program recorded it."""
        begun: tuple[int, Snapshot] | None = None
        trails: dict[str, msgspec.Raw] = {}
        for t_ns, topic, payload in self._read(from_ns, None, _TOPICS):
            if topic == TRAIL_TOPIC:
                trail = self._trails.decode(payload)
                trails[trail.unit_id] = trail.points.copy()
                continue
            if begun is not None:
                yield Frame(*begun, trails)
                begun, trails = None, {}
            if topic == SNAPSHOT_TOPIC:
                begun = t_ns, read_snapshot(payload)
            else:
                yield Frame(t_ns, self._deltas.decode(payload))
        if begun is not None:
            yield Frame(*begun, trails)

    def stretch_behind(self, frame_ns: int, next_ns: int | None) -> RecordGap | None:
        """Gap between two frames that are far apart: the time of which the log has no record; None
        where it has some, and only the pictures of consoles are missing.
        """
        begun_ns = frame_ns + LONGEST_NS
        last_ns = max((one[0] for one in self._read(frame_ns, begun_ns, None)), default=frame_ns)
        later = next(self._read(begun_ns, next_ns, None), None)
        if later is None:
            return RecordGap(last_ns, next_ns)
        starts = next_ns is not None and next_ns - later[0] <= LONGEST_NS  # the station, again
        return RecordGap(last_ns, later[0]) if starts else None
