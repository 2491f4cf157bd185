"""What everybody's paths have shown of a building that nobody has a plan of.

Its stairs and the direction of its walls are each the mean of what those said who came upon them
knowing nothing of them yet.  Others take that over where their own path shows the same, and nobody
becomes surer by hearing their own word again (``conservative_fusion``).
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import msgspec
import numpy as np

from base_station.fusion.conditioning import at_least
from base_station.fusion.learnt.legs import Axis, quarter
from base_station.fusion.learnt.stairs import Stairs

SURE_M = 6.0  # a climb that is less known than this, each axis, may be on any stairs
MOST_STAIRS = 40
ODDS = 10.0  # so much likelier the same stairs than others: believed
LEAST_M2 = 0.05  # of what is left, each way
MOST_WORDS = 64  # about the walls' direction; more tell nothing that these do not
OUTLIER2 = 9.0  # squared standard deviations apart: not about the same


class KnownStairs(msgspec.Struct, frozen=True):
    """Of one stairwell: the word of each unit that knew nothing of it before."""

    words: tuple[tuple[str, Stairs], ...]

    @property
    def mean(self) -> Stairs:
        if len(self.words) == 1:
            return self.words[0][1]
        shared = max(word.shared_m2 for _, word in self.words) * np.eye(2)
        weight, total = np.zeros((2, 2)), np.zeros(2)
        for _, word in self.words:
            place, covariance = word.place
            information = np.linalg.inv(at_least(covariance - shared, LEAST_M2))
            weight, total = weight + information, total + information @ place
        spread = np.linalg.inv(weight)
        (north_m, east_m), spread = (spread @ total).tolist(), spread + shared
        (north, cross), (_, east) = spread.tolist()
        return msgspec.structs.replace(
            self.words[0][1], north_m=north_m, east_m=east_m, covariance_m2=(north, cross, east)
        )


class LearntBuilding(msgspec.Struct, frozen=True):
    """In the incident frame."""

    stairs: tuple[KnownStairs, ...] = ()
    axes: tuple[tuple[str, Axis], ...] = ()  # by unit
    axis: Axis | None = None  # what most of them agree upon

    def with_axis(self, unit_id: str, axis: Axis) -> LearntBuilding:
        others = tuple(word for word in self.axes if word[0] != unit_id)
        axes = (*others, (unit_id, axis))
        return msgspec.structs.replace(self, axes=axes, axis=_agreed(axes))

    def which(self, seen: Stairs) -> int | None:
        """The stairs that a climb was on; -1: such as nobody knows yet; None: it cannot be told."""
        if max(seen.covariance_m2[0], seen.covariance_m2[2]) > SURE_M**2:
            return None
        odds = [seen.odds(one.mean) for one in self.stairs]
        if sum(odds) < 1.0 / ODDS:
            return -1
        best = odds.index(max(odds))
        return best if odds[best] > ODDS * (1.0 + sum(odds) - odds[best]) else None

    def with_stairs(self, row: int, unit_id: str, seen: Stairs) -> LearntBuilding:
        """``row`` as ``which`` gives it; only the first word of each unit counts."""
        if row < 0:
            if len(self.stairs) >= MOST_STAIRS:
                return self
            known = (*self.stairs, KnownStairs(((unit_id, seen),)))
            return msgspec.structs.replace(self, stairs=known)
        words = self.stairs[row].words
        if any(name == unit_id for name, _ in words):
            return self
        one = KnownStairs((*words, (unit_id, seen)))
        return msgspec.structs.replace(
            self, stairs=(*self.stairs[:row], one, *self.stairs[row + 1 :])
        )

    def without(self, unit_id: str) -> LearntBuilding:
        """What the others said."""
        left = (tuple(word for word in known.words if word[0] != unit_id) for known in self.stairs)
        axes = tuple(word for word in self.axes if word[0] != unit_id)
        stairs = tuple(KnownStairs(words) for words in left if words)
        return LearntBuilding(stairs, axes, _agreed(axes))

    def reframed(self, turn_rad: float, north_m: float, east_m: float) -> LearntBuilding:
        """The incident frame was moved: turned clockwise, then shifted."""
        stairs = tuple(
            KnownStairs(
                tuple((name, one.reframed(turn_rad, north_m, east_m)) for name, one in known.words)
            )
            for known in self.stairs
        )
        axes = tuple(
            (name, Axis(quarter(axis.direction_rad + turn_rad), axis.variance))
            for name, axis in self.axes
        )
        return LearntBuilding(stairs, axes, _agreed(axes))


def _agreed(axes: Sequence[tuple[str, Axis]]) -> Axis | None:
    """The mean of most words: of those that lie near the one with the most about it."""
    if not axes:
        return None
    surest = sorted((axis for _, axis in axes), key=lambda axis: axis.variance)[:MOST_WORDS]
    directions_rad = np.array([axis.direction_rad for axis in surest])
    variances = np.array([axis.variance for axis in surest])
    apart_rad = quarter(directions_rad[:, None] - directions_rad)
    near = apart_rad**2 <= OUTLIER2 * (variances[:, None] + variances)
    weights = 1.0 / variances
    weights = np.where(near[np.argmax(near @ weights)], weights, 0.0)
    north = float(weights @ np.cos(4.0 * directions_rad))
    east = float(weights @ np.sin(4.0 * directions_rad))
    return Axis(math.atan2(east, north) / 4.0, 1.0 / float(weights.sum()))
