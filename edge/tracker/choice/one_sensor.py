"""Tracker of one sensor among those of a person."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType

from edge.samples import ImuBatch
from edge.tracker.interface import ScaledByPerson, StepScale, TrackBatch, Tracker
from edge.tracker.track_rows import empty_rows
from shared.earth_field import EarthField
from shared.path_noise import PathNoise


class OneSensorTracker:
    """``MultiSensorTracker`` that tracks by one sensor and leaves the others alone."""

    walked_step_scales: Mapping[str, StepScale] = MappingProxyType({})

    def __init__(
        self,
        tracker: Tracker,
        sensor: str = "",
        place: str = "",
        known_scale: StepScale | None = None,
    ) -> None:
        """``known_scale``: of the person's steps with a sensor at this place; the tracker, new yet,
        starts with it if it counts steps.
        """
        self._tracker = tracker
        self._sensor = sensor
        self._place = place
        self._known_scale = known_scale
        if known_scale is not None and isinstance(tracker, ScaledByPerson):
            tracker.set_step_scale(known_scale)

    @property
    def scaled_place(self) -> str | None:
        """Place of the sensor where its steps make the path; see ``LearnsSteps``."""
        return self._place if isinstance(self._tracker, ScaledByPerson) else None

    @property
    def start_scales(self) -> Mapping[str, StepScale | None]:
        """Scale with which it has started; see ``LearnsSteps``."""
        counts_steps = isinstance(self._tracker, ScaledByPerson)
        return {self._place: self._known_scale} if counts_steps else {}

    @property
    def path_noise(self) -> PathNoise | None:
        """Process noise of the rows; see ``Tracker``."""
        return self._tracker.path_noise

    def push(self, sensor: str, batch: ImuBatch) -> TrackBatch:
        return self._tracker.push(batch) if sensor == self._sensor else empty_rows()

    def set_earth_field(self, field: EarthField, t_ns: int) -> None:
        self._tracker.set_earth_field(field, t_ns)

    def finish(self) -> TrackBatch:
        return self._tracker.finish()
