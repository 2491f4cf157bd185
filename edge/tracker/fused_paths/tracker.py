"""Trackers of a person by two sensors whose paths are fused into one.

Each sensor has the tracker of its place; what they make of the walk comes together row by row
(``rows``), in the order of time (``sensor_rows``).
"""

from __future__ import annotations

from collections.abc import Callable, Mapping

import numpy as np

from edge.samples import ImuBatch, SensorDescription
from edge.tracker.body.tracker import BodyTracker
from edge.tracker.foot.eskf import EskfTracker
from edge.tracker.fused_paths.rows import Columns, fuse
from edge.tracker.fused_paths.sensor_rows import SensorRows
from edge.tracker.fused_paths.state import ERRORS, FUSION, LEAD, LENGTH, OTHER, FusionConfig
from edge.tracker.interface import (
    FOOT,
    LEFT_FOOT,
    RIGHT_FOOT,
    BodyDimensions,
    ScaledByPerson,
    StepScale,
    TrackBatch,
    Tracker,
    WornSensor,
)
from edge.tracker.track_rows import join_rows
from shared.earth_field import EarthField
from shared.path_noise import PathNoise

FEET = (FOOT, LEFT_FOOT, RIGHT_FOOT)
_MEASURED_SHARE = 0.8  # of the variance at the start: one that is larger has shown nothing
TWO_FEET = FusionConfig()
# The foot's path is by far the better one; the trunk's lengths are learnt from it.
FOOT_AND_TRUNK = FusionConfig(length_std=(0.003, 0.08), share=(0.99, 0.01))


class FusedPathsTracker:
    """Two paths of one person, fused; see ``MultiSensorTracker``."""

    path_noise: PathNoise | None = None  # of the leading foot, which is the usual one
    scaled_place: str | None = None  # the foot's path is by no steps

    def __init__(
        self,
        sensors: Mapping[str, WornSensor],
        dimensions: BodyDimensions,
        config: FusionConfig,
        tracker_at: Callable[[str], Callable[[SensorDescription], Tracker]] | None = None,
    ) -> None:
        """``tracker_at`` gives the maker of the tracker for a place."""
        tracker_at = tracker_at or _tracker_at
        # The leading sensor is a foot, and the left one of two.
        names = sorted(
            sensors, key=lambda name: (sensors[name].place not in FEET, sensors[name].place)
        )
        trackers = {
            name: tracker_at(sensors[name].place)(sensors[name].description) for name in names
        }
        self._paths = {
            name: SensorRows(tracker, config.silence_s) for name, tracker in trackers.items()
        }
        self._trunk_place: str | None = None  # of the other path where that one is by steps
        self._known = StepScale(1.0, config.length_std[OTHER])  # of that path, at the start
        self.start_scales: dict[str, StepScale | None] = {}  # see ``LearnsSteps``
        other = trackers[names[OTHER]]
        if isinstance(other, ScaledByPerson):
            self._trunk_place = sensors[names[OTHER]].place
            known = dimensions.step_scales.get(self._trunk_place)
            self.start_scales = {self._trunk_place: known}
            if known is not None:
                self._known = known
                other.set_step_scale(known)
                config = config._replace(length_std=(config.length_std[LEAD], known.std))
        self._config = config
        self._state = np.zeros(1, FUSION)

    @property
    def walked_step_scales(self) -> Mapping[str, StepScale]:
        """Scale of the steps of this walk by place, as the other path alone has shown it."""
        other = self._state[0]["paths"][OTHER]
        if self._trunk_place is None or not other["aligned"]:
            return {}
        # The posterior of the filter is that of its start and of what was measured.
        at = ERRORS * OTHER + LENGTH
        left = float(self._state[0]["covariance"][at, at])
        start = self._config.length_std[OTHER] ** 2
        if not 0.0 < left < _MEASURED_SHARE * start:
            return {}
        variance = left * start / (start - left)
        measured = 1.0 + (float(other["scale"]) - 1.0) * (1.0 + variance / start)
        factor = self._known.factor
        return {self._trunk_place: StepScale(factor * measured, factor * variance**0.5)}

    def push(self, sensor: str, batch: ImuBatch) -> TrackBatch:
        """Take samples of one sensor; return the rows that have become final."""
        self._paths[sensor].push(batch)
        return self._fuse(self._known_ns())

    def set_earth_field(self, field: EarthField, t_ns: int) -> None:
        """Set the earth's field around here, for both."""
        for path in self._paths.values():
            path.tracker.set_earth_field(field, t_ns)

    def finish(self) -> TrackBatch:
        """Return the rows still held back; the tracker is used up."""
        for path in self._paths.values():
            path.finish()
        return self._fuse(2**62)

    def _known_ns(self) -> int:
        """Return the time up to which no row of either path can come any more."""
        config = self._config
        newest_ns = max(path.newest_ns for path in self._paths.values())
        lag_ns = round(config.lag_s * 1e9)
        gone_ns = lag_ns + round(config.silence_s * 1e9)
        return min(
            max(path.known_ns, newest_ns - lag_ns)
            if newest_ns - path.newest_ns > gone_ns
            else path.known_ns
            for path in self._paths.values()
        )

    def _fuse(self, until_ns: int) -> TrackBatch:
        parts = [path.take(until_ns) for path in self._paths.values()]
        sensors = np.repeat(np.arange(len(parts)), [len(part) for part in parts])
        rows = join_rows(parts)
        if not len(rows):
            return rows
        order = np.lexsort((sensors, rows.t_ns))
        rows = rows.part(order)
        fused = _columns(rows.part(np.arange(len(rows))))
        written = fuse(self._state, _columns(rows), sensors[order], fused, self._config)
        return TrackBatch(*fused).part(np.arange(written))


def _tracker_at(place: str) -> Callable[[SensorDescription], Tracker]:
    return EskfTracker if place in FEET else BodyTracker


def _columns(rows: TrackBatch) -> Columns:
    return Columns(*(getattr(rows, name) for name in Columns._fields))
