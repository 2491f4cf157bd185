"""Simulated wearers: a walking foot whose motion is known exactly, and sensors with honest errors.

``open_simulation`` turns the text after ``simulated:`` into a ``Simulation``.
"""

from __future__ import annotations

from difflib import get_close_matches
from pathlib import Path
from urllib.parse import parse_qsl

from edge.simulation.scenario import Scenario, read_scenario
from edge.simulation.scenarios import SCENARIOS
from edge.simulation.simulation import Simulation
from shared.errors import ConfigError

__all__ = ["SCENARIOS", "Scenario", "Simulation", "open_simulation"]


def open_simulation(text: str) -> Simulation:
    """Make what ``NAME``, ``NAME?seed=N`` or ``PATH.toml[?seed=N]`` says.

    Raises ``ConfigError``.
    """
    name, _, query = text.partition("?")
    return Simulation(_find(name), seed=_seed(text, query))


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


def _seed(text: str, query: str) -> int:
    options = dict(parse_qsl(query, keep_blank_values=True))
    value = options.pop("seed", "0")
    if options:
        raise ConfigError(f"simulated:{text}: unknown option {min(options)!r}; known is seed")
    if not value.isdecimal():
        raise ConfigError(f"simulated:{text}: seed is {value!r}; give a whole number from 0 up")
    return int(value)
