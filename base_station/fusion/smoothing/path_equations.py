"""Linear equations of one unit's chain: path, start, pins.

Only the drift of the heading is not linear; equations are linearised about the last turn and drift.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from base_station.fusion.smoothing.chain import STATES, Chain, PathEstimate, WalkNoise
from base_station.fusion.smoothing.common_errors import CommonErrors, Term
from base_station.fusion.smoothing.equations import Equations
from base_station.fusion.smoothing.interface import PositionConstraint

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
UNKNOWN_M = 1e4
LEAST_WANDER_RADPS = 3e-7  # of the drift from knot to knot: less is an equation too stiff to solve


def add_path(
    equations: Equations,
    base: int,
    chain: Chain,
    estimate: PathEstimate,
    common: CommonErrors,
    n: WalkNoise,
) -> None:
    """The own path from knot to knot, and what is known of it from the beginning."""
    _add_priors(equations, base, chain, estimate, common, n)
    if len(chain) < 2:
        return
    here = base + STATES * np.arange(len(chain) - 1)
    there = here + STATES
    north, east = 0.5 * chain.step_m[:, 0], 0.5 * chain.step_m[:, 1]
    std = np.sqrt(chain.step_var_m2)
    # A new own frame: its turn has no relation to the step that led there.
    equations.add(
        std, 0.0,
        (there, 1.0), (here, -1.0),
        (here + 2, -north), (there + 2, -north), (here + 3, east), (there + 3, east),
    )  # fmt: skip
    equations.add(
        std, 0.0,
        (there + 1, 1.0), (here + 1, -1.0),
        (here + 2, -east), (there + 2, -east), (here + 3, -north), (there + 3, -north),
    )  # fmt: skip
    _add_turning(equations, here, there, chain, estimate, n)
    wander = np.sqrt(n.drift_wander_radps**2 * chain.moving_s / 60.0 + LEAST_WANDER_RADPS**2)
    equations.add(wander, 0.0, (there + 4, 1.0), (here + 4, -1.0))


def add_position_constraints(
    equations: Equations, base: int, chain: Chain, places: Sequence[PositionConstraint]
) -> None:
    if not places:
        return
    knot, since = chain.at(np.array([place.t_ns for place in places], dtype=np.int64))
    where = np.array([(place.north_m, place.east_m) for place in places])
    add_places(
        equations, base + STATES * knot, since, where, np.array([place.std_m for place in places])
    )
    for place, row in zip(places, knot, strict=True):
        if place.heading_rad is not None:
            own_rad = chain.path.heading_rad[chain.knots[row]]
            _add_turn(equations, base + STATES * row, place.heading_rad - own_rad,
                      place.heading_std_rad, float(chain.scale_std[row]))  # fmt: skip


def add_places(
    equations: Equations, columns: Ints, since: Floats, place: Floats, std: Floats, *errors: Term
) -> None:
    """A knot and the own path since it lead to a place, but for errors: terms of north, those of
    east a column further.
    """
    north, east = since[:, 0], since[:, 1]
    equations.add(
        std, place[:, 0],
        (columns, 1.0), (columns + 2, north), (columns + 3, -east), *errors,
    )  # fmt: skip
    equations.add(
        std, place[:, 1],
        (columns + 1, 1.0), (columns + 2, east), (columns + 3, north),
        *((column + 1, factor) for column, factor in errors),
    )  # fmt: skip


def _add_priors(
    equations: Equations,
    base: int,
    chain: Chain,
    estimate: PathEstimate,
    common: CommonErrors,
    n: WalkNoise,
) -> None:
    start, begin = chain.start, np.array([base])
    add_places(equations, begin, np.zeros((1, 2)), np.zeros((1, 2)), np.array([UNKNOWN_M]))
    if start is not None:
        knot = chain.start_knot
        column, own = np.array([base + STATES * knot]), chain.own_m[knot : knot + 1]
        place = np.array([(start.north_m, start.east_m)])
        off, own_var_m2 = common.start(start)
        add_places(equations, column, -own, place, np.array([np.sqrt(own_var_m2)]), (off, 1.0))
    for segment in chain.segments():
        first, scale_std = base + STATES * segment.start, float(chain.scale_std[segment.start])
        if estimate.aligned[segment.start]:
            along = _unit(estimate.x[segment.start : segment.start + 1, 2:4])[0]
            equations.add(
                scale_std, 1.0,
                (np.array([first + 2]), along[0]), (np.array([first + 3]), along[1]),
            )  # fmt: skip
        else:
            _add_turn(equations, first, 0.0, np.sqrt(0.5))
        has_heading = start is not None and start.heading_std_rad < np.pi
        if start is not None and has_heading and segment.start == chain.start_knot:
            turn = start.heading_rad, start.heading_std_rad, scale_std
            _add_turn(equations, first, *turn, is_scaled=bool(estimate.aligned[segment.start]))
    equations.add(n.drift_radps, 0.0, (np.array([base + 4]), 1.0))


def _add_turn(
    equations: Equations,
    column: int,
    turn_rad: float,
    std_rad: float,
    scale_std: float = 0.0,
    *,
    is_scaled: bool = False,
) -> None:
    """Add a known turn. A heading that is known better than the scale does not show the scale:
    that is left to ``scale_std``, or to an equation that is there already (``is_scaled``).
    """
    std = max(std_rad, 0.02)
    if std < scale_std:
        cosine, sine = np.cos(turn_rad), np.sin(turn_rad)
        equations.add(std, 0.0, (np.array([column + 2]), -sine), (np.array([column + 3]), cosine))
        if not is_scaled:
            equations.add(
                scale_std, 1.0, (np.array([column + 2]), cosine), (np.array([column + 3]), sine)
            )
        return
    equations.add(std, np.cos(turn_rad), (np.array([column + 2]), 1.0))
    equations.add(std, np.sin(turn_rad), (np.array([column + 3]), 1.0))


def _add_turning(
    equations: Equations,
    here: Ints,
    there: Ints,
    chain: Chain,
    estimate: PathEstimate,
    n: WalkNoise,
) -> None:
    """Add the change of turn with the drift, along and across the estimated turn."""
    aligned = estimate.aligned[:-1] & estimate.aligned[1:]
    moving_s, restarts = chain.moving_s, chain.restarts[1:]
    drift = np.where(aligned, estimate.x[:-1, 4], 0.0)
    cosine, sine = np.cos(drift * moving_s), np.sin(drift * moving_s)
    before = estimate.x[:-1, 2:4]
    after = np.column_stack(
        (cosine * before[:, 0] - sine * before[:, 1], sine * before[:, 0] + cosine * before[:, 1])
    )
    along = np.where(aligned[:, None], _unit(after), (1.0, 0.0))
    open_var = n.drift_radps**2 * n.open_drift_s * moving_s
    across_std = np.sqrt(chain.turn_var + np.where(aligned, 0.0, open_var) + 1e3 * restarts)
    kept, scale_var = _scale_change(chain.scale_std)
    goes_on = aligned & ~restarts
    kept = np.where(goes_on, kept, 1.0)
    along_std = np.hypot(np.where(goes_on, 1e-4, across_std), np.sqrt(scale_var))
    size = np.where(aligned, np.linalg.norm(after, axis=1), 0.0)
    for (u, v), std, rate, share in (
        ((along[:, 0], along[:, 1]), along_std, 0.0, kept),
        ((-along[:, 1], along[:, 0]), across_std, -size * moving_s, np.ones(len(kept))),
    ):
        equations.add(
            std, rate * drift + (1.0 - share),
            (there + 2, u), (there + 3, v),
            (here + 2, -share * (u * cosine + v * sine)),
            (here + 3, share * (u * sine - v * cosine)),
            (here + 4, rate),
        )  # fmt: skip


def _scale_change(scale_std: Floats) -> tuple[Floats, Floats]:
    """Share (k - 1,) of its error that the scale keeps from knot to knot, and variance added.

    Where a run of the path has a larger deviation than the one before, an error of its own is added
    to that of before; where it has a smaller one, such an error ends (Gauss-Markov process).
    """
    before, after = scale_std[:-1] ** 2, scale_std[1:] ** 2
    kept = np.minimum(after / before, 1.0)
    return kept, after - kept**2 * before


def _unit(vectors: Floats) -> Floats:
    units: Floats = vectors / np.maximum(np.linalg.norm(vectors, axis=1), 1e-9)[:, None]
    return units
