"""Paths as units publish them: true ways, what dead reckoning makes of them, and their positions.

For tests of the station, which need no sensors.  What a tracker needs is made by
``tests.rig.inertial_walk``.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from base_station.fusion.interface import Estimate
from base_station.fusion.odometry.path_history import PathHistory
from shared.clock import NS_PER_S
from shared.messages import Header, Position
from shared.quality import Quality
from tests.rig import message_factory

Floats = NDArray[np.float64]
Place = tuple[float, float, float]  # north, east, down


def along(points: Sequence[Place], step_m: float) -> Iterator[Place]:
    """Yield the places after each step along a polyline, of about ``step_m`` horizontally."""
    for (north_m, east_m, down_m), (to_north_m, to_east_m, to_down_m) in pairwise(points):
        count = round(math.hypot(to_north_m - north_m, to_east_m - east_m) / step_m)
        for step in range(count):
            part = (step + 1) / count
            yield (
                north_m + part * (to_north_m - north_m),
                east_m + part * (to_east_m - east_m),
                down_m + part * (to_down_m - down_m),
            )


class DeadReckoning:
    """A unit's own path, step by step: scaled, and turned by how far its heading is off."""

    def __init__(self, scale: float = 1.0) -> None:
        self._scale = scale
        self.north_m = self.east_m = 0.0
        self.distance_m = 0.0  # truly walked

    @property
    def place_m(self) -> tuple[float, float]:
        return self.north_m, self.east_m

    def step(self, north_m: float, east_m: float, off_rad: float) -> None:
        """Take a true step."""
        cosine, sine = self._scale * math.cos(off_rad), self._scale * math.sin(off_rad)
        self.north_m += cosine * north_m - sine * east_m
        self.east_m += sine * north_m + cosine * east_m
        self.distance_m += math.hypot(north_m, east_m)


def reckoned(steps_m: Floats, off_rad: Floats) -> Floats:
    """Return true steps (n, 2) turned by how far the heading is off at each (n,)."""
    cosine, sine = np.cos(off_rad), np.sin(off_rad)
    north_m, east_m = steps_m[:, 0], steps_m[:, 1]
    return np.stack([cosine * north_m - sine * east_m, sine * north_m + cosine * east_m], axis=1)


def at(t_s: float, north_m: float, boot_id: int = 1, **changes: object) -> Position:
    """Return the position so far north at that time of the unit's clock."""
    header = Header("FF-01", boot_id, 1, round(t_s * NS_PER_S))
    return message_factory.position(header, north_m=north_m, **changes)


def walked(seconds: int, mps: float = 1.0, east_mps: float = 0.0) -> PathHistory:
    """Return the path straight on, by default to the north, at five positions a second."""
    history = PathHistory()
    for fifth in range(seconds * 5):
        t_s = fifth / 5
        position = at(t_s, mps * t_s, east_m=east_mps * t_s)
        history.append(position, position.header.t_mono_ns, jumped=False)
    return history


def insert_late(history: PathHistory, position: Position) -> None:
    """Insert a position that comes late; the wearer climbed a metre a second."""
    t_ns = position.header.t_mono_ns
    down_m = -t_ns / NS_PER_S
    place = position.north_m, position.east_m, down_m, 0.5, 0.5, 0.5
    estimate = Estimate(t_ns, *place, 0.0, 0.0, 0.1, Quality.GOOD, "", None)
    history.insert_late(position, t_ns, estimate, 0)
