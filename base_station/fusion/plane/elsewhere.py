"""Whoever may be elsewhere: guesses drawn anew, asked for the walls behind them.

A cloud whose first guesses all lay in the wrong rooms never comes out of them: walls then confirm
what is left of it.  What speaks against it is that walls stood in the way, again and again, of a
way that leads through none somewhere else.  So guesses are drawn from what is known without walls,
and follow the last stretch of the path back: the mean of how likely they make the walls met is the
evidence for "elsewhere", what the cloud said of the same walls is that for itself (Bayes factor;
augmented Monte Carlo localisation adds such guesses too, but by a ratio that is tuned: Thrun,
Burgard and Fox 2005, table 8.3).
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from base_station.fusion.plane.drawing import Drawn, draw
from base_station.fusion.plane.walked import Walked
from base_station.fusion.plane.weighed import picked
from base_station.site.floor_grid import FloorGrid

Floats = NDArray[np.float64]

DRAWN = 4000
WIDE = 2.0  # times as far as stated half of them are: who is elsewhere erred by more than that
HARDLY = 8.0  # of log likelihood less than the cloud: not followed further back
STRAYED = 0.02  # of clouds, before anything speaks for it: about one person in a hundred
SHAKEN = np.array([0.1, 0.1, 0.01, 5e-5])  # place, turn and drift of guesses that are picked again


class Elsewhere(NamedTuple):
    drawn: Drawn
    weights: Floats  # (n,), their sum is 1
    told: float  # log likelihood of the walls met, by all of them

    def odds(self, told: float) -> float:
        """Logarithm of how much likelier than a cloud that ``told`` so much."""
        return math.log(STRAYED) + self.told - told

    def pick(self, count: int, rng: np.random.Generator) -> tuple[Floats, Floats]:
        """Guesses (count, 4) and their slow errors (count, 4), drawn by weight."""
        one = picked(self.weights, count, rng)
        shaken = self.drawn.guesses[one] + SHAKEN * rng.normal(size=(count, 4))
        return shaken, self.drawn.slow[one]


def look_elsewhere(
    known: tuple[Floats, Floats],
    walked: Walked,
    scale: float,
    grid: FloorGrid,
    rng: np.random.Generator,
    *,
    inside: bool,
) -> Elsewhere | None:
    """``known``: moments (9,), (9, 9) of ``HorizontalFilter``; ``inside``: only in the building, as
    nothing stands in the way of whoever is thought to be outside.  None: there is nobody.
    """
    widths = np.where(np.arange(DRAWN) % 2, 1.0, WIDE)
    drawn = draw(*known, rng, widths)
    logs = walked.retrace(drawn.guesses, scale, grid, walked.told - HARDLY)
    likely = np.exp(logs) * (grid.is_within(drawn.guesses[:, :2]) if inside else 1.0)
    total = float(likely.sum())
    return Elsewhere(drawn, likely / total, math.log(total / DRAWN)) if total > 0.0 else None
