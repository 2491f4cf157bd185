"""Whoever may be elsewhere: particles drawn anew, asked for the walls behind them.

A cloud whose first particles all lay in the wrong rooms never comes out of them: walls then confirm
what is left of it.  What speaks against it is that walls stood in the way, again and again, of a
way that leads through none somewhere else.  So particles are drawn from what is known without
walls, and follow the last stretch of the path back: the mean of how likely they make the walls met
is the evidence for "elsewhere", what the cloud said of them is that for itself (Bayes factor;
augmented Monte Carlo localisation adds such particles too, but by a ratio that is tuned: Thrun,
Burgard and Fox 2005, table 8.3).

In a hall any way meets no wall.  That one along a corridor and round a room fits there says more,
because few would: what is likely is divided by the room that there was.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from base_station.fusion.plane.recent_stretch import RecentStretch
from base_station.fusion.plane.resampling import mahalanobis2, resampled
from base_station.fusion.plane.sampling import Drawn, draw
from base_station.site.floor_grid import FloorGrid

Floats = NDArray[np.float64]

DRAWN = 2000
WIDE = 2.0  # times as far as stated half of them are: who is elsewhere erred by more than that
HARDLY = 6.0  # of log likelihood less than the cloud: not followed further back
STRAYED = 0.02  # of clouds, before anything speaks for it: about one person in a hundred
JITTER = np.array([0.1, 0.1, 0.01, 5e-5])  # place, turn and drift of what is resampled


class Reseeding(NamedTuple):
    drawn: Drawn
    weights: Floats  # (n,), their sum is 1
    told: float  # log likelihood of the way, by all of them
    met: float  # and of the walls met, by those that are picked

    def odds(self, told: float) -> float:
        """Logarithm of how much likelier than a cloud that has ``told`` so much."""
        return math.log(STRAYED) + self.told - told

    def pick(self, count: int, rng: np.random.Generator) -> tuple[Floats, Floats]:
        """Particles (count, 4) and their slow errors (count, 4), drawn by weight."""
        one = resampled(self.weights, count, rng)
        shaken = self.drawn.particles[one] + JITTER * rng.normal(size=(count, 4))
        return shaken, self.drawn.slow[one]


def reseed(
    known: tuple[Floats, Floats],
    stretch: RecentStretch,
    scale: float,
    grid: FloorGrid,
    rng: np.random.Generator,
    *,
    inside: bool,
) -> Reseeding | None:
    """``known``: moments (9,), (9, 9) of ``HorizontalFilter``; ``inside``: only in the building, as
    nothing stands in the way of whoever is thought to be outside.  None: there is nobody.
    """
    least, widths = stretch.told - HARDLY, np.where(np.arange(DRAWN) % 2, 1.0, WIDE)
    drawn = draw(*known, rng, widths)
    logs = stretch.met_behind(drawn.particles, scale, grid, least)
    left = logs >= least
    if inside:
        left &= grid.is_within(drawn.particles[:, :2])
    if not left.any():
        return None
    drawn = drawn._replace(particles=drawn.particles[left], slow=drawn.slow[left])
    met, room = logs[left], stretch.room_behind(drawn.particles, scale, grid)
    total = float(np.logaddexp.reduce(met - room))
    weights = np.exp(met - room - total)
    return Reseeding(drawn, weights, total - math.log(DRAWN), float(weights @ met))


def nearness(known: tuple[Floats, Floats], places_m: Floats, grid: FloorGrid) -> Floats:
    """Logarithm (n,) of how much likelier what is known without walls is where somebody is at a
    place (n, 2) than where anywhere in the building.
    """
    mean, covariance = known
    spread = covariance[:2, :2] + 1e-6 * np.eye(2)
    distances2 = mahalanobis2(places_m - mean[:2], spread)
    near, wide = (-0.5 * distances2 / width**2 - 2.0 * math.log(width) for width in (1.0, WIDE))
    around_m2 = math.tau * math.sqrt(float(np.linalg.det(spread)))
    return np.asarray(np.logaddexp(near, wide) + math.log(0.5 * grid.area_m2 / around_m2))
