"""Fixes of a chain, with the slow error of its receiver as unknown.

A fix has a common-mode error (``common_errors``), an error of the receiver's surroundings that
lasts half a minute, and white noise. The second is an unknown of every knot, so that many fixes do
not average it away.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from base_station.fusion.gnss.common_mode_error import OWN_PART, OWN_S
from base_station.fusion.odometry.points import PathArrays
from base_station.fusion.smoothing.chain import NS_TO_S, SLOW, STATES, Chain, PathEstimate, place_of
from base_station.fusion.smoothing.common_errors import CommonErrors, Term
from base_station.fusion.smoothing.equations import Equations
from base_station.fusion.smoothing.path_equations import add_places

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

SLOW_S = 30.0  # for so long surroundings do the same to a receiver that is carried about
STAYS_M = 5.0  # and one that moves no further stays where it is
EXCESS = 2.0  # a receiver's excess over its best accuracy is only half of the error
WRONG_PART = 0.05  # of fixes: they are off by more than any model gives
WRONG_M = 6.0  # each axis
AFTER_NS = 1_000_000_000  # behind the last point: still of this path


def add_receiver(
    equations: Equations, base: int, chain: Chain, estimate: PathEstimate, common: CommonErrors
) -> None:
    """The fixes of one unit, and its receiver's slow error from knot to knot."""
    path, own_m2 = chain.path, _own_m2(chain.path, common)
    _add_slow_error(equations, base, chain, np.sqrt(OWN_PART * own_m2))
    inside = path.fix_t_ns <= path.t_ns[-1] + AFTER_NS
    t_ns, place, std_m = path.fix_t_ns[inside], path.fix_m[inside], path.fix_std_m[inside]
    if not len(t_ns):
        return
    knot, since = chain.at(t_ns)
    gap_s = np.diff(t_ns, prepend=t_ns[0] - 2 * int(SLOW_S * 1e9)) * NS_TO_S
    repeats = np.clip(2.0 * SLOW_S / np.maximum(gap_s, 1e-3), 1.0, None)
    admitted_m2 = EXCESS**2 * (std_m**2 - path.fix_std_m.min() ** 2)
    fresh_m2 = (1.0 - OWN_PART) * own_m2 + admitted_m2 * repeats
    if estimate.aligned.any():
        off = place_of(estimate.x[knot], since) + common.common_mode_m(t_ns) - place
        right = _inlier_probability((off**2).sum(axis=1), own_m2 + admitted_m2)
        fresh_m2 = 1.0 / (right / fresh_m2 + (1.0 - right) / (fresh_m2 + WRONG_M**2 * repeats))
    slow = _slow_error(base, chain, knot, t_ns)
    columns = base + STATES * knot
    add_places(
        equations, columns, since, place, np.sqrt(fresh_m2), *slow, *common.common_mode(t_ns)
    )


def _own_m2(path: PathArrays, common: CommonErrors) -> float:
    """Variance of the best fixes without the common part, each axis."""
    if not len(path.fix_t_ns):
        return 1.0
    return float(path.fix_std_m.min() ** 2 - common.common_std_m**2)


def _add_slow_error(equations: Equations, base: int, chain: Chain, std_m: float) -> None:
    first = np.array([base + SLOW, base + SLOW + 1])
    equations.add(std_m, 0.0, (first, 1.0))
    steps = np.diff(chain.path.own_m, axis=0)
    stays = float(np.hypot(steps[:, 0], steps[:, 1]).sum()) < STAYS_M
    gap_s = np.diff(chain.path.t_ns[chain.knots]) * NS_TO_S
    keep = np.repeat(np.exp(-gap_s / (OWN_S if stays else SLOW_S)), 2)
    here = (base + STATES * np.arange(len(gap_s))[:, None] + SLOW + np.arange(2)).ravel()
    fresh_m = std_m * np.sqrt(np.maximum(1.0 - keep**2, 1e-9))
    equations.add(fresh_m, 0.0, (here + STATES, 1.0), (here, -keep))


def _slow_error(base: int, chain: Chain, knot: Ints, t_ns: Ints) -> tuple[Term, Term]:
    """The slow error north at these times, as those of the knots before and behind with their
    parts; that east is a column further.
    """
    behind = np.minimum(knot + 1, len(chain) - 1)
    knot_t_ns = chain.path.t_ns[chain.knots]
    span_ns = np.maximum(knot_t_ns[behind] - knot_t_ns[knot], 1)
    part = np.clip((t_ns - knot_t_ns[knot]) / span_ns, 0.0, 1.0)
    columns = base + SLOW + STATES * knot
    return (columns, 1.0 - part), (base + SLOW + STATES * behind, part)


def _inlier_probability(apart_m2: Floats, variance_m2: Floats) -> Floats:
    """Probability of fixes, by their squared distances, that they err as is expected."""
    wide_m2 = variance_m2 + WRONG_M**2
    right = (1.0 - WRONG_PART) / variance_m2 * np.exp(-0.5 * apart_m2 / variance_m2)
    wrong = WRONG_PART / wide_m2 * np.exp(-0.5 * apart_m2 / wide_m2)
    return np.asarray(right / np.maximum(right + wrong, 1e-300))
