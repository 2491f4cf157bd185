"""Simulated wearers: a walking foot whose motion is known exactly, and sensors with honest errors.

``open_simulation`` turns the text after ``simulated:`` into a ``Simulation``.
"""

from __future__ import annotations

from difflib import get_close_matches
from pathlib import Path
from typing import get_args
from urllib.parse import parse_qsl

from msgspec.structs import replace

from edge.simulation.legs import Segment
from edge.simulation.scenario import Scenario, read_scenario
from edge.simulation.scenarios import SCENARIOS
from edge.simulation.simulation import Simulation
from shared.errors import ConfigError

__all__ = ["SCENARIOS", "Scenario", "Simulation", "open_simulation"]


def open_simulation(text: str) -> Simulation:
    """Make what ``NAME`` or ``PATH.toml`` says, with ``?seed=N`` and ``&worn_on=chest`` behind it.

    Raises ``ConfigError``.
    """
    name, _, query = text.partition("?")
    options = dict(parse_qsl(query, keep_blank_values=True))
    scenario = _find(name)
    worn_on = options.pop("worn_on", scenario.worn_on)
    if worn_on not in get_args(Segment):
        known = ", ".join(get_args(Segment))
        raise ConfigError(f"simulated:{text}: worn_on is {worn_on!r}; known are {known}")
    seed = options.pop("seed", "0")
    if not seed.isdecimal():
        raise ConfigError(f"simulated:{text}: seed is {seed!r}; give a whole number from 0 up")
    if options:
        raise ConfigError(
            f"simulated:{text}: unknown option {min(options)!r}; known are seed and worn_on"
        )
    return Simulation(replace(scenario, worn_on=worn_on), int(seed))


def _find(name: str) -> Scenario:
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
