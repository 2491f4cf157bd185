"""Likelihood of a step on a plan: crossed walls, room beside walls, stairs; for particle filter and
smoother.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray
from scipy.special import erf

from base_station.site.floor_grid import CELL_M

Floats = NDArray[np.float64]

THROUGH_WALL = 0.02  # the remaining likelihood of a crossing: plans lack doors
OFF_FLOOR = 0.02  # the same of a step outside of the building above the ground floor
BESIDE_WALL = 0.5  # the same where there is no room for half a body, of a step without noise
OFF_STAIRS = 0.2  # the same where the path climbs and the plan has stairs elsewhere
CLIMBS = 0.25  # rise over way from which a path climbs
UNSEEN_M = 3.0  # after a gap as long as this the corners of the way are unknown


def log_beside_wall(step_var_m2: Floats) -> Floats:
    """Logarithms (n,) of the likelihood of steps beside a wall, whose own noise has these variances
    (n,), each axis; above 0.

    Beside is a strip of width ``b``, a square of the grid. A place in it is known no better than
    the step that led there: a normal error of deviation ``s`` across the wall leaves in it, of all
    places in it, the part

        p = erf(w) - (1 - exp(-w^2)) / (w sqrt pi)        w = b / (s sqrt 2)

    and only for that part there is no room. For a move of 0.35 m it is 0.93 on a foot (0.03 m by
    root metre) and 0.43 in a hand (0.28).
    """
    width = CELL_M / np.sqrt(2.0 * step_var_m2)
    part = erf(width) - (1.0 - np.exp(-(width**2))) / (width * math.sqrt(math.pi))
    return np.asarray(np.log(1.0 - (1.0 - BESIDE_WALL) * part))
