"""One unit's path as a chain of knots, and how it errs.

The unknowns of a knot are ``[north, east, c, s, w, n, e]``: with ``c + i s`` the own path is turned
and scaled onto the plan (linear: see ``fusion.horizontal.horizontal``), ``w`` is the rate
at which the own heading drifts while the wearer moves, and ``n, e`` is by how much the receiver
errs for a while (``receivers``).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from base_station.fusion.interface import Start
from base_station.fusion.odometry.noise_runs import run_of
from base_station.fusion.odometry.points import BREAK, DOUBTFUL, RESTART, PathArrays
from base_station.fusion.smoothing.interface import UnitEvidence
from base_station.fusion.stated_noise import with_path_noise

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
STATES = 7
WALKED = 5  # those that constrain the own path
SLOW = 5  # the first of the receiver's
NS_TO_S = 1e-9


@dataclass(frozen=True)
class WalkNoise:
    """Noise of own paths whose trackers state none."""

    walk_m_per_sqrt_m: float = 0.03  # each axis
    turn_rad_per_sqrt_m: float = 0.004
    turn_part: float = 0.004
    scale_std: float = 0.015
    drift_radps: float = 6e-4
    drift_wander_radps: float = 6e-5  # of that rate in a minute
    open_drift_s: float = 600.0  # while turn and drift are unknown: duration of the drift
    restart_m: float = 5.0
    unguided_mps: float = 1.5


@dataclass(frozen=True)
class Chain:
    """The knots of one unit and what lies between them."""

    path: PathArrays
    start: Start | None
    start_knot: int  # the first knot of the own frame that it is about
    knots: Ints  # (k,) rows of the path
    own_m: Floats  # (k, 2)
    step_m: Floats  # (k - 1, 2) own path between knots; nothing where it does not join
    step_var_m2: Floats  # (k - 1,)
    place_var_m2: Floats  # (n - 1,) random walk of each step of the path, each axis
    turn_var: Floats  # (k - 1,)
    moving_s: Floats  # (k - 1,)
    restarts: NDArray[np.bool_]  # (k,) a new own frame begins at this knot
    scale_std: Floats  # (k,) of the run of the path that leads to the knot

    @staticmethod
    def of(evidence: UnitEvidence, noise: WalkNoise, knot_m: float, knot_s: float) -> Chain:
        path = evidence.path
        scale_std, walk, turn = _noise_by_row(evidence, noise)
        knots = _choose_knots(path, knot_m, knot_s)
        steps = np.diff(path.own_m, axis=0)
        joins = (path.flags[1:] & (BREAK | RESTART)) == 0
        steps[~joins] = 0.0
        lengths = np.hypot(steps[:, 0], steps[:, 1])
        duration_s = np.diff(path.t_ns) * NS_TO_S
        place_var = walk[1:] ** 2 * lengths + 1e-4
        doubtful = (path.flags[1:] & DOUBTFUL) != 0
        place_var += np.where(doubtful & joins, np.maximum(np.diff(path.std_m**2), 0.0), 0.0)
        gone_m2 = noise.restart_m**2 + (noise.unguided_mps * duration_s) ** 2
        place_var += np.where(joins, 0.0, gone_m2)
        turn_var = turn[1:] ** 2 * lengths + 1e-10
        turn_var[1:] += (noise.turn_part * _turned(steps, lengths)) ** 2
        begins = knots[:-1]
        restarts = (path.flags[knots] & RESTART) != 0
        started = restarts & (path.t_ns[knots] <= evidence.start_ns)
        return Chain(
            path=path,
            start=evidence.start,
            start_knot=int(np.flatnonzero(started)[-1]) if started.any() else 0,
            knots=knots,
            own_m=path.own_m[knots],
            step_m=_sums(steps, begins),
            step_var_m2=_sums(place_var, begins),
            place_var_m2=place_var,
            turn_var=_sums(turn_var, begins),
            moving_s=_sums(path.moving_s[1:], begins),
            restarts=restarts,
            scale_std=scale_std[knots],
        )

    def __len__(self) -> int:
        return len(self.knots)

    def at(self, t_ns: Ints) -> tuple[Ints, Floats]:
        """The knot before each time, and the own path walked since it (n, 2)."""
        path = self.path
        after = np.clip(np.searchsorted(path.t_ns, t_ns, side="right"), 1, max(len(path) - 1, 1))
        before = after - 1
        after = np.minimum(after, len(path) - 1)
        span = np.maximum(path.t_ns[after] - path.t_ns[before], 1)
        part = np.clip((t_ns - path.t_ns[before]) / span, 0.0, 1.0)
        breaks = (path.flags[after] & (BREAK | RESTART)) != 0
        part = np.where(breaks, 0.0, part)
        own = path.own_m[before] + part[:, None] * (path.own_m[after] - path.own_m[before])
        knot = np.searchsorted(self.knots, before, side="right") - 1
        return knot, own - self.own_m[knot]

    def segments(self) -> list[slice]:
        """Runs of knots in one own frame."""
        begins = [0, *(i for i in range(1, len(self)) if self.restarts[i])]
        return [slice(a, b) for a, b in zip(begins, [*begins[1:], len(self)], strict=True)]


@dataclass
class PathEstimate:
    """Last solution of a chain: unknowns of its knots, and where the turn is known."""

    x: Floats  # (k, 7)
    aligned: NDArray[np.bool_]  # (k,)

    @staticmethod
    def none(count: int) -> PathEstimate:
        return PathEstimate(np.zeros((count, STATES)), np.zeros(count, dtype=bool))


def place_of(x: Floats, since: Floats) -> Floats:
    """North and east (n, 2) after the own path since a knot was walked."""
    north = x[:, 0] + x[:, 2] * since[:, 0] - x[:, 3] * since[:, 1]
    east = x[:, 1] + x[:, 3] * since[:, 0] + x[:, 2] * since[:, 1]
    return np.column_stack((north, east))


def _choose_knots(path: PathArrays, knot_m: float, knot_s: float) -> Ints:
    """The first and the last point, both sides of a break, and others so far apart."""
    steps = np.hypot(*np.diff(path.own_m, axis=0).T) if len(path) > 1 else np.zeros(0)
    walked_m = np.concatenate(([0.0], np.cumsum(steps)))
    breaks = (path.flags & (BREAK | RESTART)) != 0
    knots, last = [0], 0
    for row in range(1, len(path)):
        far = walked_m[row] - walked_m[last] >= knot_m
        long = (path.t_ns[row] - path.t_ns[last]) * NS_TO_S >= knot_s
        ends = row + 1 == len(path) or bool(breaks[row + 1])
        if far or long or ends or breaks[row]:
            knots.append(row)
            last = row
    return np.array(knots, dtype=np.int64)


def _noise_by_row(evidence: UnitEvidence, usual: WalkNoise) -> tuple[Floats, Floats, Floats]:
    """Scale, place and turn noise (n,) of the run of the path in which each point lies."""
    runs = [*(run.noise for run in evidence.noise_runs), evidence.path_noise]
    stated = [with_path_noise(usual, noise) for noise in runs]
    by_run = np.array(
        [(one.scale_std, one.walk_m_per_sqrt_m, one.turn_rad_per_sqrt_m) for one in stated]
    )
    scale_std, walk, turn = by_run[run_of(evidence.noise_runs, evidence.path.t_ns)].T
    return scale_std, walk, turn


def _turned(steps: Floats, lengths: Floats) -> Floats:
    """Turn of the path from one step to the next (rad)."""
    headings = np.arctan2(steps[:, 1], steps[:, 0])
    turned = np.abs((np.diff(headings) + np.pi) % (2.0 * np.pi) - np.pi)
    return np.where((lengths[:-1] > 0.1) & (lengths[1:] > 0.1), turned, 0.0)


def _sums(values: Floats, begins: Ints) -> Floats:
    """Sums of rows between one knot and the next."""
    if not len(begins):
        return values[:0]
    sums: Floats = np.add.reduceat(values, begins, axis=0)
    return sums
