"""One unit's path as a chain of knots, and the linear equations between them.

The unknowns of a knot are ``[north, east, c, s, w]``: with ``c + i s`` the own path is turned and
scaled onto the plan (linear: see ``base_station.fusion.plane.horizontal``), and ``w`` is the rate
at which the own heading drifts while the wearer moves.  Only the drift is not linear; the equations
are about what was last believed of turn and drift.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from base_station.fusion.path.history import BREAK, DOUBTFUL, RESTART, PathArrays
from base_station.fusion.port import Start
from base_station.fusion.smoother.equations import Equations
from base_station.fusion.smoother.port import PlaceSeen, UnitEvidence
from base_station.fusion.smoother.shared import Shared, Term

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
STATES = 5
UNKNOWN_M = 1e4
LEAST_WANDER_RADPS = 3e-7  # of the drift from knot to knot: less is an equation too stiff to solve
NS_TO_S = 1e-9


@dataclass(frozen=True)
class WalkNoise:
    """How own paths err."""

    walk_m_per_sqrt_m: float = 0.06  # each axis
    turn_rad_per_sqrt_m: float = 0.004
    turn_part: float = 0.004
    scale_std: float = 0.015
    drift_radps: float = 6e-4
    drift_wander_radps: float = 6e-5  # of that rate in a minute
    open_drift_s: float = 600.0  # while turn and drift are not known: the drift goes on so long
    restart_m: float = 5.0
    unguided_mps: float = 1.5
    wander_part: float = 0.7  # of a fix's variance that wanders slowly
    wander_s: float = 30.0
    excess: float = 2.0  # what a receiver admits beyond its best is but half of it
    fix_tail: float = 2.4  # standard deviations from which a fix counts less (Cauchy)


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
    turn_var: Floats  # (k - 1,)
    moving_s: Floats  # (k - 1,)
    restarts: NDArray[np.bool_]  # (k,) a new own frame begins at this knot

    @staticmethod
    def of(evidence: UnitEvidence, noise: WalkNoise, knot_m: float, knot_s: float) -> Chain:
        path = evidence.path
        knots = _choose_knots(path, knot_m, knot_s)
        steps = np.diff(path.own_m, axis=0)
        joins = (path.flags[1:] & (BREAK | RESTART)) == 0
        steps[~joins] = 0.0
        lengths = np.hypot(steps[:, 0], steps[:, 1])
        duration_s = np.diff(path.t_ns) * NS_TO_S
        place_var = noise.walk_m_per_sqrt_m**2 * lengths + 1e-4
        doubtful = (path.flags[1:] & DOUBTFUL) != 0
        place_var += np.where(doubtful & joins, np.maximum(np.diff(path.std_m**2), 0.0), 0.0)
        gone_m2 = noise.restart_m**2 + (noise.unguided_mps * duration_s) ** 2
        place_var += np.where(joins, 0.0, gone_m2)
        turn_var = noise.turn_rad_per_sqrt_m**2 * lengths + 1e-10
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
            turn_var=_sums(turn_var, begins),
            moving_s=_sums(path.moving_s[1:], begins),
            restarts=restarts,
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
class Belief:
    """What was last believed: the knots' unknowns, and where the turn is known."""

    x: Floats  # (k, 5)
    aligned: NDArray[np.bool_]  # (k,)

    @staticmethod
    def none(count: int) -> Belief:
        return Belief(np.zeros((count, STATES)), np.zeros(count, dtype=bool))


def add_path(
    equations: Equations, base: int, chain: Chain, belief: Belief, shared: Shared, n: WalkNoise
) -> None:
    """The own path from knot to knot, and what is known of it from the beginning."""
    _add_priors(equations, base, chain, belief, shared, n)
    if len(chain) < 2:
        return
    here = base + STATES * np.arange(len(chain) - 1)
    there = here + STATES
    north, east = 0.5 * chain.step_m[:, 0], 0.5 * chain.step_m[:, 1]
    std = np.sqrt(chain.step_var_m2)
    # A new own frame: its turn says nothing of the step that led there.
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
    _add_turning(equations, here, there, chain, belief, n)
    wander = np.sqrt(n.drift_wander_radps**2 * chain.moving_s / 60.0 + LEAST_WANDER_RADPS**2)
    equations.add(wander, 0.0, (there + 4, 1.0), (here + 4, -1.0))


def add_fixes(
    equations: Equations, base: int, chain: Chain, belief: Belief, shared: Shared, n: WalkNoise
) -> None:
    """Fixes near each other tell little more than one; what lies far off counts less and less."""
    path = chain.path
    inside = path.fix_t_ns <= path.t_ns[-1] + 1_000_000_000
    t_ns, place = path.fix_t_ns[inside], path.fix_m[inside]
    if not len(t_ns):
        return
    knot, since = chain.at(t_ns)
    best = path.fix_std_m.min()
    admitted = n.excess**2 * (path.fix_std_m[inside] ** 2 - best**2)
    std = np.sqrt(best**2 - shared.sky_std_m**2 + admitted)
    sky = shared.sky(t_ns)
    gap_s = np.diff(t_ns, prepend=t_ns[0] - 2 * int(n.wander_s * 1e9)) * NS_TO_S
    repeats = np.clip(2.0 * n.wander_s / np.maximum(gap_s, 1e-3), 1.0, None)
    spread = std * np.sqrt(n.wander_part * repeats + 1.0 - n.wander_part)
    if belief.aligned.any():
        off = place_of(belief.x[knot], since) + shared.sky_m(t_ns) - place
        apart = np.linalg.norm(off, axis=1)
        spread = spread * np.sqrt(1.0 + (apart / (n.fix_tail * std)) ** 2)
    add_places(equations, base + STATES * knot, since, place, spread, *sky)


def add_seen(equations: Equations, base: int, chain: Chain, places: Sequence[PlaceSeen]) -> None:
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
                      place.heading_std_rad)  # fmt: skip


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


def place_of(x: Floats, since: Floats) -> Floats:
    """North and east (n, 2) after the own path since a knot was walked."""
    north = x[:, 0] + x[:, 2] * since[:, 0] - x[:, 3] * since[:, 1]
    east = x[:, 1] + x[:, 3] * since[:, 0] + x[:, 2] * since[:, 1]
    return np.column_stack((north, east))


def _add_priors(
    equations: Equations, base: int, chain: Chain, belief: Belief, shared: Shared, n: WalkNoise
) -> None:
    start, begin = chain.start, np.array([base])
    add_places(equations, begin, np.zeros((1, 2)), np.zeros((1, 2)), np.array([UNKNOWN_M]))
    if start is not None:
        knot = chain.start_knot
        column, own = np.array([base + STATES * knot]), chain.own_m[knot : knot + 1]
        place = np.array([(start.north_m, start.east_m)])
        off, own_var_m2 = shared.start(start)
        add_places(equations, column, -own, place, np.array([np.sqrt(own_var_m2)]), (off, 1.0))
    for segment in chain.segments():
        first = base + STATES * segment.start
        if belief.aligned[segment.start]:
            along = _unit(belief.x[segment.start : segment.start + 1, 2:4])[0]
            equations.add(
                n.scale_std, 1.0,
                (np.array([first + 2]), along[0]), (np.array([first + 3]), along[1]),
            )  # fmt: skip
        else:
            _add_turn(equations, first, 0.0, np.sqrt(0.5))
        is_said = start is not None and start.heading_std_rad < np.pi
        if start is not None and is_said and segment.start == chain.start_knot:
            _add_turn(equations, first, start.heading_rad, start.heading_std_rad)
    equations.add(n.drift_radps, 0.0, (np.array([base + 4]), 1.0))


def _add_turn(equations: Equations, column: int, turn_rad: float, std_rad: float) -> None:
    std = max(std_rad, 0.02)
    equations.add(std, np.cos(turn_rad), (np.array([column + 2]), 1.0))
    equations.add(std, np.sin(turn_rad), (np.array([column + 3]), 1.0))


def _add_turning(
    equations: Equations, here: Ints, there: Ints, chain: Chain, belief: Belief, n: WalkNoise
) -> None:
    """The turn goes on as the drift has it, along and across what is believed of it."""
    aligned = belief.aligned[:-1] & belief.aligned[1:]
    moving_s, restarts = chain.moving_s, chain.restarts[1:]
    drift = np.where(aligned, belief.x[:-1, 4], 0.0)
    cosine, sine = np.cos(drift * moving_s), np.sin(drift * moving_s)
    before = belief.x[:-1, 2:4]
    after = np.column_stack(
        (cosine * before[:, 0] - sine * before[:, 1], sine * before[:, 0] + cosine * before[:, 1])
    )
    along = np.where(aligned[:, None], _unit(after), (1.0, 0.0))
    open_var = n.drift_radps**2 * n.open_drift_s * moving_s
    across_std = np.sqrt(chain.turn_var + np.where(aligned, 0.0, open_var) + 1e3 * restarts)
    along_std = np.where(aligned & ~restarts, 1e-4, across_std)
    size = np.where(aligned, np.linalg.norm(after, axis=1), 0.0)
    for (u, v), std, rate in (
        ((along[:, 0], along[:, 1]), along_std, 0.0),
        ((-along[:, 1], along[:, 0]), across_std, -size * moving_s),
    ):
        equations.add(
            std, rate * drift,
            (there + 2, u), (there + 3, v),
            (here + 2, -(u * cosine + v * sine)), (here + 3, u * sine - v * cosine),
            (here + 4, rate),
        )  # fmt: skip


def _unit(vectors: Floats) -> Floats:
    units: Floats = vectors / np.maximum(np.linalg.norm(vectors, axis=1), 1e-9)[:, None]
    return units


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


def _turned(steps: Floats, lengths: Floats) -> Floats:
    """By how much the path turned between one step and the next."""
    headings = np.arctan2(steps[:, 1], steps[:, 0])
    turned = np.abs((np.diff(headings) + np.pi) % (2.0 * np.pi) - np.pi)
    return np.where((lengths[:-1] > 0.1) & (lengths[1:] > 0.1), turned, 0.0)


def _sums(values: Floats, begins: Ints) -> Floats:
    """Sums of rows between one knot and the next."""
    if not len(begins):
        return values[:0]
    sums: Floats = np.add.reduceat(values, begins, axis=0)
    return sums
