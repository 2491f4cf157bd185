"""Descriptions of a unit and its sensors: the agent's data sheets to messages and back."""

from __future__ import annotations

from collections.abc import Sequence

from edge.samples import SensorDescription
from shared.messages import Header, UnitDescription, UnitSensor


def unit_sensor(name: str, sensor: SensorDescription) -> UnitSensor:
    """Return the data sheet of the unit's sensor of this name as it is sent, not calibrated."""
    return UnitSensor(
        name=name,
        place=sensor.place,
        mount=sensor.mount,
        model=sensor.name,
        rate_hz=sensor.rate_hz,
        accel_full_scale_mps2=sensor.accel_full_scale_mps2,
        gyro_full_scale_radps=sensor.gyro_full_scale_radps,
        has_magnetometer=sensor.mag_present,
        has_barometer=sensor.barometer_present,
        gain_std=sensor.gain_std,
        gyro_bias_std_radps=sensor.gyro_bias_std_radps,
    )


def described_unit(
    header: Header,
    sensors: Sequence[UnitSensor],
    *,
    software_version: str,
    source: str,
    tracker: str,
    has_gps: bool = False,
) -> UnitDescription:
    """Return the description of a unit of these sensors, at least one."""
    first = sensors[0]
    return UnitDescription(
        header=header,
        software_version=software_version,
        source=source,
        sensor_name=first.model,
        rate_hz=first.rate_hz,
        accel_full_scale_mps2=first.accel_full_scale_mps2,
        gyro_full_scale_radps=first.gyro_full_scale_radps,
        tracker=tracker,
        calibration=first.calibration,
        has_magnetometer=first.has_magnetometer,
        has_barometer=first.has_barometer,
        has_gps=has_gps,
        calibrated_s=first.calibrated_s,
        calibration_faults=first.calibration_faults,
        gain_std=first.gain_std,
        sensors=tuple(sensors),
    )


def sensors_of(description: UnitDescription) -> dict[str, SensorDescription]:
    """Return the data sheets in ``description`` by the sensors' names, as the wire gives them back.

    A description of an earlier version has one sensor without a name.
    """
    through = UnitDescription.from_wire(description.to_wire())
    if not through.sensors:
        return {"": _only_sensor(through)}
    return {one.name: sensor_of(one) for one in through.sensors}


def sensor_of(sent: UnitSensor) -> SensorDescription:
    """Return the data sheet in ``sent``, as the wire gives it back; a place that was recognised by
    motion is for the reader to recognise.
    """
    through = UnitSensor.from_wire(sent.to_wire())
    return SensorDescription(
        name=through.model,
        rate_hz=through.rate_hz,
        accel_full_scale_mps2=through.accel_full_scale_mps2,
        gyro_full_scale_radps=through.gyro_full_scale_radps,
        mag_present=through.has_magnetometer,
        barometer_present=through.has_barometer,
        gain_std=through.gain_std,
        gyro_bias_std_radps=through.gyro_bias_std_radps,
        place="" if through.place_recognised else through.place,
        mount=through.mount,
    )


def _only_sensor(description: UnitDescription) -> SensorDescription:
    return SensorDescription(
        name=description.sensor_name,
        rate_hz=description.rate_hz,
        accel_full_scale_mps2=description.accel_full_scale_mps2,
        gyro_full_scale_radps=description.gyro_full_scale_radps,
        mag_present=description.has_magnetometer,
        barometer_present=description.has_barometer,
        gain_std=description.gain_std,
    )
