"""What happens in a simulated walk, as data: built in or read from a file."""

from __future__ import annotations

import tomllib
from difflib import get_close_matches
from pathlib import Path
from typing import Any

import msgspec

from edge.simulation.legs import Leg, Point
from shared.errors import ConfigError
from shared.geo import Anchor


class Scenario(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Positions are (north, east) metres in the site frame, times seconds from the start."""

    name: str
    summary: str
    legs: tuple[Leg, ...]
    loop: tuple[Leg, ...] = ()  # done again and again after ``legs`` until ``duration_s``
    duration_s: float = 3600.0  # of the looping; without a loop the walk ends with its legs
    start: Point = (0.0, 0.0)
    heading_deg: float = 0.0
    down_m: float = 0.0
    building: bool = False  # in the training house, or on open ground
    anchor: Anchor | None = None  # of the site frame; the training house's when left out
    ambient_degc: tuple[tuple[float, float], ...] = ((0.0, 18.0),)  # (time, value), linear between
    radio_outages_s: tuple[tuple[float, float], ...] = ()  # (start, duration)
    battery_start: float = 0.95
    battery_life_s: float = 6 * 3600.0  # from full to empty
    rate_hz: float = 200.0


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
        for index, leg in enumerate(table.get(member, ())):
            _check_leg(path, f"{member}[{index}]", leg)
    try:
        scenario = msgspec.convert(table, Scenario)
    except msgspec.ValidationError as error:
        raise ConfigError(f"{path}: {error}") from error
    _check_values(path, scenario)
    return scenario


def _check_values(path: Path, scenario: Scenario) -> None:
    for name, value, low, high in (
        ("rate_hz", scenario.rate_hz, 20.0, 5000.0),
        ("duration_s", scenario.duration_s, 1.0, 1e6),
        ("battery_start", scenario.battery_start, 0.0, 1.0),
        ("battery_life_s", scenario.battery_life_s, 1.0, 1e9),
    ):
        if not low <= value <= high:
            raise ConfigError(f"{path}: {name} is {value:g}; it must be in {low:g} ... {high:g}")
    if not scenario.legs:
        raise ConfigError(f"{path}: legs is empty; say at least one thing to do")
    times_s = [t_s for t_s, _ in scenario.ambient_degc]
    if not times_s or times_s != sorted(times_s):
        raise ConfigError(f"{path}: ambient_degc must be [time, value] pairs in order of time")


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
