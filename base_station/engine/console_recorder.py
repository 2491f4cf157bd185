"""Console recorder: writes the messages to consoles into the log, so that a replay can play them
without deciding again.

While an incident is open a delta goes to the log once a second, and at once with an alarm, an order
or a pin; a snapshot with all trails every two minutes, and whenever consoles get a new one.
Differences that a console cannot show are left out: ten deltas of a second are one.
"""

from __future__ import annotations

import msgspec

from base_station.core.pipeline import StationPipeline
from base_station.core.state.trail import TrailStep
from base_station.engine.console_publisher import ConsolePublisher
from base_station.engine.ports import Log, Trails
from base_station.engine.trail_encoder import trail_point
from base_station.views.recorded import RecordedDelta, reference_person
from base_station.views.wire import Delta, Snapshot, Trail, TrailPoint
from shared.clock import NS_PER_S
from shared.mcap_log import DELTA_TOPIC, SNAPSHOT_TOPIC, TRAIL_TOPIC

DELTA_NS = NS_PER_S
KEYFRAME_NS = 120 * NS_PER_S  # of log that a seek reads at most


class ConsoleRecorder:
    """``LiveSink`` of a publisher of its own, in the engine's thread."""

    def __init__(self, pipeline: StationPipeline, log: Log) -> None:
        self._pipeline = pipeline
        self._log = log
        self._encoder = msgspec.json.Encoder()
        self._points_ns: dict[str, int] = {}  # by unit: the last point of its trail in the log
        self._delta_due_ns = self._keyframe_due_ns = 0  # station time
        self._is_recorded = False  # the incident as it is
        self.publisher = ConsolePublisher(pipeline, self, reference_person)

    def record(self, *, at_once: bool = False) -> None:
        """Record a delta if one is due.  ``at_once``: after an operator's action."""
        if not self._is_wanted:
            return
        if self._log.is_behind:  # its memory is for events, which cannot be computed again
            self._keyframe_due_ns = 0
            return
        t_ns = self._pipeline.state.t_ns
        if t_ns >= self._keyframe_due_ns:
            self.publisher.reset()
        elif at_once or self.publisher.is_urgent or t_ns >= self._delta_due_ns:
            self.publisher.publish_delta(health=True)

    @property
    def _is_wanted(self) -> bool:
        """True while an incident is open, and once when it is closed."""
        state = self._pipeline.state
        if state.open_incidents:
            self._is_recorded = False
            return True
        return bool(state.incidents) and not self._is_recorded

    # ---- of the publisher

    def delta(self, delta: Delta) -> None:
        state = self._pipeline.state
        self._delta_due_ns = state.t_ns + DELTA_NS
        changed = {unit.unit_id: self._new_points(unit.unit_id) for unit in delta.units}
        values = msgspec.structs.asdict(delta)
        points = {unit_id: new for unit_id, new in changed.items() if new}
        self._points_ns |= {unit_id: self._last_point_ns(unit_id) for unit_id in delta.trails}
        self._write(DELTA_TOPIC, RecordedDelta(**values, points=points))

    def reset(self, snapshot: Snapshot, trails: Trails) -> None:
        state = self._pipeline.state
        self._delta_due_ns = state.t_ns + DELTA_NS
        self._keyframe_due_ns = state.t_ns + KEYFRAME_NS
        self._is_recorded = bool(state.incidents) and not state.open_incidents
        self._write(SNAPSHOT_TOPIC, snapshot)
        self._points_ns = {unit_id: self._last_point_ns(unit_id) for unit_id in trails}
        for unit_id, points in trails.items():
            self._write(TRAIL_TOPIC, Trail(unit_id, points))

    def _last_point_ns(self, unit_id: str) -> int:
        trail = self._pipeline.state.units[unit_id].trails.shown
        return trail[-1].t_ns if trail else -1

    def _new_points(self, unit_id: str) -> tuple[TrailPoint, ...]:
        """Return the points since the last record, oldest first."""
        trail = self._pipeline.state.units[unit_id].trails.shown
        known_ns = self._points_ns.get(unit_id, -1)
        new: list[TrailStep] = []
        for step in reversed(trail):
            if step.t_ns <= known_ns:
                break
            new.append(step)
        if new:
            self._points_ns[unit_id] = new[0].t_ns
        return tuple(map(trail_point, reversed(new)))

    def _write(self, topic: str, message: RecordedDelta | Snapshot | Trail) -> None:
        if not self._log.write(self._pipeline.state.t_ns, topic, self._encoder.encode(message)):
            self._keyframe_due_ns = 0  # the next delta must not follow a lost one
