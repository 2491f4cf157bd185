"""A solved chain as the trail of all its points."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from base_station.fusion.interface import Posterior
from base_station.fusion.smoothing.chain import Chain, PathEstimate, place_of
from base_station.fusion.smoothing.heights import Solved
from base_station.fusion.smoothing.interface import SmoothedPath

Floats = NDArray[np.float64]


def trail_of(
    chain: Chain,
    estimate: PathEstimate,
    spreads: Floats,
    least_m: Floats,
    heights: Solved,
    now: tuple[Floats, Floats],
) -> SmoothedPath:
    """``spreads`` (k, 5, 5) of the knots; ``least_m`` (n,): no point is known better, each axis;
    ``now``: the last knot as a fuser takes it over, and its covariance.
    """
    path = chain.path
    place, turn = _between_knots(chain, estimate.x)
    covariance = spreads[:, :2, :2]
    knot = np.searchsorted(chain.knots, np.arange(len(path)), side="left")
    std_north = np.sqrt(covariance[:, 0, 0])
    std_east = np.sqrt(covariance[:, 1, 1])
    correlation = (covariance[:, 0, 1] / (std_north * std_east))[knot]
    known = (std_north[knot] >= least_m) & (std_east[knot] >= least_m)
    return SmoothedPath(
        t_ns=path.t_ns,
        north_m=place[:, 0],
        east_m=place[:, 1],
        down_m=heights.down_m,
        std_north_m=np.maximum(std_north[knot], least_m),
        std_east_m=np.maximum(std_east[knot], least_m),
        correlation_ne=correlation * known,
        std_down_m=heights.std_m,
        turn_rad=np.arctan2(turn[:, 1], turn[:, 0]),
        posterior=Posterior(now[0].tolist(), now[1].tolist(), *heights.shift),
    )


def _between_knots(chain: Chain, x: Floats) -> tuple[Floats, Floats]:
    """Places (n, 2) and turns (n, 2) of all points: carried on from the knot before and back from
    the one behind, the nearer one counting more.
    """
    rows = np.arange(len(chain.path))
    after = np.searchsorted(chain.knots, rows, side="left")
    before = np.where(chain.knots[after] == rows, after, after - 1)
    own = chain.path.own_m
    walked = np.concatenate(([0.0], np.cumsum(np.hypot(*np.diff(own, axis=0).T))))
    span = walked[chain.knots[after]] - walked[chain.knots[before]]
    part = ((walked - walked[chain.knots[before]]) / np.maximum(span, 1e-9))[:, None]
    part = np.clip(part, 0.0, 1.0)
    forth = place_of(x[before], own - chain.own_m[before])
    back = place_of(x[after], own - chain.own_m[after])
    turn = (1.0 - part) * x[before, 2:4] + part * x[after, 2:4]
    return (1.0 - part) * forth + part * back, turn
