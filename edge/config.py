"""Settings of the agent; every default stands here."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path
from typing import Annotated

from msgspec import Meta

from edge.samples import ApproximatePosition
from shared.log import LogFormat, LogLevel

POSITION_RATE_HZ = (0.1, 50.0)


@dataclass(frozen=True, slots=True)
class StorageConfig:
    """Limits of what the agent stores on its disk."""

    journal_mb: Annotated[float, Meta(ge=1.0, le=1e6)] = 512.0
    black_box_mb: Annotated[float, Meta(ge=1.0, le=1e6)] = 4096.0  # the oldest segments go first


@dataclass(frozen=True, slots=True)
class EdgeConfig:
    """Settings of one agent."""

    source: str  # recording:PATH, simulated:SCENARIO, ximu3:tcp://HOST, iio:NAME ...
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
    tracker: str = "eskf"  # none: an agent elsewhere tracks, from the raw samples (bus:UNIT)
    calibration: Path | None = None  # from `muster edge calibrate`; none: sensors as they are
    gain_std: Annotated[float, Meta(ge=0.0, le=0.2)] | None = None  # none: as the source says
    place: ApproximatePosition | None = (
        None  # roughly where it is used, for the magnetic field; none: by GPS
    )
    position_rate_hz: Annotated[float, Meta(ge=POSITION_RATE_HZ[0], le=POSITION_RATE_HZ[1])] = 5.0
    speed: Annotated[float, Meta(ge=0.01, le=1000.0)] = 1.0  # at which recordings are played
    log_level: LogLevel = "INFO"
    log_format: LogFormat = "text"
    storage: StorageConfig = field(default_factory=StorageConfig)
