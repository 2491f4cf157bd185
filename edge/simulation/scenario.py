"""Scenario of a simulated walk, as data: built in or read from a file."""

from __future__ import annotations

import tomllib
from difflib import get_close_matches
from math import pi
from pathlib import Path
from typing import Annotated, Any

import msgspec
from msgspec import Meta

from edge.simulation.beacons import BeaconPlace
from edge.simulation.legs import Degrees, Leg, Metres, Point, Segment
from shared.errors import ConfigError
from shared.geo import Anchor

Time = Annotated[float, Meta(ge=0.0, le=1e6)]
Warmth = Annotated[float, Meta(ge=-100.0, le=2000.0)]


class Scenario(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Positions are (north, east) metres in the site frame, times seconds from the start."""

    name: str
    summary: str
    legs: Annotated[tuple[Leg, ...], Meta(min_length=1)]
    loop: tuple[Leg, ...] = ()  # done again and again after ``legs`` until ``duration_s``
    duration_s: Annotated[float, Meta(ge=1.0, le=1e6)] = (
        3600.0  # of the looping; without a loop the walk ends with its legs
    )
    start: Point = (0.0, 0.0)
    heading_deg: Degrees = 0.0
    down_m: Metres = 0.0
    building: bool = False  # in the training house, or on open ground
    steel_ut: Annotated[float, Meta(ge=0.0, le=1e3)] = (
        3.0  # how far each of its waves bends the field
    )
    anchor: Anchor | None = None  # of the site frame, for GPS and the earth's field; the house's
    ambient_degc: tuple[tuple[Time, Warmth], ...] = ((0.0, 18.0),)  # (time, value), linear between
    radio_outages_s: tuple[tuple[Time, Time], ...] = ()  # (start, duration)
    beacons: tuple[BeaconPlace, ...] = ()  # seen by a receiver that the wearer carries
    battery_start: Annotated[float, Meta(ge=0.0, le=1.0)] = 0.95
    battery_life_s: Annotated[float, Meta(ge=1.0, le=1e9)] = 6 * 3600.0  # from full to empty
    acknowledges_every_s: Annotated[int, Meta(ge=1)] | None = None  # looks at the unit so often
    worn_on: Segment = "foot"
    rate_hz: Annotated[float, Meta(ge=20.0, le=5000.0)] = 200.0
    conversions: Annotated[int, Meta(ge=1, le=64)] = 1  # of which an inertial reading is the mean
    gyro_full_scale_degps: Annotated[float, Meta(ge=100.0, le=10_000.0)] | None = None  # else 2000
    accel_full_scale_g: Annotated[float, Meta(ge=1.0, le=1000.0)] | None = None  # else 16

    def __post_init__(self) -> None:
        times_s = [t_s for t_s, _ in self.ambient_degc]
        if not times_s or times_s != sorted(times_s):
            raise ValueError("ambient_degc must be [time, value] pairs in order of time")
        if self.anchor is not None and not _is_on_earth(self.anchor):
            raise ValueError("the anchor is no place on the earth")


def _is_on_earth(anchor: Anchor) -> bool:
    return (
        abs(anchor.lat_deg) <= 90.0
        and abs(anchor.lon_deg) <= 180.0
        and abs(anchor.height_m) < 1e4
        and abs(anchor.rotation_rad) <= 2.0 * pi
    )


def read_scenario(path: Path) -> Scenario:
    """Read a scenario from TOML whose keys are those of ``Scenario`` and of its legs.

    Raises ``ConfigError``, naming the place and for an unknown key the nearest known one.
    """
    try:
        table = tomllib.loads(path.read_text(encoding="utf-8"))
    except OSError as error:
        raise ConfigError(f"{path} cannot be read ({error.strerror}); check the path") from error
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
        raise ConfigError(f"{path} is not TOML: {error}") from error
    table = {"name": path.stem, "summary": f"from {path.name}", **table}
    _check_keys(path, "scenario", table, Scenario)
    for member in ("legs", "loop"):
        legs = table.get(member, [])
        if not isinstance(legs, list):
            raise ConfigError(f"{path}: {member} must be a list; write each leg below [[{member}]]")
        for index, leg in enumerate(legs):
            _check_leg(path, f"{member}[{index}]", leg)
    try:
        return msgspec.convert(table, Scenario)
    except msgspec.ValidationError as error:
        raise ConfigError(f"{path}: {error}") from error


def _check_leg(path: Path, place: str, leg: Any) -> None:
    kinds = {str(kind.__struct_config__.tag): kind for kind in Leg.__args__}
    if not isinstance(leg, dict) or leg.get("type") not in kinds:
        raise ConfigError(f"{path}: {place} must have a type: one of {', '.join(kinds)}")
    _check_keys(path, f"{place} ({leg['type']})", leg, kinds[leg["type"]], "type")


def _check_keys(
    path: Path, place: str, table: dict[str, Any], struct: type[msgspec.Struct], *more: str
) -> None:
    known = [*more, *(field.name for field in msgspec.structs.fields(struct))]
    for key in table:
        if key not in known:
            near = get_close_matches(key, known, n=1)
            hint = f"did you mean {near[0]}?" if near else f"known are {', '.join(known)}"
            raise ConfigError(f"{path}: unknown key {key!r} in {place}; {hint}")
