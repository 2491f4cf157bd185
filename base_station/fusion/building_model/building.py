"""Building model shared by all units: stairs and the dominant direction of walls.

Each is the mean of the observations of units that did not know it before. Other units are corrected
by it where their own path shows the same; a unit does not gain certainty from its own observation
(``conservative_fusion``).
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import msgspec
import numpy as np

from base_station.fusion.building_model.stairs import LearntStairs
from base_station.fusion.building_model.straight_segments import Axis, wrap_quarter
from base_station.fusion.gaussian import at_least

SURE_M = 6.0  # a climb that is less known than this, each axis, may be on any stairs
MOST_STAIRS = 40
ODDS = 10.0  # likelihood ratio of the same stairs to others that is accepted
LEAST_M2 = 0.05  # of the remaining uncertainty, each way
MAX_OBSERVATIONS = 64  # about the walls' direction; more add no information
OUTLIER2 = 9.0  # squared standard deviations apart: not about the same


class KnownStairs(msgspec.Struct, frozen=True):
    """One stairwell: the first observation of each unit."""

    observations: tuple[tuple[str, LearntStairs], ...]

    @property
    def mean(self) -> LearntStairs:
        if len(self.observations) == 1:
            return self.observations[0][1]
        shared = max(observation.shared_m2 for _, observation in self.observations) * np.eye(2)
        weight, total = np.zeros((2, 2)), np.zeros(2)
        for _, observation in self.observations:
            place, covariance = observation.place
            information = np.linalg.inv(at_least(covariance - shared, LEAST_M2))
            weight, total = weight + information, total + information @ place
        spread = np.linalg.inv(weight)
        (north_m, east_m), spread = (spread @ total).tolist(), spread + shared
        (north, cross), (_, east) = spread.tolist()
        return msgspec.structs.replace(
            self.observations[0][1],
            north_m=north_m,
            east_m=east_m,
            covariance_m2=(north, cross, east),
        )


class LearntBuilding(msgspec.Struct, frozen=True):
    """In the incident frame."""

    stairs: tuple[KnownStairs, ...] = ()
    axes: tuple[tuple[str, Axis], ...] = ()  # by unit
    axis: Axis | None = None  # direction on which most of them agree

    def with_axis(self, unit_id: str, axis: Axis) -> LearntBuilding:
        others = tuple(observation for observation in self.axes if observation[0] != unit_id)
        axes = (*others, (unit_id, axis))
        return msgspec.structs.replace(self, axes=axes, axis=_mean_axis(axes))

    def match(self, seen: LearntStairs) -> int | None:
        """Row of the stairs of a climb; -1: new stairs; None: ambiguous."""
        if max(seen.covariance_m2[0], seen.covariance_m2[2]) > SURE_M**2:
            return None
        odds = [seen.odds(one.mean) for one in self.stairs]
        if sum(odds) < 1.0 / ODDS:
            return -1
        best = odds.index(max(odds))
        return best if odds[best] > ODDS * (1.0 + sum(odds) - odds[best]) else None

    def with_stairs(self, row: int, unit_id: str, seen: LearntStairs) -> LearntBuilding:
        """Model with this observation; ``row`` from ``match``. Only the first observation of a unit
        counts.
        """
        if row < 0:
            if len(self.stairs) >= MOST_STAIRS:
                return self
            known = (*self.stairs, KnownStairs(((unit_id, seen),)))
            return msgspec.structs.replace(self, stairs=known)
        observations = self.stairs[row].observations
        if any(name == unit_id for name, _ in observations):
            return self
        one = KnownStairs((*observations, (unit_id, seen)))
        return msgspec.structs.replace(
            self, stairs=(*self.stairs[:row], one, *self.stairs[row + 1 :])
        )

    def without(self, unit_id: str) -> LearntBuilding:
        """Model from the observations of the other units."""
        left = (
            tuple(observation for observation in known.observations if observation[0] != unit_id)
            for known in self.stairs
        )
        axes = tuple(observation for observation in self.axes if observation[0] != unit_id)
        stairs = tuple(KnownStairs(observations) for observations in left if observations)
        return LearntBuilding(stairs, axes, _mean_axis(axes))

    def reframed(self, turn_rad: float, north_m: float, east_m: float) -> LearntBuilding:
        """The incident frame was moved: turned clockwise, then shifted."""
        stairs = tuple(
            KnownStairs(
                tuple(
                    (name, one.reframed(turn_rad, north_m, east_m))
                    for name, one in known.observations
                )
            )
            for known in self.stairs
        )
        axes = tuple(
            (name, Axis(wrap_quarter(axis.direction_rad + turn_rad), axis.variance))
            for name, axis in self.axes
        )
        return LearntBuilding(stairs, axes, _mean_axis(axes))


def _mean_axis(axes: Sequence[tuple[str, Axis]]) -> Axis | None:
    """Weighted mean of the observations that lie near the one with the most weight about it."""
    if not axes:
        return None
    surest = sorted((axis for _, axis in axes), key=lambda axis: axis.variance)[:MAX_OBSERVATIONS]
    directions_rad = np.array([axis.direction_rad for axis in surest])
    variances = np.array([axis.variance for axis in surest])
    apart_rad = wrap_quarter(directions_rad[:, None] - directions_rad)
    near = apart_rad**2 <= OUTLIER2 * (variances[:, None] + variances)
    weights = 1.0 / variances
    weights = np.where(near[np.argmax(near @ weights)], weights, 0.0)
    north = float(weights @ np.cos(4.0 * directions_rad))
    east = float(weights @ np.sin(4.0 * directions_rad))
    return Axis(math.atan2(east, north) / 4.0, 1.0 / float(weights.sum()))
