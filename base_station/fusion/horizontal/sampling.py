"""Particles of place, heading correction, drift rate and scale, drawn from a filter's moments."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from base_station.fusion.horizontal.state import PATH, SLOW
from base_station.fusion.kernels import STATES

Floats = NDArray[np.float64]


LEAST_SCALE = 0.2  # a smaller one, or a negative one, has no meaning


class Drawn(NamedTuple):
    particles: Floats  # (n, 5): north, east, turn, drift and scale
    slow: Floats  # (n, 4): the fixes' slow errors, given a particle
    slow_covariance: Floats  # (4, 4), of each


def draw(mean: Floats, covariance: Floats, rng: np.random.Generator, widths: Floats) -> Drawn:
    """Draw particles from moments (9,), (9, 9) of ``HorizontalFilter``; ``widths`` (n,): factor of
    the standard deviation.
    """
    own, slow = PATH, list(range(STATES))[SLOW]
    spread = covariance[np.ix_(own, own)] + 1e-12 * np.eye(5)
    root = np.linalg.cholesky(spread + 1e-9 * np.diag(np.diag(spread)))
    drawn = widths[:, None] * (rng.normal(size=(len(widths), 5)) @ root.T)
    gain = np.linalg.solve(spread, covariance[np.ix_(own, slow)]).T
    state = mean[own] + drawn
    turn_rad = np.arctan2(state[:, 3], state[:, 2])
    scale = np.hypot(state[:, 2], state[:, 3])
    return Drawn(
        np.column_stack((state[:, :2], turn_rad, state[:, 4], np.maximum(scale, LEAST_SCALE))),
        mean[slow] + drawn @ gain.T,
        covariance[np.ix_(slow, slow)] - gain @ covariance[np.ix_(own, slow)],
    )
