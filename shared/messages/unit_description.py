"""Description of a unit, sent at its start and every minute."""

from __future__ import annotations

from enum import IntEnum

import msgspec

from shared.coded_text import NO_CODE, TextCode, code_of_text
from shared.messages.header import Header
from shared.messages.known import known
from shared.messages.muster.v1 import unit_description_pb2
from shared.messages.quantise import unsigned32
from shared.messages.text_code import get_text_code, put_text_code


class PreflightLevel(IntEnum):
    UNKNOWN = 0
    WARNING = 1  # it works, and something of it is missing or weak
    FAILED = 2  # its wearer is not tracked, or not heard


class PreflightFinding(msgspec.Struct, frozen=True):
    """Finding of a unit's check at its start: something defective or missing."""

    level: PreflightLevel
    subject: str  # a word or two
    text: str  # what was found
    remedy: str = ""  # what it costs, or what to do
    subject_code: TextCode = NO_CODE  # of ``subject``, where it has one
    text_code: TextCode = NO_CODE  # of ``text``, where it has one

    def __hash__(self) -> int:
        """Without the codes, which have dictionaries and follow from the texts."""
        return hash((self.level, self.subject, self.text, self.remedy))

    @staticmethod
    def of(level: PreflightLevel, subject: str, text: str, remedy: str) -> PreflightFinding:
        """With the codes of subject and text, where they have some."""
        codes = code_of_text(subject), code_of_text(text)
        return PreflightFinding(level, str(subject), str(text), remedy, *codes)

    def to_wire(self) -> unit_description_pb2.PreflightFinding:
        wire = unit_description_pb2.PreflightFinding(
            level=int(self.level),  # type: ignore[arg-type]  # stubs want the generated enum
            subject=self.subject,
            text=self.text,
            remedy=self.remedy,
        )
        if self.subject_code.code:
            put_text_code(wire.subject_code, self.subject_code)
        if self.text_code.code:
            put_text_code(wire.text_code, self.text_code)
        return wire

    @staticmethod
    def from_wire(wire: unit_description_pb2.PreflightFinding) -> PreflightFinding:
        return PreflightFinding(
            level=known(PreflightLevel, wire.level),
            subject=wire.subject,
            text=wire.text,
            remedy=wire.remedy,
            subject_code=get_text_code(wire.subject_code),
            text_code=get_text_code(wire.text_code),
        )


class UnitSensor(msgspec.Struct, frozen=True):
    """Inertial sensor of a unit, and where its wearer has it."""

    name: str  # in the unit; empty: its only one
    place: str  # part of the body, such as left_foot; empty: unknown
    model: str
    rate_hz: float
    accel_full_scale_mps2: float | None
    gyro_full_scale_radps: float | None
    has_magnetometer: bool
    has_barometer: bool
    place_recognised: bool = False  # by its motion; else the place is that of the settings
    mount: str = ""  # how it is fastened, in words
    calibration: str = ""  # identity of the calibration in use; empty: none
    calibrated_s: int | None = None  # UTC seconds at which it was made; None: no calibration
    calibration_faults: str = ""
    gain_std: float | None = None  # how far scale and axes may be off; None: unknown
    gyro_bias_std_radps: float | None = None  # of each axis, as it is sent; None: unknown

    def to_wire(self) -> unit_description_pb2.UnitSensor:
        return unit_description_pb2.UnitSensor(
            name=self.name,
            place=self.place,
            place_recognised=self.place_recognised,
            mount=self.mount,
            model=self.model,
            rate_mhz=unsigned32(self.rate_hz, 1e3),
            accel_full_scale_mmps2=unsigned32(self.accel_full_scale_mps2 or 0.0, 1e3),
            gyro_full_scale_mradps=unsigned32(self.gyro_full_scale_radps or 0.0, 1e3),
            has_magnetometer=self.has_magnetometer,
            has_barometer=self.has_barometer,
            calibration=self.calibration,
            calibrated_s=self.calibrated_s or 0,
            calibration_faults=self.calibration_faults,
            gain_std_ppm=_millionths(self.gain_std),
            gyro_bias_std_uradps=_millionths(self.gyro_bias_std_radps),
        )

    @staticmethod
    def from_wire(wire: unit_description_pb2.UnitSensor) -> UnitSensor:
        return UnitSensor(
            name=wire.name,
            place=wire.place,
            place_recognised=wire.place_recognised,
            mount=wire.mount,
            model=wire.model,
            rate_hz=wire.rate_mhz * 1e-3,
            accel_full_scale_mps2=wire.accel_full_scale_mmps2 * 1e-3 or None,
            gyro_full_scale_radps=wire.gyro_full_scale_mradps * 1e-3 or None,
            has_magnetometer=wire.has_magnetometer,
            has_barometer=wire.has_barometer,
            calibration=wire.calibration,
            calibrated_s=wire.calibrated_s or None,
            calibration_faults=wire.calibration_faults,
            gain_std=_from_millionths(wire.gain_std_ppm),
            gyro_bias_std_radps=_from_millionths(wire.gyro_bias_std_uradps),
        )


class UnitDescription(msgspec.Struct, frozen=True):
    header: Header
    software_version: str
    source: str  # where its samples come from
    sensor_name: str
    rate_hz: float
    accel_full_scale_mps2: float | None
    gyro_full_scale_radps: float | None
    tracker: str
    calibration: str  # identity of the calibration in use; empty: none
    has_magnetometer: bool
    has_barometer: bool
    has_gps: bool
    calibrated_s: int | None = None  # UTC seconds at which it was made; None: no calibration
    calibration_faults: str = ""  # what is poor about it, in words; empty: nothing
    gain_std: float | None = None  # how far scale and axes may be off; None: unknown
    outputs: tuple[str, ...] = ()  # kinds of outputs that notify the wearer; empty: it has none
    # The gravest first; None: the check is not over, or this version makes none.
    preflight: tuple[PreflightFinding, ...] | None = None
    # The first is also described above; empty: of an earlier version, whose unit had one.
    sensors: tuple[UnitSensor, ...] = ()

    def to_wire(self) -> unit_description_pb2.UnitDescription:
        return unit_description_pb2.UnitDescription(
            header=self.header.to_wire(),
            software_version=self.software_version,
            source=self.source,
            sensor_name=self.sensor_name,
            rate_mhz=unsigned32(self.rate_hz, 1e3),
            accel_full_scale_mmps2=unsigned32(self.accel_full_scale_mps2 or 0.0, 1e3),
            gyro_full_scale_mradps=unsigned32(self.gyro_full_scale_radps or 0.0, 1e3),
            tracker=self.tracker,
            calibration=self.calibration,
            has_magnetometer=self.has_magnetometer,
            has_barometer=self.has_barometer,
            has_gps=self.has_gps,
            calibrated_s=self.calibrated_s or 0,
            calibration_faults=self.calibration_faults,
            gain_std_ppm=_millionths(self.gain_std),
            outputs=self.outputs,
            preflight_done=self.preflight is not None,
            preflight=[one.to_wire() for one in self.preflight or ()],
            sensors=[one.to_wire() for one in self.sensors],
        )

    @staticmethod
    def from_wire(wire: unit_description_pb2.UnitDescription) -> UnitDescription:
        return UnitDescription(
            header=Header.from_wire(wire.header),
            software_version=wire.software_version,
            source=wire.source,
            sensor_name=wire.sensor_name,
            rate_hz=wire.rate_mhz * 1e-3,
            accel_full_scale_mps2=wire.accel_full_scale_mmps2 * 1e-3 or None,
            gyro_full_scale_radps=wire.gyro_full_scale_mradps * 1e-3 or None,
            tracker=wire.tracker,
            calibration=wire.calibration,
            has_magnetometer=wire.has_magnetometer,
            has_barometer=wire.has_barometer,
            has_gps=wire.has_gps,
            calibrated_s=wire.calibrated_s or None,
            calibration_faults=wire.calibration_faults,
            gain_std=_from_millionths(wire.gain_std_ppm),
            outputs=tuple(wire.outputs),
            preflight=tuple(map(PreflightFinding.from_wire, wire.preflight))
            if wire.preflight_done
            else None,
            sensors=tuple(map(UnitSensor.from_wire, wire.sensors)),
        )


def _millionths(std: float | None) -> int:
    """Deviation in millionths; 0 says that nothing is known, and none at all is sent as 1."""
    return 0 if std is None else max(unsigned32(std, 1e6), 1)


def _from_millionths(sent: int) -> float | None:
    return sent / 1e6 if sent else None
