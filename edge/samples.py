"""Samples that a wearable's sensors deliver: batches with their own time.

Axes are the sensor's own (any mount); at rest the accelerometer shows the
specific force that holds the sensor up, about +9.81 m/s^2 pointing away from
the ground.  Times are the unit's monotonic clock in integer nanoseconds.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Annotated

import numpy as np
from msgspec import Meta
from numpy.typing import NDArray

from shared.messages import BatteryState

Floats = NDArray[np.float64]
Nanoseconds = NDArray[np.int64]


@dataclass(frozen=True, slots=True, eq=False)
class ImuBatch:
    """Consecutive inertial samples of one sensor; ``n`` may be 1.

    Optional columns are ``None`` when the unit has no such sensor and hold NaN
    where a sample was missed.
    """

    t_ns: Nanoseconds  # (n,) monotonic
    accel_mps2: Floats  # (n, 3) specific force, sensor axes
    gyro_radps: Floats  # (n, 3) angular rate, sensor axes
    mag_ut: Floats | None = None  # (n, 3) magnetic flux density, sensor axes
    pressure_pa: Floats | None = None  # (n,) static air pressure
    imu_temperature_degc: Floats | None = None  # (n,) inside the sensor

    def __len__(self) -> int:
        return len(self.t_ns)

    def part(self, rows: slice) -> ImuBatch:
        """The samples of some rows, sharing memory with these."""

        def of(values: Floats | None) -> Floats | None:
            return None if values is None else values[rows]

        return ImuBatch(
            t_ns=self.t_ns[rows],
            accel_mps2=self.accel_mps2[rows],
            gyro_radps=self.gyro_radps[rows],
            mag_ut=of(self.mag_ut),
            pressure_pa=of(self.pressure_pa),
            imu_temperature_degc=of(self.imu_temperature_degc),
        )


@dataclass(frozen=True, slots=True)
class AmbientSample:
    """Temperature around the equipment (not of the wearer)."""

    t_ns: int
    temperature_degc: float
    sensor: str = ""  # name; empty: the unit's only one


@dataclass(frozen=True, slots=True)
class ElectronicsSample:
    """Temperature inside the unit: it shows whether the unit will last, and nothing of the air."""

    t_ns: int
    temperature_degc: float
    sensor: str


@dataclass(frozen=True, slots=True)
class GpsSample:
    """Fix of a satellite receiver, WGS-84; ``nan`` where it is not known."""

    t_ns: int  # monotonic time at which the fix is valid
    lat_deg: float
    lon_deg: float
    height_m: float  # above the ellipsoid
    horizontal_std_m: float
    vertical_std_m: float
    fix_type: int  # 0 none, 2 two-dimensional, 3 three-dimensional (as gpsd's mode)
    satellites: int
    speed_mps: float
    course_rad: float  # clockwise from true north


@dataclass(frozen=True, slots=True)
class ApproximatePosition:
    """Position where a unit is used, to some kilometres."""

    lat_deg: Annotated[float, Meta(ge=-90.0, le=90.0)]
    lon_deg: Annotated[float, Meta(ge=-180.0, le=180.0)]


@dataclass(frozen=True, slots=True)
class BatterySample:
    t_ns: int
    level: float  # 0 empty ... 1 full
    left_s: float = math.nan  # until it is empty; ``nan`` where it is not known
    state: BatteryState = BatteryState.UNKNOWN
    battery: str = ""  # name; empty: that of the sensor


MAYDAY, CANCEL, ACKNOWLEDGE = "mayday", "cancel", "acknowledge"


@dataclass(frozen=True, slots=True)
class ButtonPress:
    """Press of a button of the unit: ``MAYDAY``, ``CANCEL`` (takes a mayday back) or
    ``ACKNOWLEDGE`` (has understood the station).
    """

    t_ns: int
    button: str


BEACON, TAG, UNIT = "beacon", "tag", "unit"


@dataclass(frozen=True, slots=True)
class SightingSample:
    """Sighting of an identified thing nearby: a radio beacon, a tag that was scanned, or another
    unit.
    """

    t_ns: int
    kind: str  # BEACON, TAG or UNIT
    seen_id: str
    range_m: float  # ``nan`` where it is not measured
    range_std_m: float


OtherSample = (
    AmbientSample | ElectronicsSample | GpsSample | BatterySample | ButtonPress | SightingSample
)


@dataclass(frozen=True, slots=True)
class SensorBatch:
    """Batch that a source hands over at once: inertial samples of one sensor, and others that came
    with them.
    """

    imu: ImuBatch
    others: tuple[OtherSample, ...] = ()
    sensor: str = ""  # name of the inertial sensor; empty: the unit's only one


@dataclass(frozen=True, slots=True)
class SensorDescription:
    """Data sheet of a sensor; all a tracker may know about a recording in advance."""

    name: str
    rate_hz: float
    accel_full_scale_mps2: float | None = None
    gyro_full_scale_radps: float | None = None
    mag_present: bool = False
    barometer_present: bool = False
    gain_std: float | None = None  # relative error of scale and axes, 1 sigma; None: unknown
    gyro_bias_std_radps: float | None = None  # at the start, each axis, 1 sigma; None: unknown
    mag_iron_std_ut: float | None = None  # what its calibration left of iron; None: it has none
    mag_earth_ut: float | None = None  # as what it showed the earth's field in that calibration
    place: str = ""  # part of the body that wears it, see ``edge.body_places``; empty: unknown
    mount: str = ""  # how it is fastened, in words
