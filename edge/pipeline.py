"""From sensor batches to outgoing messages: the whole of what a unit decides by itself.

Pure: no input, output, threads or waiting.  Time comes with the samples; the same batches
give the same messages.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from edge.calibration import Calibration, Correction, identity
from edge.clocks.timeline import Timeline
from edge.decimation import Decimator, OncePerPeriod
from edge.expected_field import ExpectedField, Place
from edge.motion.activity import ActivityMonitor
from edge.position_stream import PositionStream
from edge.raw.stream import gps_fix, says_what, sighting
from edge.raw.uplink import RawUplink
from edge.samples import (
    CANCEL,
    MAYDAY,
    AmbientSample,
    BatterySample,
    ButtonPress,
    GpsSample,
    OtherSample,
    SensorBatch,
    SensorDescription,
    SightingSample,
)
from edge.sensor_health import SensorHealth
from edge.tracker.port import Tracker
from shared.channels import DESCRIPTION, GPS, STATUS, TEMPERATURE, Channel
from shared.clock import NS_PER_S
from shared.envelope import Stamper
from shared.messages import EventKind, Message, Status, Temperature, UnitDescription, UnitEvent

LIVE = Timeline()
_MOST_SIGHTED = 1000  # things told from each other
_ONE_PRESS_NS = 3 * NS_PER_S  # a thumb that presses several times
_DESCRIPTION_FOR_TRACKER_HZ = 0.2  # it cannot begin before it has heard one


@dataclass(frozen=True, slots=True)
class UnitIdentity:
    """What a unit says of itself."""

    software_version: str
    source: str
    tracker: str
    sensor: SensorDescription
    calibration: Calibration | None = None
    place: Place | None = None


class TrackerPipeline:
    """One unit's state.  Call ``start`` once, ``step`` for each batch, ``finish`` at the end."""

    def __init__(
        self,
        identity: UnitIdentity,
        tracker: Tracker,
        stamper: Stamper,
        position_rate_hz: float,
        *,
        mayday: bool = False,
        raw_uplink: RawUplink | None = None,
    ) -> None:
        """``mayday``: one was latched when the unit last came to a sudden end.  ``raw_uplink``:
        of a unit that sends its samples for somebody else to track with.
        """
        self._identity = identity
        self._correction = (
            None
            if identity.calibration is None
            else Correction(identity.calibration, identity.sensor)
        )
        self._tracker = tracker
        self._stamper = stamper
        self._positions = PositionStream(stamper, position_rate_hz)
        self._monitor = ActivityMonitor()
        self._health = SensorHealth()
        self._expected_field = ExpectedField(identity.place)
        self._status_times = Decimator(_rate_hz(STATUS))
        self._raw_uplink = raw_uplink
        self._description_times = Decimator(
            _rate_hz(DESCRIPTION) if raw_uplink is None else _DESCRIPTION_FOR_TRACKER_HZ
        )
        self._gps_times = OncePerPeriod(_rate_hz(GPS))
        self._temperature_times = Decimator(_rate_hz(TEMPERATURE))
        self._battery: float | None = None
        self._mayday = mayday
        self._mayday_ns: int | None = None  # when it was pressed and said
        self._has_gps = False
        self._journal_pending = 0
        self._sighted_ns: dict[tuple[str, str], int] = {}

    def start(self) -> tuple[Message, ...]:
        """The unit's first words."""
        first = (self._event(EventKind.STARTED, None, self._identity.source), self._describe(None))
        if not self._mayday:
            return first
        return (*first, self._event(EventKind.MAYDAY, None, "still latched after a restart"))

    def step(self, batch: SensorBatch, timeline: Timeline = LIVE) -> tuple[Message, ...]:
        """Take one batch, quantised as by ``edge.raw.stream``; return what is to be sent."""
        self._learn_field(batch, timeline)
        imu = batch.imu if self._correction is None else self._correction.push(batch.imu)
        track = self._tracker.push(imu)
        messages: list[Message] = [
            self._event(EventKind.SENSOR_FAULT, _last_ns(batch, timeline), fault)
            for fault in self._health.push(batch.imu)
        ]
        for sample in batch.others:
            messages += self._take_other(sample, timeline)
        if self._raw_uplink is not None:
            messages += self._raw_uplink.push(batch.imu, timeline)
        self._positions.take_pressure(batch.imu)
        messages += self._positions.push(track, timeline)
        if self._monitor.push(imu, track):
            detail = "fell and has not moved since"
            messages.append(self._event(EventKind.FALL, _last_ns(batch, timeline), detail))
        messages += self._periodic(batch, timeline)
        return tuple(messages)

    def finish(self, timeline: Timeline = LIVE) -> tuple[Message, ...]:
        """The rows that the tracker still held back, or the samples that were not sent yet."""
        rest: list[Message] = [*self._positions.push(self._tracker.finish(), timeline)]
        if self._raw_uplink is not None:
            rest += self._raw_uplink.finish(timeline)
        return tuple(rest)

    def set_position_rate(self, rate_hz: float) -> None:
        self._positions.set_rate(rate_hz)

    def note_journal(self, pending: int) -> None:
        """How many messages are not known to have arrived, for the next status."""
        self._journal_pending = pending

    def _learn_field(self, batch: SensorBatch, timeline: Timeline) -> None:
        def utc_ns_of(t_ns: int) -> int:
            return self._stamper.utc_ns(timeline.to_mono_ns(t_ns))

        learned = self._expected_field.take(batch, utc_ns_of)
        if learned is not None:
            self._tracker.learn_field(*learned)

    def _take_other(self, sample: OtherSample, timeline: Timeline) -> list[Message]:
        mono_ns = timeline.to_mono_ns(sample.t_ns)
        match sample:
            case AmbientSample():
                return self._take_ambient(sample, mono_ns)
            case GpsSample():
                self._has_gps = True
                if self._gps_times.takes(sample.t_ns):
                    return [gps_fix(self._stamper.header(mono_ns), sample)]
            case SightingSample():
                return self._take_sighting(sample, mono_ns)
            case BatterySample():
                self._battery = sample.level
            case ButtonPress(button=button) if button in (MAYDAY, CANCEL):
                return self._take_button(sample, mono_ns)
        return []

    def _take_ambient(self, sample: AmbientSample, mono_ns: int) -> list[Message]:
        if not math.isfinite(sample.temperature_degc):
            return []
        if not self._temperature_times.takes(sample.t_ns):
            return []
        return [Temperature(self._stamper.header(mono_ns), sample.temperature_degc)]

    def _take_sighting(self, sample: SightingSample, mono_ns: int) -> list[Message]:
        """The same thing at most once a second."""
        what = (sample.kind, sample.seen_id)
        before_ns = self._sighted_ns.get(what)
        again = before_ns is not None and 0 <= sample.t_ns - before_ns < NS_PER_S
        if again or not says_what(sample):
            return []
        if len(self._sighted_ns) >= _MOST_SIGHTED:
            self._sighted_ns.clear()
        self._sighted_ns[what] = sample.t_ns
        return [sighting(self._stamper.header(mono_ns), sample)]

    def _take_button(self, press: ButtonPress, mono_ns: int) -> list[Message]:
        """A mayday stays until the wearer takes it back.  Pressed again it is said again: somebody
        at the station may have resolved the first one.
        """
        if press.button == CANCEL:
            if not self._mayday:
                return []
            self._mayday = False
            return [self._event(EventKind.MAYDAY_CANCELLED, mono_ns, "button")]
        before_ns, now_ns = self._mayday_ns, press.t_ns
        if self._mayday and before_ns is not None and 0 <= now_ns - before_ns < _ONE_PRESS_NS:
            return []
        self._mayday, self._mayday_ns = True, now_ns
        return [self._event(EventKind.MAYDAY, mono_ns, "button")]

    def _periodic(self, batch: SensorBatch, timeline: Timeline) -> list[Message]:
        t_ns = _last_source_ns(batch)
        if t_ns is None:
            return []
        messages: list[Message] = []
        if self._status_times.takes(t_ns):
            messages.append(self._status(t_ns, timeline))
        if self._description_times.takes(t_ns):
            messages.append(self._describe(timeline.to_mono_ns(t_ns)))
        return messages

    def _status(self, t_ns: int, timeline: Timeline) -> Status:
        return Status(
            header=self._stamper.header(timeline.to_mono_ns(t_ns)),
            activity=self._monitor.activity(t_ns),
            motionless_s=self._monitor.motionless_s,
            battery=self._battery,
            mayday=self._mayday,
            steps=self._monitor.steps,
            cadence_hz=self._monitor.cadence_hz(t_ns),
            floors_climbed=self._positions.floors_climbed,
            tracker_rows_dropped=self._positions.rows_dropped,
            journal_pending=self._journal_pending,
        )

    def _describe(self, mono_ns: int | None) -> UnitDescription:
        sensor = self._identity.sensor
        calibration = self._identity.calibration
        return UnitDescription(
            header=self._stamper.header(mono_ns),
            software_version=self._identity.software_version,
            source=self._identity.source,
            sensor_name=sensor.name,
            rate_hz=sensor.rate_hz,
            accel_full_scale_mps2=sensor.accel_full_scale_mps2,
            gyro_full_scale_radps=sensor.gyro_full_scale_radps,
            tracker=self._identity.tracker,
            calibration="" if calibration is None else identity(calibration),
            has_magnetometer=sensor.mag_present,
            has_barometer=sensor.barometer_present,
            has_gps=self._has_gps,
            calibrated_s=None if calibration is None else round(calibration.made.timestamp()),
            calibration_faults="" if calibration is None else "; ".join(calibration.faults()),
            gain_std=sensor.gain_std,
        )

    def _event(self, kind: EventKind, mono_ns: int | None, detail: str) -> UnitEvent:
        return UnitEvent(self._stamper.header(mono_ns), kind, detail)


def _rate_hz(channel: Channel) -> float:
    assert channel.rate_hz is not None
    return channel.rate_hz


def _last_source_ns(batch: SensorBatch) -> int | None:
    if len(batch.imu):
        return int(batch.imu.t_ns[-1])
    return max((sample.t_ns for sample in batch.others), default=None)


def _last_ns(batch: SensorBatch, timeline: Timeline) -> int | None:
    t_ns = _last_source_ns(batch)
    return None if t_ns is None else timeline.to_mono_ns(t_ns)
