"""Codec of sensor batches: samples as messages and back.

The wire quantises.  An agent therefore takes its samples through here before it uses them,
and a replay of the black box gives the same positions to the last bit.

A sample travels as the message whose fields it has: ambient temperature as Temperature, a
fix as GpsFix, something seen as a Sighting, the battery's level and a temperature inside the unit
as a Status of unknown activity, a button as the UnitEvent that it causes.  Their headers carry the
sample's own time and sequence number 0: they are not part of the unit's journal.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import msgspec
import numpy as np

from edge.sample_codec.descriptions import described_unit
from edge.samples import (
    ACKNOWLEDGE,
    BEACON,
    CANCEL,
    MAYDAY,
    TAG,
    UNIT,
    AmbientSample,
    BatterySample,
    ButtonPress,
    ElectronicsSample,
    GpsSample,
    ImuBatch,
    OtherSample,
    SensorBatch,
    SightingSample,
)
from shared.messages import (
    Activity,
    EventKind,
    FixType,
    GpsFix,
    Header,
    Message,
    RawImu,
    SensorTemperature,
    Sighting,
    SightingKind,
    Status,
    Temperature,
    UnitDescription,
    UnitEvent,
    UnitSensor,
)

_EVENT_OF_BUTTON = {
    MAYDAY: EventKind.MAYDAY,
    CANCEL: EventKind.MAYDAY_CANCELLED,
    ACKNOWLEDGE: EventKind.ACKNOWLEDGED,
}
_BUTTON_OF_EVENT = {kind: button for button, kind in _EVENT_OF_BUTTON.items()}
_KIND_OF_SIGHTING = {
    BEACON: SightingKind.BEACON,
    TAG: SightingKind.TAG,
    UNIT: SightingKind.UNIT,
}
_SIGHTING_OF_KIND = {kind: name for name, kind in _KIND_OF_SIGHTING.items()}


class SampleEncoder:
    """Encoder of one unit's batches."""

    def __init__(self, unit_id: str, boot_id: int) -> None:
        self._unit_id = unit_id
        self._boot_id = boot_id

    def messages(self, batch: SensorBatch) -> tuple[Message, ...]:
        """Return the batch as messages, inertial samples first; empty samples are left out."""
        imu = batch.imu
        raw: list[Message] = []
        if len(imu):
            header = self._header(int(imu.t_ns[0]))
            raw.append(_through_wire(raw_imu(header, imu, batch.sensor)))
        for sample in batch.others:
            message = _message_of(self._header(sample.t_ns), sample)
            if message is not None:
                raw.append(message)
        return tuple(raw)

    def description(
        self, t_ns: int, sensors: Sequence[UnitSensor], *, source: str, tracker: str
    ) -> UnitDescription:
        """Return the description of the source of the samples that follow; they are not
        calibrated.
        """
        return described_unit(
            self._header(t_ns), sensors, software_version="", source=source, tracker=tracker
        )

    def _header(self, t_ns: int) -> Header:
        return Header(unit_id=self._unit_id, boot_id=self._boot_id, seq=0, t_mono_ns=t_ns)


def batch_of(raw: tuple[Message, ...]) -> SensorBatch:
    """Return the batch that ``SampleEncoder.messages`` made ``raw`` from, quantised."""
    imu, sensor = _EMPTY_IMU, ""
    others: list[OtherSample] = []
    for message in raw:
        if isinstance(message, RawImu):
            imu, sensor = _imu_batch(message), message.sensor
        else:
            sample = _sample_of(message)
            if sample is not None:
                others.append(sample)
    return SensorBatch(imu, tuple(others), sensor)


def gps_fix(header: Header, sample: GpsSample) -> GpsFix:
    """Return the message of a fix; without coordinates it is no fix, whatever the receiver calls
    it.
    """
    located = abs(sample.lat_deg) <= 90.0 and abs(sample.lon_deg) <= 180.0  # and not NaN
    three_d = math.isfinite(sample.height_m)
    fix_type = {2: FixType.TWO_D, 3: FixType.THREE_D}.get(sample.fix_type, FixType.NONE)
    if not three_d:
        fix_type = min(fix_type, FixType.TWO_D)
    return GpsFix(
        header=header,
        fix_type=fix_type if located else FixType.NONE,
        lat_deg=sample.lat_deg if located else 0.0,
        lon_deg=sample.lon_deg if located else 0.0,
        height_m=sample.height_m if three_d else 0.0,
        horizontal_std_m=_or_none(sample.horizontal_std_m),
        vertical_std_m=_or_none(sample.vertical_std_m),
        satellites=sample.satellites,
        speed_mps=_or_none(sample.speed_mps) or 0.0,
        course_rad=_or_none(sample.course_rad) or 0.0,
    )


def is_sendable(sample: SightingSample) -> bool:
    """Return True if the wire can represent what was seen."""
    return sample.kind in _KIND_OF_SIGHTING and sample.seen_id != ""


def sighting(header: Header, sample: SightingSample) -> Sighting:
    return Sighting(
        header=header,
        kind=_KIND_OF_SIGHTING[sample.kind],
        seen_id=sample.seen_id,
        range_m=_or_none(sample.range_m),
        range_std_m=_or_none(sample.range_std_m),
    )


def raw_imu(header: Header, imu: ImuBatch, sensor: str = "") -> RawImu:
    """Return the message, not rounded yet; the wire does that."""
    return RawImu(
        header=header,
        t_ns=imu.t_ns,
        accel_mps2=imu.accel_mps2,
        gyro_radps=imu.gyro_radps,
        mag_ut=imu.mag_ut,
        pressure_pa=imu.pressure_pa,
        imu_temperature_degc=imu.imu_temperature_degc,
        sensor=sensor,
    )


def _through_wire(raw: RawImu) -> RawImu:
    return RawImu.from_wire(raw.to_wire())


def _imu_batch(raw: RawImu) -> ImuBatch:
    return ImuBatch(
        t_ns=raw.t_ns,
        accel_mps2=raw.accel_mps2,
        gyro_radps=raw.gyro_radps,
        mag_ut=raw.mag_ut,
        pressure_pa=raw.pressure_pa,
        imu_temperature_degc=raw.imu_temperature_degc,
    )


_EMPTY_IMU = ImuBatch(np.empty(0, np.int64), np.empty((0, 3)), np.empty((0, 3)))


def _message_of(header: Header, sample: OtherSample) -> Message | None:
    match sample:
        case AmbientSample(temperature_degc=degc, sensor=name) if math.isfinite(degc):
            named = (SensorTemperature(name, degc),) if name else ()
            message = Temperature(header=header, ambient_degc=degc, sensors=named)
            return Temperature.from_wire(message.to_wire())
        case GpsSample():
            fix = gps_fix(header, sample)
            return GpsFix.from_wire(fix.to_wire())
        case BatterySample() | ElectronicsSample():
            status = _status_of(header, sample)
            return None if status is None else Status.from_wire(status.to_wire())
        case SightingSample() if is_sendable(sample):
            return Sighting.from_wire(sighting(header, sample).to_wire())
        case ButtonPress(button=button) if button in _EVENT_OF_BUTTON:
            return UnitEvent(header=header, kind=_EVENT_OF_BUTTON[button])
    return None


def _sample_of(message: Message) -> OtherSample | None:
    t_ns = message.header.t_mono_ns
    match message:
        case Temperature():
            name = message.sensors[0].name if message.sensors else ""
            return AmbientSample(t_ns, message.ambient_degc, name)
        case GpsFix():
            return _gps_sample(t_ns, message)
        case Status():
            return _sample_of_status(t_ns, message)
        case Sighting() if message.kind in _SIGHTING_OF_KIND:
            return SightingSample(
                t_ns,
                _SIGHTING_OF_KIND[message.kind],
                message.seen_id,
                math.nan if message.range_m is None else message.range_m,
                math.nan if message.range_std_m is None else message.range_std_m,
            )
        case UnitEvent() if message.kind in _BUTTON_OF_EVENT:
            return ButtonPress(t_ns, _BUTTON_OF_EVENT[message.kind])
    return None


def _sample_of_status(t_ns: int, status: Status) -> BatterySample | ElectronicsSample | None:
    if status.battery is not None:
        left_s = math.nan if status.battery_left_s is None else status.battery_left_s
        state, name = status.battery_state, status.battery_name
        return BatterySample(t_ns, status.battery, left_s, state, name)
    for reading in status.electronics:
        return ElectronicsSample(t_ns, reading.temperature_degc, reading.name)
    return None


def _gps_sample(t_ns: int, fix: GpsFix) -> GpsSample:
    located = fix.fix_type in (FixType.TWO_D, FixType.THREE_D)
    return GpsSample(
        t_ns=t_ns,
        lat_deg=fix.lat_deg if located else math.nan,
        lon_deg=fix.lon_deg if located else math.nan,
        height_m=fix.height_m if fix.fix_type is FixType.THREE_D else math.nan,
        horizontal_std_m=math.nan if fix.horizontal_std_m is None else fix.horizontal_std_m,
        vertical_std_m=math.nan if fix.vertical_std_m is None else fix.vertical_std_m,
        fix_type={FixType.TWO_D: 2, FixType.THREE_D: 3}.get(fix.fix_type, 0),
        satellites=fix.satellites,
        speed_mps=fix.speed_mps,
        course_rad=fix.course_rad,
    )


def whole_seconds(left_s: float) -> int | None:
    """Return the time left as the wire has it; None where it is not known."""
    return max(1, round(left_s)) if math.isfinite(left_s) and left_s >= 0.0 else None


def _status_of(header: Header, sample: BatterySample | ElectronicsSample) -> Status | None:
    """Return the status that carries a sample; None of one that is no number."""
    empty = Status(
        header=header,
        activity=Activity.UNKNOWN,
        motionless_s=0.0,
        battery=None,
        mayday=False,
        steps=0,
        cadence_hz=0.0,
        floors_climbed=0,
        tracker_rows_dropped=0,
        journal_pending=0,
    )
    if isinstance(sample, BatterySample):
        if not math.isfinite(sample.level):
            return None
        return msgspec.structs.replace(
            empty,
            battery=min(1.0, max(0.0, sample.level)),
            battery_left_s=whole_seconds(sample.left_s),
            battery_state=sample.state,
            battery_name=sample.battery,
        )
    if not math.isfinite(sample.temperature_degc):
        return None
    reading = SensorTemperature(sample.sensor, sample.temperature_degc)
    return msgspec.structs.replace(empty, electronics=(reading,))


def _or_none(value: float) -> float | None:
    return value if math.isfinite(value) and value > 0.0 else None
