"""Factory of simulations: the text after ``simulated:`` into a ``Simulation``.

``open_simulation`` turns the text after ``simulated:`` into a ``Simulation``.
"""

from __future__ import annotations

from difflib import get_close_matches
from math import hypot, nan
from pathlib import Path
from typing import get_args
from urllib.parse import parse_qsl

from msgspec.structs import replace

from edge.body_places import PLACES
from edge.simulation.legs import MOST_M, Point, Segment, Stand, Walk
from edge.simulation.scenario import Scenario, read_scenario
from edge.simulation.scenarios import SCENARIOS
from edge.simulation.simulation import Simulation
from shared.errors import ConfigError

SEGMENTS: tuple[str, ...] = get_args(Segment)
_STANDS_S = 3.0
_ARRIVES_MPS = 1.35


def open_simulation(text: str) -> Simulation:
    """Return the simulation that ``NAME`` or ``PATH.toml`` names, with ``?seed=N``,
    ``&worn_on=chest``, ``&from=NORTH,EAST`` and, of a further sensor of the same person,
    ``&number=1`` behind it.

    Raises ``ConfigError``.
    """
    name, _, query = text.partition("?")
    options = dict(parse_qsl(query, keep_blank_values=True))
    scenario = find_scenario(name)
    worn_on = segment_at(options.pop("worn_on", scenario.worn_on))
    if worn_on not in SEGMENTS:
        known = ", ".join(SEGMENTS)
        raise ConfigError(f"simulated:{text}: worn_on is {worn_on!r}; known are {known}")
    seed = _whole_number(text, options, "seed")
    number = _whole_number(text, options, "number")
    if "from" in options:
        scenario = _arriving(scenario, _place(text, options.pop("from")))
    if options:
        raise ConfigError(
            f"simulated:{text}: unknown option {min(options)!r}; known are seed, number, worn_on "
            "and from"
        )
    return Simulation(replace(scenario, worn_on=worn_on), seed, number=number)


def segment_at(place: str) -> str:
    """Return the segment that is simulated for a sensor at a part of the body; of one that is none
    of ``SEGMENTS`` no motion can be simulated.
    """
    return place if place in SEGMENTS else PLACES.get(place, place)


def _whole_number(text: str, options: dict[str, str], name: str) -> int:
    value = options.pop(name, "0")
    if not value.isdecimal():
        raise ConfigError(f"simulated:{text}: {name} is {value!r}; give a whole number from 0 up")
    return int(value)


def _place(text: str, value: str) -> Point:
    try:
        north_m, east_m = map(float, value.split(","))
    except ValueError:
        north_m = east_m = nan
    if not max(abs(north_m), abs(east_m)) <= MOST_M:  # and not NaN
        raise ConfigError(
            f"simulated:{text}: from is {value!r}; give two numbers, NORTH,EAST in m, of "
            f"{MOST_M:.0f} at most"
        )
    return north_m, east_m


def _arriving(scenario: Scenario, start: Point) -> Scenario:
    """Return the same walk after one from another place to its start; its events are later."""
    away_m = hypot(scenario.start[0] - start[0], scenario.start[1] - start[1])
    later_s = _STANDS_S + away_m / _ARRIVES_MPS
    (_, first_degc), *_ = scenario.ambient_degc
    heat = ((t_s + later_s, degc) for t_s, degc in scenario.ambient_degc)
    return replace(
        scenario,
        start=start,
        legs=(Stand(_STANDS_S), Walk((scenario.start,)), *scenario.legs),
        ambient_degc=((0.0, first_degc), *heat),
        radio_outages_s=tuple((t_s + later_s, long_s) for t_s, long_s in scenario.radio_outages_s),
    )


def find_scenario(name: str) -> Scenario:
    """Return the built-in scenario of that name, or that of a .toml file.

    Raises ``ConfigError``.
    """
    if name.endswith(".toml"):
        return read_scenario(Path(name))
    for scenario in SCENARIOS:
        if scenario.name == name:
            return scenario
    known = [scenario.name for scenario in SCENARIOS]
    near = get_close_matches(name, known, n=1)
    hint = f"did you mean {near[0]}? " if near else ""
    raise ConfigError(
        f"unknown scenario {name!r}; {hint}Known are {', '.join(known)} "
        "and the path of a .toml file"
    )
