"""Pipeline of the agent: from sensor batches to outgoing messages.

Pure: no input, output, threads or waiting.  Time comes with the samples; the same batches
give the same messages.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass

import msgspec

from edge.activity.body_posture import BodyPostureEstimator
from edge.activity.mounting import MountingCheck
from edge.agent.auxiliary_samples import AuxiliarySamples
from edge.agent.decimation import Decimator
from edge.agent.expected_field import ExpectedField
from edge.agent.fitted_sensor import FittedSensor
from edge.agent.mayday_button import MaydayButton
from edge.agent.position_publisher import PositionPublisher
from edge.agent.step_scale_by_fixes import StepScaleByFixes
from edge.agent.unit_sensors import UnitSensors
from edge.clocks.timeline import Timeline
from edge.sample_codec.codec import whole_seconds
from edge.sample_codec.descriptions import described_unit
from edge.sample_codec.uplink import RawUplink
from edge.samples import (
    ApproximatePosition,
    ButtonPress,
    GpsSample,
    SensorBatch,
)
from edge.tracker.choice.interface import Choice, ChoosesTracker
from edge.tracker.interface import LearnsSteps, MultiSensorTracker, StepScale, TrackBatch
from edge.tracker.track_rows import empty_rows
from shared.channels import DESCRIPTION, STATUS
from shared.header_factory import HeaderFactory
from shared.messages import (
    BatteryState,
    EventKind,
    Message,
    Position,
    PreflightFinding,
    Status,
    UnitDescription,
    UnitEvent,
)

LIVE = Timeline()
_WORN_S = 20.0  # of motion in total
_DESCRIPTION_FOR_TRACKER_HZ = 0.2  # a tracking agent starts when it has received one


@dataclass(frozen=True, slots=True)
class UnitIdentity:
    """Description of a unit, as it is published."""

    software_version: str
    source: str
    tracker: str  # as set
    sensors: tuple[FittedSensor, ...]  # the first one first; at least one
    place: ApproximatePosition | None = None
    outputs: tuple[str, ...] = ()  # kinds of those that notify the wearer


class TrackerPipeline:
    """State of one unit.  Call ``start`` once, ``step`` for each batch, ``finish`` at the end."""

    def __init__(
        self,
        identity: UnitIdentity,
        tracker: MultiSensorTracker,
        header_factory: HeaderFactory,
        position_rate_hz: float,
        *,
        mayday: bool = False,
        raw_uplink: RawUplink | None = None,
        foot_sensor: str | None = None,
        worn_on: str = "",
        notes: tuple[str, ...] = (),
    ) -> None:
        """``mayday``: one was latched when the unit last ended suddenly.  ``raw_uplink``: of a unit
        that sends its samples and is tracked elsewhere.  ``foot_sensor``: name of the sensor that
        the tracker needs on a foot.  ``worn_on``: place on the body that the tracker assumes for a
        sensor without one; its inclination shows the posture.  ``notes``: messages on the tracker
        and its sensors that are sent at the start.
        """
        self._identity = identity
        self._sensors = UnitSensors(identity.sensors)
        self._tracker = tracker
        self._header_factory = header_factory
        self._positions = PositionPublisher(header_factory, position_rate_hz)
        self._places = {one.name: one.description.place or worn_on for one in identity.sensors}
        self._body = BodyPostureEstimator()
        self._mounting: MountingCheck | None = None
        self._foot_sensor: str | None = None
        self._check_mounting(foot_sensor)
        self._choice: Choice | None = None
        self._notes = notes
        self._steps_by_fixes = StepScaleByFixes()
        self._expected_field = ExpectedField(identity.place)
        self._status_times = Decimator(STATUS.regular_rate_hz)
        self._raw_uplink = raw_uplink
        self._description_times = Decimator(
            DESCRIPTION.regular_rate_hz if raw_uplink is None else _DESCRIPTION_FOR_TRACKER_HZ
        )
        self._auxiliary = AuxiliarySamples(header_factory)
        self._battery: float | None = None
        self._mayday = MaydayButton(is_active=mayday)
        self._preflight: tuple[PreflightFinding, ...] | None = None
        self._journal_pending = 0

    def start(self) -> tuple[Message, ...]:
        """Return the unit's first messages."""
        first: tuple[Message, ...] = (
            self._event(EventKind.STARTED, None, self._identity.source),
            self._describe(None),
            *(self._event(EventKind.SENSOR_FAULT, None, note) for note in self._notes),
        )
        if not self._mayday.is_active:
            return first
        return (*first, self._event(EventKind.MAYDAY, None, "still latched after a restart"))

    @property
    def is_mayday_active(self) -> bool:
        return self._mayday.is_active

    @property
    def motionless_s(self) -> float:
        return self._sensors.monitor.motionless_s

    @property
    def is_worn(self) -> bool:
        """True once it has moved for a while: a unit that lies on a shelf is not worn."""
        return self._sensors.monitor.moving_s >= _WORN_S

    @property
    def walked_step_scales(self) -> Mapping[str, StepScale]:
        """Scales of the wearer's steps that this walk has shown, by place of the sensor."""
        if not isinstance(self._tracker, LearnsSteps):
            return {}
        place, by_fixes = self._tracker.scaled_place, self._steps_by_fixes.scale
        if place is None or by_fixes is None:
            return self._tracker.walked_step_scales
        start = self._tracker.start_scales.get(place)
        factor = 1.0 if start is None else start.factor
        return {place: StepScale(factor * by_fixes.factor, factor * by_fixes.std)}

    @property
    def is_on_foot(self) -> bool:
        """False once the motion has contradicted what the tracker needs."""
        return self._mounting is None or self._mounting.is_on_foot

    @property
    def battery(self) -> float | None:
        """Level of the emptiest battery by its last reading, 0 ... 1; None: not known."""
        return self._battery

    def take_presses(
        self, presses: Iterable[ButtonPress], timeline: Timeline = LIVE
    ) -> tuple[Message, ...]:
        """Return the messages of presses of the button; needs neither tracker nor sensor."""
        presses = tuple(presses)
        if presses:
            self._sensors.note_press()
        return tuple(
            message
            for press in presses
            for message in self._take_button(press, timeline.to_mono_ns(press.t_ns))
        )

    def step(self, batch: SensorBatch, timeline: Timeline = LIVE) -> tuple[Message, ...]:
        """Take one batch, quantised as by ``sample_codec``; return the messages to send.

        Its presses are for ``take_presses``, before it.
        """
        sensor, as_sampled, own_timeline = batch.sensor, batch.imu, timeline
        batch, timeline, faults = self._sensors.take(batch, timeline)
        self._update_earth_field(batch, timeline)
        imu = self._sensors.correct(sensor, batch.imu)
        track = self._tracker.push(sensor, imu) if len(imu) else empty_rows()
        messages: list[Message] = [
            self._event(EventKind.SENSOR_FAULT, _last_ns(batch, timeline), fault)
            for fault in faults
        ]
        messages += self._follow_choice(batch, timeline)
        for sample in batch.others:
            if isinstance(sample, GpsSample):
                self._steps_by_fixes.take_fix(sample)
            messages += self._auxiliary.take(sample, timeline.to_mono_ns(sample.t_ns))
        if self._raw_uplink is not None:
            messages += self._raw_uplink.push(as_sampled, own_timeline, sensor)
        if self._mounting is not None and sensor == self._foot_sensor:
            self._mounting.push(imu)
            self._positions.set_mounting(is_on_foot=self._mounting.is_on_foot)
        if self._sensors.is_barometer(sensor):
            self._positions.take_pressure(batch.imu)
        messages += self._publish(track, timeline)
        self._body.push(self._places.get(sensor, ""), imu)
        if self._sensors.watch(sensor, imu, track):
            detail = "fell and has not moved since"
            messages.append(self._event(EventKind.FALL, _last_ns(batch, timeline), detail))
        if not len(as_sampled) or self._sensors.leads(sensor):
            messages += self._periodic(batch, timeline)
        return tuple(messages)

    def finish(self, timeline: Timeline = LIVE) -> tuple[Message, ...]:
        """Return the rows that the tracker still held back, or the samples that were not sent
        yet.
        """
        messages: list[Message] = [*self._publish(self._tracker.finish(), timeline)]
        if self._raw_uplink is not None:
            messages += self._raw_uplink.finish(timeline)
        return tuple(messages)

    def set_position_rate(self, rate_hz: float) -> None:
        self._positions.set_rate(rate_hz)

    def set_preflight(self, findings: tuple[PreflightFinding, ...]) -> UnitDescription:
        """Set the result of the check at the start; return the new description."""
        self._preflight = findings
        return self._describe(None)

    def set_journal_pending(self, pending: int) -> None:
        """Set the number of messages without a confirmed arrival, for the next status."""
        self._journal_pending = pending

    def _publish(self, track: TrackBatch, timeline: Timeline) -> list[Position]:
        self._positions.set_path_noise(self._tracker.path_noise)
        if isinstance(self._tracker, LearnsSteps) and self._tracker.scaled_place is not None:
            self._steps_by_fixes.push(track, self._tracker.path_noise)
        return self._positions.push(track, timeline)

    def _follow_choice(self, batch: SensorBatch, timeline: Timeline) -> list[Message]:
        """Return the description that names the tracker, once the tracker has chosen itself, and
        what does not fit it.
        """
        tracker = self._tracker
        if not isinstance(tracker, ChoosesTracker) or tracker.choice is self._choice:
            return []
        self._choice = tracker.choice
        if self._choice is None:
            return []
        self._check_mounting(self._choice.foot_sensor)
        mono_ns = _last_ns(batch, timeline)
        return [
            self._describe(mono_ns),
            *(self._event(EventKind.SENSOR_FAULT, mono_ns, note) for note in self._choice.notes),
        ]

    def _check_mounting(self, foot_sensor: str | None) -> None:
        self._foot_sensor = foot_sensor
        self._mounting = None if foot_sensor is None else MountingCheck()

    def _update_earth_field(self, batch: SensorBatch, timeline: Timeline) -> None:
        def utc_ns_of(t_ns: int) -> int:
            return self._header_factory.utc_ns(timeline.to_mono_ns(t_ns))

        learned = self._expected_field.take(batch, utc_ns_of)
        if learned is not None:
            self._tracker.set_earth_field(*learned)

    def _take_button(self, press: ButtonPress, mono_ns: int) -> list[Message]:
        kind = self._mayday.event_of(press)
        return [] if kind is None else [self._event(kind, mono_ns, "button")]

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
        battery = self._auxiliary.emptiest_battery(t_ns)
        self._battery = None if battery is None else battery.level
        posture, confidence = self._body.posture(t_ns)
        on_foot = self._mounting is not None
        return Status(
            header=self._header_factory.header(timeline.to_mono_ns(t_ns)),
            activity=self._sensors.monitor.activity(t_ns),
            motionless_s=self._sensors.monitor.motionless_s,
            battery=None if battery is None else battery.level,
            mayday=self._mayday.is_active,
            steps=self._sensors.monitor.steps,
            cadence_hz=self._sensors.monitor.cadence_hz(t_ns),
            floors_climbed=self._positions.floors_climbed,
            tracker_rows_dropped=self._positions.rows_dropped,
            journal_pending=self._journal_pending,
            electronics=self._auxiliary.electronics(t_ns),
            battery_left_s=None if battery is None else whole_seconds(battery.left_s),
            battery_state=BatteryState.UNKNOWN if battery is None else battery.state,
            battery_name="" if battery is None else battery.battery,
            posture=posture,
            posture_confidence=confidence,
            mobility=(self._sensors.monitor if on_foot else self._body).mobility(t_ns),
        )

    def _describe(self, mono_ns: int | None) -> UnitDescription:
        choice = self._choice or Choice(self._identity.tracker)
        described = described_unit(
            self._header_factory.header(mono_ns),
            [one.as_sent(choice.recognised.get(one.name, "")) for one in self._identity.sensors],
            software_version=self._identity.software_version,
            source=self._identity.source,
            tracker=choice.tracker,
            has_gps=self._auxiliary.has_gps,
        )
        return msgspec.structs.replace(
            described, outputs=self._identity.outputs, preflight=self._preflight
        )

    def _event(self, kind: EventKind, mono_ns: int | None, detail: str) -> UnitEvent:
        return UnitEvent.of(self._header_factory.header(mono_ns), kind, detail)


def _last_source_ns(batch: SensorBatch) -> int | None:
    if len(batch.imu):
        return int(batch.imu.t_ns[-1])
    return max((sample.t_ns for sample in batch.others), default=None)


def _last_ns(batch: SensorBatch, timeline: Timeline) -> int | None:
    t_ns = _last_source_ns(batch)
    return None if t_ns is None else timeline.to_mono_ns(t_ns)
