"""Tracker of a person that chooses itself, once the motion has shown where the sensors are worn.

Until then it tracks as on a foot, and keeps the samples.  Rows of a person who stands still are
released; rows of the first motion are held until the choice is made: those of the tracker that
was right, so nothing of the path is lost, and nothing of it is of a tracker that was wrong.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Mapping

import numpy as np

from edge.samples import ImuBatch
from edge.tracker.choice.interface import Choice
from edge.tracker.choice.recognition import MountRecogniser
from edge.tracker.choice.selection import (
    Sensors,
    TrackerSelection,
    select_automatically,
    with_places,
)
from edge.tracker.interface import BodyDimensions, LearnsSteps, StepScale, TrackBatch
from edge.tracker.track_rows import empty_rows, join_rows
from shared.clock import NS_PER_S
from shared.earth_field import EarthField
from shared.path_noise import PathNoise

_KEPT_NS = 20 * NS_PER_S  # of a person who stands still: enough for a tracker to align itself
_SILENT_NS = 2 * NS_PER_S  # a sensor that is gone is not waited for


class AutomaticTracker:
    """``MultiSensorTracker`` and ``ChoosesTracker`` of sensors of which some have no place."""

    def __init__(self, sensors: Sensors, dimensions: BodyDimensions) -> None:
        """``sensors``: by their names; at least one without a place."""
        self._sensors = sensors
        self._dimensions = dimensions
        self._assumed = select_automatically(with_places(sensors, {}), dimensions)
        self._tracker = self._assumed.make(with_places(sensors, {}), dimensions)
        self._recognisers = {
            name: MountRecogniser() for name, sensor in sensors.items() if not sensor.place
        }
        self._newest_ns: dict[str, int] = {}  # of each sensor, at first the begin
        self._kept: deque[tuple[str, ImuBatch]] = deque()
        self._fields: list[tuple[EarthField, int]] = []
        self._held: list[TrackBatch] = []
        self._released_ns: int | None = None  # time of the last row that was released
        self._choice: Choice | None = None

    @property
    def choice(self) -> Choice | None:
        return self._choice

    @property
    def path_noise(self) -> PathNoise | None:
        """Process noise of the rows; see ``Tracker``."""
        return self._tracker.path_noise

    @property
    def scaled_place(self) -> str | None:
        """Place of the sensor whose steps make all of the path; see ``LearnsSteps``."""
        return self._tracker.scaled_place if isinstance(self._tracker, LearnsSteps) else None

    @property
    def start_scales(self) -> Mapping[str, StepScale | None]:
        """Scales with which the path has started; see ``LearnsSteps``."""
        return self._tracker.start_scales if isinstance(self._tracker, LearnsSteps) else {}

    @property
    def walked_step_scales(self) -> Mapping[str, StepScale]:
        """Scales that the other sensors have shown; see ``LearnsSteps``."""
        return self._tracker.walked_step_scales if isinstance(self._tracker, LearnsSteps) else {}

    def push(self, sensor: str, batch: ImuBatch) -> TrackBatch:
        """Take samples of one sensor; return the rows that have become final."""
        rows = self._tracker.push(sensor, batch)
        if self._choice is not None or not len(batch):
            return rows
        self._held.append(rows)
        self._kept.append((sensor, batch))
        if not self._newest_ns:
            self._newest_ns = dict.fromkeys(self._sensors, int(batch.t_ns[0]))
        self._newest_ns[sensor] = int(batch.t_ns[-1])
        if sensor in self._recognisers:
            self._recognisers[sensor].push(batch)
        awaited = self._awaited()
        if not any(one.place is None for one in awaited.values()):
            return self._choose()
        if all(one.moved_ns is None for one in awaited.values()):
            self._forget_old()
            return self._release_still(awaited)
        return empty_rows()

    def set_earth_field(self, field: EarthField, t_ns: int) -> None:
        """Set the earth's field around here; see ``Tracker``."""
        self._tracker.set_earth_field(field, t_ns)
        if self._choice is None:
            self._fields.append((field, t_ns))

    def finish(self) -> TrackBatch:
        """Return the rows still held back: of too little motion those as on a foot."""
        held, self._held = join_rows(self._held), []
        return join_rows([held, self._tracker.finish()])

    def _awaited(self) -> dict[str, MountRecogniser]:
        """Return the recognisers of the sensors that give samples."""
        now_ns = max(self._newest_ns.values())
        return {
            name: one
            for name, one in self._recognisers.items()
            if now_ns - self._newest_ns[name] <= _SILENT_NS
        }

    def _release_still(self, awaited: dict[str, MountRecogniser]) -> TrackBatch:
        """Return the held rows of the time in which nothing has moved."""
        ends_ns = [one.still_until_ns for one in awaited.values()]
        known_ns = [end_ns for end_ns in ends_ns if end_ns is not None]
        if not known_ns:
            return empty_rows()
        rows = join_rows(self._held)
        is_still = rows.t_ns < min(known_ns)
        self._held = [rows.part(np.flatnonzero(~is_still))]
        return self._released(rows.part(np.flatnonzero(is_still)))

    def _released(self, rows: TrackBatch) -> TrackBatch:
        if len(rows):
            self._released_ns = int(rows.t_ns[-1])
        return rows

    def _forget_old(self) -> None:
        oldest_ns = max(self._newest_ns.values()) - _KEPT_NS
        while self._kept[0][1].t_ns[-1] < oldest_ns:
            self._kept.popleft()

    def _choose(self) -> TrackBatch:
        """Choose the tracker; return the rows that were held, of that tracker."""
        recognised = {name: one.place for name, one in self._recognisers.items() if one.place}
        undecided = [name for name, one in self._recognisers.items() if one.place is None]
        there = {name: one for name, one in self._sensors.items() if name not in undecided}
        placed = with_places(there or self._sensors, recognised)
        selection = select_automatically(placed, self._dimensions)
        held, self._held = join_rows(self._held), []
        if _is_same(selection, self._assumed):
            rows = held
        else:
            self._tracker = selection.make(placed, self._dimensions)
            rows = _after(self._track_kept(), self._released_ns)
        self._kept.clear()
        self._choice = selection.choice(recognised)
        return rows

    def _track_kept(self) -> TrackBatch:
        for field, t_ns in self._fields:
            self._tracker.set_earth_field(field, t_ns)
        return join_rows([self._tracker.push(sensor, batch) for sensor, batch in self._kept])


def _is_same(one: TrackerSelection, other: TrackerSelection) -> bool:
    return (one.tracker, one.sensors) == (other.tracker, other.sensors)


def _after(rows: TrackBatch, t_ns: int | None) -> TrackBatch:
    return rows if t_ns is None else rows.part(np.flatnonzero(rows.t_ns > t_ns))
