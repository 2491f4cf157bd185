"""Settings of the agent; every default stands here."""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from difflib import get_close_matches
from pathlib import Path
from typing import Annotated

from msgspec import Meta

from edge.body_places import PLACES
from edge.samples import ApproximatePosition
from shared.errors import ConfigError
from shared.log import LogFormat, LogLevel

POSITION_RATE_HZ = (0.1, 50.0)
_SENSOR_NAME = re.compile(r"[A-Za-z0-9_-]{1,32}")
GainStd = Annotated[float, Meta(ge=0.0, le=0.2)]
GyroBiasStd = Annotated[float, Meta(ge=0.0, le=0.2)]  # rad/s


@dataclass(frozen=True, slots=True)
class StorageConfig:
    """Limits of what the agent stores on its disk."""

    journal_mb: Annotated[float, Meta(ge=1.0, le=1e6)] = 512.0
    black_box_mb: Annotated[float, Meta(ge=1.0, le=1e6)] = 4096.0  # the oldest segments go first


@dataclass(frozen=True, slots=True)
class SensorConfig:
    """Settings of one of the inertial sensors of a unit."""

    name: str = ""  # in the unit; empty: its only one
    source: str = ""  # recording:PATH, ximu3:tcp://HOST ...; empty: it is one of the unit's source
    worn_on: str = ""  # part of the body, see ``PLACES``; empty: by its name, else recognised
    mount: str = ""  # how it is fastened, in words
    calibration: Path | None = None  # from `muster edge calibrate`; none: as it is
    gain_std: GainStd | None = None  # none: as the source says
    gyro_bias_std_radps: GyroBiasStd | None = None  # none: as the source says

    def __post_init__(self) -> None:
        _check_place(self.worn_on)

    @property
    def place(self) -> str:
        """Part of the body: as set, else by the name where that is one; empty: unknown."""
        return self.worn_on or (self.name if self.name in PLACES else "")


def _check_place(worn_on: str) -> None:
    if worn_on and worn_on not in PLACES:
        near = get_close_matches(worn_on, PLACES, n=1)
        hint = f"did you mean {near[0]}? " if near else ""
        raise ConfigError(
            f"worn_on {worn_on!r} is no place for a sensor; {hint}Known are {', '.join(PLACES)}"
        )


@dataclass(frozen=True, slots=True)
class WearerConfig:
    """Wearer, and measures for the trackers that use them; None: not measured."""

    # By which the unit keeps what it learns of the wearer's steps; empty: nothing is kept.
    person: Annotated[str, Meta(max_length=128)] = ""
    height_m: Annotated[float, Meta(ge=1.0, le=2.5)] | None = None
    # Hip joint to sole, in shoes.  One that nobody has stops no unit: it is reported and not used.
    leg_length_m: Annotated[float, Meta(ge=0.0, le=1000.0)] | None = None


@dataclass(frozen=True, slots=True)
class EdgeConfig:
    """Settings of one agent."""

    source: str = ""  # recording:PATH, simulated:SCENARIO, ximu3:tcp://HOST, iio:NAME ...
    # Of several sensors on one person, in place of ``source``; or settings of sensors in it.
    sensors: tuple[SensorConfig, ...] = ()
    worn_on: str = ""  # part of the body that wears the only sensor; empty: recognised
    mount: str = ""  # how it is fastened, in words
    sightings: str = ""  # a reader of beacons and tags: tcp:HOST:PORT or a device's path
    gps: str = ""  # a satellite receiver: gpsd://HOST, nmea:/dev/PORT, nmea:tcp://HOST:PORT
    temperatures: tuple[str, ...] = ()  # sensors: hwmon:CHIP, iio:DEVICE, w1:ID, ?name=&role=
    battery: str = ""  # of the unit's computer: a power supply's name, or auto; empty: none
    button: str = ""  # the wearer's: evdev:NAME?key=KEY_POWER; empty: none, or of the source
    outputs: tuple[
        str, ...
    ] = ()  # to the wearer: led:NAME, beeper:/dev/input/DEVICE, sound:default
    unit: str = ""  # unique among the units of a station; empty: as enrolled
    enrolment: Path | None = None  # file or picture of its code; none: the link is not secured
    # The station; empty: as enrolled, else tcp/127.0.0.1:7447; discover: by multicast DNS, too.
    connect: tuple[str, ...] = ()
    data: Path = Path("muster-edge")  # a folder of its own for each unit is made in it
    # by-place: by where the sensors are worn, on a foot where that is not set; auto: likewise, and
    # recognised by their motion where it is not set; none: an agent elsewhere tracks, from the raw
    # samples (bus:UNIT).
    tracker: str = "by-place"
    calibration: Path | None = None  # from `muster edge calibrate`; none: sensors as they are
    gain_std: GainStd | None = None  # none: as the source says
    gyro_bias_std_radps: GyroBiasStd | None = None  # none: as the source says
    place: ApproximatePosition | None = (
        None  # roughly where it is used, for the magnetic field; none: by GPS
    )
    position_rate_hz: Annotated[float, Meta(ge=POSITION_RATE_HZ[0], le=POSITION_RATE_HZ[1])] = 5.0
    speed: Annotated[float, Meta(ge=0.01, le=1000.0)] = 1.0  # at which recordings are played
    log_level: LogLevel = "INFO"
    log_format: LogFormat = "text"
    storage: StorageConfig = field(default_factory=StorageConfig)
    wearer: WearerConfig = field(default_factory=WearerConfig)

    def __post_init__(self) -> None:
        if not self.source and not self.sensors:
            raise ConfigError("source is missing, and there is no usual value")
        if not self.sensors:
            _check_place(self.worn_on)
            return
        if self.has_settings_of_one_sensor:
            raise ConfigError(
                "worn_on, mount, calibration, gain_std and gyro_bias_std_radps are settings of the "
                "only sensor; of several, give them in each of [[sensors]]"
            )
        self._check_sensors()

    def _check_sensors(self) -> None:
        names = [sensor.name for sensor in self.sensors]
        for sensor in self.sensors:
            if not _SENSOR_NAME.fullmatch(sensor.name) or names.count(sensor.name) > 1:
                raise ConfigError(
                    f"sensor name {sensor.name!r} cannot be used: give each sensor of a unit a "
                    "name of its own, of at most 32 letters, digits, '-' and '_'"
                )
            if self.source and sensor.source:
                raise ConfigError(
                    f"sensor {sensor.name} has a source of its own beside source = "
                    f"{self.source!r}; give one or the other"
                )
            if not self.source and (not sensor.source or sensor.source.startswith("bus:")):
                raise ConfigError(
                    f"sensor {sensor.name} needs a source of its own; bus:UNIT is none, as it is "
                    "a whole unit: give that as source"
                )

    @property
    def has_settings_of_one_sensor(self) -> bool:
        """True where settings of the only sensor are given."""
        deviations = self.gain_std, self.gyro_bias_std_radps
        given = any((self.worn_on, self.mount, self.calibration))
        return given or any(one is not None for one in deviations)

    @property
    def source_text(self) -> str:
        """Source or sources, for a person."""
        if self.source:
            return self.source
        return " ".join(f"{sensor.name}={sensor.source}" for sensor in self.sensors)

    def sensor(self, name: str) -> SensorConfig:
        """Return the settings of the sensor of this name; the usual ones where it has none."""
        if not self.sensors:
            return SensorConfig(
                name,
                self.source,
                self.worn_on,
                self.mount,
                self.calibration,
                self.gain_std,
                self.gyro_bias_std_radps,
            )
        found = (sensor for sensor in self.sensors if sensor.name == name)
        return next(found, SensorConfig(name))
