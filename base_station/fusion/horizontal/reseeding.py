"""Reseeding of a particle filter: particles drawn elsewhere, weighted by the walls behind them.

A cloud whose first particles all lay in wrong rooms cannot leave them: walls confirm what is left
of it. It shows by walls crossed again and again on a way that crosses none somewhere else. So
particles are drawn from the estimate without walls and traced back along the motion window: their
mean likelihood is the evidence for "elsewhere", the one of the cloud is the evidence for itself
(Bayes factor; augmented Monte Carlo localisation adds such particles by a tuned ratio: Thrun,
Burgard and Fox 2005, table 8.3).

In a hall any way crosses no wall. A way along a corridor and round a room that fits is stronger
evidence, as few would: likelihoods are divided by the free part of ways.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from base_station.fusion.horizontal.motion_window import MotionWindow
from base_station.fusion.horizontal.resampling import mahalanobis2, resampled
from base_station.fusion.horizontal.sampling import Drawn, draw
from base_station.site.floor_grid import FloorGrid

Floats = NDArray[np.float64]

SAMPLES = 2000
WIDENING = 2.0  # times the stated error for half of them: a unit elsewhere has a larger error
LOG_CUTOFF = 6.0  # of log likelihood less than the cloud: not followed further back
PRIOR_ELSEWHERE = 0.02  # of clouds, before anything speaks for it: about one person in a hundred
JITTER = np.array(
    [0.1, 0.1, 0.01, 5e-5, 0.002]
)  # place, turn, drift and scale of resampled particles


class Reseeding(NamedTuple):
    drawn: Drawn
    weights: Floats  # (n,), their sum is 1
    log_likelihood: float  # log likelihood of the way, by all of them
    met: float  # and of the walls met, by those that are picked

    def log_odds(self, log_likelihood: float) -> float:
        """Logarithm of how much likelier than a cloud that has ``log_likelihood`` so much."""
        return math.log(PRIOR_ELSEWHERE) + self.log_likelihood - log_likelihood

    def draw(self, count: int, rng: np.random.Generator) -> tuple[Floats, Floats]:
        """Particles (count, 5) and their slow errors (count, 4), drawn by weight."""
        one = resampled(self.weights, count, rng)
        shaken = self.drawn.particles[one] + JITTER * rng.normal(size=(count, len(JITTER)))
        return shaken, self.drawn.slow[one]


def reseed(
    known: tuple[Floats, Floats],
    window: MotionWindow,
    grid: FloorGrid,
    rng: np.random.Generator,
    *,
    inside: bool,
) -> Reseeding | None:
    """Draw and weight particles; None where none is likely. ``known``: moments (9,), (9, 9) of
    ``HorizontalFilter``; ``inside``: only particles in the building, as nothing blocks ways
    outside.
    """
    least, widths = (
        window.log_likelihood - LOG_CUTOFF,
        np.where(np.arange(SAMPLES) % 2, 1.0, WIDENING),
    )
    drawn = draw(*known, rng, widths)
    logs = window.wall_log_likelihood(drawn.particles, grid, least)
    left = logs >= least
    if inside:
        left &= grid.is_in_building(drawn.particles[:, :2])
    if not left.any():
        return None
    drawn = drawn._replace(particles=drawn.particles[left], slow=drawn.slow[left])
    met, room = logs[left], window.log_free_fraction(drawn.particles, grid)
    total = float(np.logaddexp.reduce(met - room))
    weights = np.exp(met - room - total)
    return Reseeding(drawn, weights, total - math.log(SAMPLES), float(weights @ met))


def log_density_ratio(known: tuple[Floats, Floats], places_m: Floats, grid: FloorGrid) -> Floats:
    """Logarithm (n,) of the density of the estimate without walls at places (n, 2) over a uniform
    one in the building.
    """
    mean, covariance = known
    spread = covariance[:2, :2] + 1e-6 * np.eye(2)
    distances2 = mahalanobis2(places_m - mean[:2], spread)
    near, wide = (-0.5 * distances2 / width**2 - 2.0 * math.log(width) for width in (1.0, WIDENING))
    around_m2 = math.tau * math.sqrt(float(np.linalg.det(spread)))
    return np.asarray(np.logaddexp(near, wide) + math.log(0.5 * grid.area_m2 / around_m2))
