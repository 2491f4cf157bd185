"""Wearers who walk through the corridors of one building of two storeys, for as long as it takes.

Their own paths err as those of foot-mounted units do: the heading wanders with the way, the scale
is a little wrong.  Corridors and stairs make what a smoother finds in real incidents: lines that
many walk along, and stairs that many climb.
"""

from __future__ import annotations

import math
import random
from collections.abc import Iterator

import msgspec

from shared.clock import NS_PER_S, Clock
from shared.messages import Header, Position
from tests.rig.published_path import DeadReckoning, Place, along
from tests.rig.simulated_units import Wearer

CORRIDOR_APART_M = 10.0
CORRIDORS = 5  # each way
STOREY_M = 3.0
STAIRS_M = 6.0  # long
STAIRS_AT = (0, 2)  # the crossing of corridors where they begin, northwards
SPEED_MPS = 1.1
OTHER_STOREY = 0.15  # of the ways lead to the other storey
HEADING_RAD_PER_SQRT_M = 0.003
SCALE_STD = 0.01
_STEP_S = 0.2
_STEP_M = SPEED_MPS * _STEP_S

Crossing = tuple[int, int]


class BuildingWearer(Wearer):
    """Walks from one crossing of corridors to another, at random but always the same."""

    def __init__(self, unit_id: str, clock: Clock) -> None:
        super().__init__(unit_id, clock)
        self._rng = random.Random(unit_id)  # a walk, not a secret
        self._truth = self._walk()
        self._own = DeadReckoning(1.0 + self._rng.gauss(0.0, SCALE_STD))
        self._wander_rad = 0.0
        self._at_m: Place = 0.0, 0.0, 0.0
        self._walked_ns = self._first_ns

    def _position(self, header: Header) -> Position:
        while header.t_mono_ns - self._walked_ns >= _STEP_S * NS_PER_S:
            self._walked_ns += round(_STEP_S * NS_PER_S)
            self._step(next(self._truth))
        down_m = self._at_m[2]
        return msgspec.structs.replace(
            super()._position(header),
            north_m=self._own.north_m,
            east_m=self._own.east_m,
            down_m=down_m,
            distance_m=self._own.distance_m,
            pressure_pa=101_325.0 + 12.0 * down_m,
        )

    def _step(self, to_m: Place) -> None:
        north_m, east_m = to_m[0] - self._at_m[0], to_m[1] - self._at_m[1]
        self._at_m = to_m
        spread_rad = HEADING_RAD_PER_SQRT_M * math.sqrt(math.hypot(north_m, east_m))
        self._wander_rad += self._rng.gauss(0.0, spread_rad)
        self._own.step(north_m, east_m, self._wander_rad)

    def _walk(self) -> Iterator[Place]:
        """Yield the true places, a step of time apart."""
        here: Crossing = (0, 0)
        down_m = 0.0
        while True:
            if self._rng.random() < OTHER_STOREY:
                yield from along(_corridors(here, STAIRS_AT, down_m), _STEP_M)
                here, other_m = STAIRS_AT, -STOREY_M - down_m
                yield from along(_stairs(down_m, other_m), _STEP_M)
                down_m = other_m
            crossing = self._rng.randrange(CORRIDORS), self._rng.randrange(CORRIDORS)
            yield from along(_corridors(here, crossing, down_m), _STEP_M)
            here = crossing


def _corridors(here: Crossing, there: Crossing, down_m: float) -> tuple[Place, ...]:
    """Return the corners of a way between two crossings."""
    north_m, east_m = (CORRIDOR_APART_M * one for one in here)
    to_north_m, to_east_m = (CORRIDOR_APART_M * one for one in there)
    corners = (north_m, east_m), (to_north_m, east_m), (to_north_m, to_east_m)
    return tuple((*corner, down_m) for corner in corners)


def _stairs(down_m: float, other_m: float) -> tuple[Place, ...]:
    """Return the corners of a way up or down, and back to the crossing on that storey."""
    north_m, east_m = (CORRIDOR_APART_M * one for one in STAIRS_AT)
    landing = north_m + STAIRS_M, east_m, other_m
    return (north_m, east_m, down_m), landing, (north_m, east_m, other_m)
