"""Inertial sensors of one unit as its pipeline uses them: each with its own state."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from edge.activity.monitor import ActivityMonitor
from edge.agent.fitted_sensor import FittedSensor
from edge.agent.sensor_health import SensorHealth
from edge.agent.sensor_presence import SensorPresence
from edge.clocks.timeline import Timeline
from edge.fault_texts import fault_of
from edge.samples import ImuBatch, SensorBatch
from edge.tracker.interface import TrackBatch


class UnitSensors:
    """State of the sensors.  The wearer's activity is that of the first one that is not gone."""

    def __init__(self, fitted: Sequence[FittedSensor]) -> None:
        """``fitted``: at least one."""
        names = [one.name for one in fitted]
        self._presence = SensorPresence(names)
        self._corrections = {one.name: one.correction() for one in fitted}
        self._healths = {name: SensorHealth() for name in names}
        self._monitors = {name: ActivityMonitor() for name in names}
        with_barometer = [one.name for one in fitted if one.description.barometer_present]
        self._barometer = (with_barometer or names)[0]

    @property
    def monitor(self) -> ActivityMonitor:
        """Monitor of the sensor that leads."""
        return self._monitors[self._presence.leading]

    def leads(self, sensor: str) -> bool:
        return sensor == self._presence.leading

    def is_barometer(self, sensor: str) -> bool:
        """True for the one sensor whose air pressure is used: two barometers differ by metres."""
        return sensor == self._barometer

    def take(
        self, batch: SensorBatch, timeline: Timeline
    ) -> tuple[SensorBatch, Timeline, list[str]]:
        """Return batch and timeline on the sensors' common clock, and new faults."""
        on_common, its_timeline, news = self._presence.take(batch, timeline)
        return on_common, its_timeline, [*news, *self._faults(batch)]

    def correct(self, sensor: str, imu: ImuBatch) -> ImuBatch:
        """Return the samples of a sensor, corrected by its calibration."""
        correction = self._corrections.get(sensor)
        return imu if correction is None else correction.push(imu)

    def note_press(self) -> None:
        """Take a press of the button for motion."""
        for monitor in self._monitors.values():
            monitor.note_press()

    def watch(self, sensor: str, imu: ImuBatch, track: TrackBatch) -> int:
        """Pass each sensor's samples and the person's path to its monitor; return the falls that
        the leading one has confirmed.
        """
        falls = 0
        for name, monitor in self._monitors.items():
            found = monitor.push(imu if name == sensor else imu.part(slice(0)), track)
            if self.leads(name):
                falls = found
        return falls

    def _faults(self, batch: SensorBatch) -> Iterator[str]:
        if batch.sensor in self._healths:
            for fault in self._healths[batch.sensor].push(batch.imu):
                yield fault_of(batch.sensor, fault) if batch.sensor else fault
