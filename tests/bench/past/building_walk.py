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

Crossing = tuple[int, int]


class BuildingWearer(Wearer):
    """Walks from one crossing of corridors to another, at random but always the same."""

    def __init__(self, unit_id: str, clock: Clock) -> None:
        super().__init__(unit_id, clock)
        self._rng = random.Random(unit_id)  # a walk, not a secret
        self._truth = self._walk()
        self._scale = 1.0 + self._rng.gauss(0.0, SCALE_STD)
        self._wander_rad = 0.0
        self._before = 0.0, 0.0
        self._north_m = self._east_m = self._down_m = self._distance_m = 0.0
        self._walked_ns = self._first_ns

    def _position(self, header: Header) -> Position:
        while header.t_mono_ns - self._walked_ns >= _STEP_S * NS_PER_S:
            self._walked_ns += round(_STEP_S * NS_PER_S)
            self._step(*next(self._truth))
        return msgspec.structs.replace(
            super()._position(header),
            north_m=self._north_m,
            east_m=self._east_m,
            down_m=self._down_m,
            distance_m=self._distance_m,
            pressure_pa=101_325.0 + 12.0 * self._down_m,
        )

    def _step(self, north_m: float, east_m: float, down_m: float) -> None:
        step_n, step_e = north_m - self._before[0], east_m - self._before[1]
        self._before, self._down_m = (north_m, east_m), down_m
        length_m = math.hypot(step_n, step_e)
        spread_rad = HEADING_RAD_PER_SQRT_M * math.sqrt(length_m)
        self._wander_rad += self._rng.gauss(0.0, spread_rad)
        cosine = self._scale * math.cos(self._wander_rad)
        sine = self._scale * math.sin(self._wander_rad)
        self._north_m += cosine * step_n - sine * step_e
        self._east_m += sine * step_n + cosine * step_e
        self._distance_m += length_m

    def _walk(self) -> Iterator[tuple[float, float, float]]:
        """Truth: north, east and down, a step of time apart."""
        here: Crossing = (0, 0)
        down_m = 0.0
        while True:
            if self._rng.random() < OTHER_STOREY:
                yield from self._along(here, STAIRS_AT, down_m)
                here, other_m = STAIRS_AT, -STOREY_M - down_m
                yield from self._climb(down_m, other_m)
                down_m = other_m
            crossing = self._rng.randrange(CORRIDORS), self._rng.randrange(CORRIDORS)
            yield from self._along(here, crossing, down_m)
            here = crossing

    def _along(
        self, here: Crossing, there: Crossing, down_m: float
    ) -> Iterator[tuple[float, float, float]]:
        north_m, east_m = (CORRIDOR_APART_M * one for one in here)
        to_north_m, to_east_m = (CORRIDOR_APART_M * one for one in there)
        for n, e in ((to_north_m, east_m), (to_north_m, to_east_m)):
            for part in _parts(math.hypot(n - north_m, e - east_m)):
                yield north_m + part * (n - north_m), east_m + part * (e - east_m), down_m
            north_m, east_m = n, e

    def _climb(self, down_m: float, other_m: float) -> Iterator[tuple[float, float, float]]:
        """Up or down, and back to the crossing on that storey."""
        north_m, east_m = (CORRIDOR_APART_M * one for one in STAIRS_AT)
        for part in _parts(STAIRS_M):
            yield north_m + part * STAIRS_M, east_m, down_m + part * (other_m - down_m)
        for part in _parts(STAIRS_M):
            yield north_m + (1.0 - part) * STAIRS_M, east_m, other_m


def _parts(way_m: float) -> Iterator[float]:
    """Position on a way after each step of time."""
    count = max(round(way_m / (SPEED_MPS * _STEP_S)), 0)
    for step in range(count):
        yield (step + 1) / count
