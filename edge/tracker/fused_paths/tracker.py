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
from edge.tracker.fused_paths.state import FUSION, FusionConfig
from edge.tracker.interface import (
    FOOT,
    LEFT_FOOT,
    RIGHT_FOOT,
    BodyDimensions,
    TrackBatch,
    Tracker,
    WornSensor,
)
from edge.tracker.track_rows import join_rows
from shared.earth_field import EarthField
from shared.path_noise import PathNoise

FEET = (FOOT, LEFT_FOOT, RIGHT_FOOT)
TWO_FEET = FusionConfig()
# The foot's path is by far the better one; the trunk's lengths are learnt from it.
FOOT_AND_TRUNK = FusionConfig(length_std=(0.003, 0.08), share=(0.99, 0.01))


class FusedPathsTracker:
    """Two paths of one person, fused; see ``MultiSensorTracker``."""

    path_noise: PathNoise | None = None  # of the leading foot, which is the usual one

    def __init__(
        self,
        sensors: Mapping[str, WornSensor],
        dimensions: BodyDimensions,
        config: FusionConfig,
        tracker_at: Callable[[str], Callable[[SensorDescription], Tracker]] | None = None,
    ) -> None:
        """``tracker_at`` gives the maker of the tracker for a place."""
        del dimensions  # the paths have their own lengths
        tracker_at = tracker_at or _tracker_at
        self._config = config
        # The leading sensor is a foot, and the left one of two.
        names = sorted(
            sensors, key=lambda name: (sensors[name].place not in FEET, sensors[name].place)
        )
        self._paths = {
            name: SensorRows(
                tracker_at(sensors[name].place)(sensors[name].description), config.silence_s
            )
            for name in names
        }
        self._state = np.zeros(1, FUSION)

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
