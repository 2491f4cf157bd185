"""Walks of an incident's people by their script, and the messages of their units."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import msgspec
import numpy as np
from numpy.typing import NDArray

from shared.messages import Position
from tests.rig.incident.building import SteelBuilding
from tests.rig.incident.people import Script, Truth
from tests.rig.incident.sensors import positions_of, walk_it

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class PersonWalk:
    """One person."""

    truth: Truth
    turn_rad: float  # heading of the own north in the incident frame, at the start
    published: list[Position]  # row by row, of nobody, without pressure

    def positions(self, unit_id: str, pressures_pa: Floats) -> list[Position]:
        """As a unit with a barometer publishes them."""
        return [
            msgspec.structs.replace(
                position,
                header=msgspec.structs.replace(position.header, unit_id=unit_id),
                pressure_pa=pressure_pa,
            )
            for position, pressure_pa in zip(self.published, pressures_pa.tolist(), strict=True)
        ]


Walkers = Callable[[np.random.Generator, Sequence[Script], SteelBuilding], list[PersonWalk]]


def drawn_walks(
    rng: np.random.Generator,
    scripts: Sequence[Script],
    building: SteelBuilding,
) -> list[PersonWalk]:
    """In straight lines at an even pace, with errors of a path as ``sensors`` draws them."""
    walks = []
    for script in scripts:
        truth = script.truth()
        own = walk_it(rng, truth)
        walks.append(PersonWalk(truth, own.turn_rad, positions_of(truth, own)))
    return walks
