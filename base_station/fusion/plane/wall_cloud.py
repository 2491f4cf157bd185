"""Where somebody may be, as a cloud of guesses that no wall lets through.

Every guess is a place, a heading correction and a drift rate; the path moves all of them, and a
guess that crosses a wall of the plan is hardly believed any more (Woodman and Harle 2008).  Given
a guess's path, the fixes' slow error is a linear problem with one covariance for all guesses, as
in ``heading_bank``.  Random numbers come from the cloud's own seeded generator, whose state is
part of it.
"""

from __future__ import annotations

import math

import msgspec
import numpy as np
from numpy.typing import NDArray

from base_station.fusion.plane.drawing import draw
from base_station.fusion.plane.elsewhere import Elsewhere, look_elsewhere, nearness
from base_station.fusion.plane.heading_bank import Sighting, slow_errors
from base_station.fusion.plane.state import DRIFT, SLOW, STATES
from base_station.fusion.plane.walked import Move, Walked
from base_station.fusion.plane.weighed import SHAKEN_M, normal, picked, shaken, squares
from base_station.fusion.ways import BESIDE_WALL, CLIMBS, OFF_STAIRS, THROUGH_WALL, UNSEEN_M
from base_station.site.crossing import BESIDE, WALL
from base_station.site.floor_grid import FloorGrid

Floats = NDArray[np.float64]

GUESSES = 400
MOVE_M = 0.35  # walked until the guesses are moved and walls looked at
FLOOR_VAR_M2 = 0.2**2  # of any place: people do not walk on lines, and plans lie decimetres aside
LEFT = 0.1  # of the guesses, that agree with what was told: else the cloud begins anew
CONTRADICTED = 1.0  # of log weight lost a move, on the mean: the plan or the path is wrong
MEMORY = 1.0 / 30.0  # of that mean, a move
DOUBTFUL = -8.0  # log likelihood of the walls met of late: is somebody elsewhere likelier?
LOOKED_M = 5.0  # walked until that is asked again
LEAST_ODDS, MOST_ODDS = -3.0, 30.0  # logarithms; less is let be
TOGETHER_M = 1.5  # standard deviation of a place below which one is left


class SavedCloud(msgspec.Struct, frozen=True):
    guesses: bytes
    weights: bytes
    slow: bytes
    slow_covariance: list[list[float]]
    scale: float
    pending: list[float]
    contradiction: float
    random: tuple[str, str, int, int]
    scale_var: float = 0.0
    walked: list[Move] = msgspec.field(default_factory=list)
    to_doubt_m: float = 0.0
    split: bool = False


class WallCloud:
    """Begun from the moments of ``HorizontalFilter``, and given back as such."""

    def __init__(self, mean: Floats, covariance: Floats, seed: int) -> None:
        self._rng = np.random.Generator(np.random.PCG64(seed))
        self._scale = float(np.hypot(mean[2], mean[3]))
        along = mean[2:4] / self._scale
        self._scale_var = float(along @ covariance[2:4, 2:4] @ along)  # walls tell nothing of it
        drawn = draw(mean, covariance, self._rng, np.ones(GUESSES))
        self._guesses, self._slow, self._slow_covariance = drawn
        self._walked = Walked([])
        self._to_doubt_m = 0.0
        self._split = False
        self._log_weights = np.zeros(GUESSES)
        self._pending = np.zeros(4)  # own north and east, seconds moving, climbed
        self._contradiction = 0.0
        self._moments: tuple[Floats, Floats] | None = None

    def save(self) -> SavedCloud:
        random = self._rng.bit_generator.state
        inner = random["state"]
        return SavedCloud(
            self._guesses.tobytes(),
            self._log_weights.tobytes(),
            self._slow.tobytes(),
            self._slow_covariance.tolist(),
            self._scale,
            self._pending.tolist(),
            self._contradiction,
            (str(inner["state"]), str(inner["inc"]), random["has_uint32"], random["uinteger"]),
            self._scale_var,
            self._walked.save(),
            self._to_doubt_m,
            self._split,
        )

    @staticmethod
    def restore(saved: SavedCloud) -> WallCloud:
        cloud = WallCloud(np.eye(STATES)[2], np.eye(STATES), 0)
        cloud._guesses = np.frombuffer(saved.guesses).reshape(GUESSES, 4).copy()
        cloud._log_weights = np.frombuffer(saved.weights).copy()
        cloud._slow = np.frombuffer(saved.slow).reshape(GUESSES, 4).copy()
        cloud._slow_covariance = np.array(saved.slow_covariance)
        cloud._scale, cloud._scale_var = saved.scale, saved.scale_var
        cloud._pending = np.array(saved.pending)
        cloud._contradiction = saved.contradiction
        cloud._walked, cloud._to_doubt_m = Walked(list(saved.walked)), saved.to_doubt_m
        cloud._split = saved.split
        state, inc, has_uint32, uinteger = saved.random
        cloud._rng.bit_generator.state = {
            "bit_generator": "PCG64",
            "state": {"state": int(state), "inc": int(inc)},
            "has_uint32": has_uint32,
            "uinteger": uinteger,
        }
        return cloud

    @property
    def is_contradicted(self) -> bool:
        """Move after move walls stood in the way of nearly all guesses."""
        return self._contradiction > CONTRADICTED

    def walk(
        self,
        path: tuple[float, float, float, float],
        noise: tuple[float, float],
        grid: FloorGrid,
        floor: int | None,
    ) -> None:
        """``path``: own north and east, seconds moving and metres climbed (up positive);
        ``noise``: variances of place and turn by metre walked.
        """
        self._pending += path
        way_m = math.hypot(self._pending[0], self._pending[1])
        if way_m < MOVE_M:
            return
        north_m, east_m, moving_s, climbed_m = self._pending.tolist()
        self._pending[:] = 0.0
        fresh = self._rng.normal(size=(GUESSES, 3))
        guesses = self._guesses
        guesses[:, 2] += guesses[:, 3] * moving_s + math.sqrt(noise[1] * way_m) * fresh[:, 2]
        from_m = guesses[:, :2].copy()
        guesses[:, :2] += self._turned(north_m, east_m)
        guesses[:, :2] += math.sqrt(noise[0] * way_m) * fresh[:, :2]
        self._moments = None
        looked, told, climbs = None, 0.0, abs(climbed_m) > CLIMBS * way_m
        if floor is not None and grid.knows(floor) and way_m < UNSEEN_M:
            looked, told = floor, self._weigh_walls(grid, floor, from_m, climbs)
        self._walked.note(Move(north_m, east_m, moving_s, climbs, looked, told))
        self._to_doubt_m -= way_m
        self._see_what_is_left()

    def _weigh_walls(self, grid: FloorGrid, floor: int, from_m: Floats, climbs: bool) -> float:
        """How likely the walls met are, as a logarithm."""
        before = normal(self._log_weights)
        met = grid.met(floor, from_m, self._guesses[:, :2])
        lost = math.log(THROUGH_WALL) * (met == WALL)
        if climbs and grid.has_stairs(floor):
            lost = lost + math.log(OFF_STAIRS) * ~grid.on_stairs(floor, self._guesses[:, :2])
        all_lost = lost + math.log(BESIDE_WALL) * (met == BESIDE)
        self._log_weights = self._log_weights + all_lost
        passed = float(before @ np.exp(lost))
        self._contradiction += MEMORY * (-math.log(passed) - self._contradiction)
        self._draw_anew()
        return math.log(float(before @ np.exp(all_lost)))

    @property
    def is_doubtful(self) -> bool:
        """It has just moved, and walls stood in the way of late."""
        moved = not self._pending.any()
        return moved and self._to_doubt_m <= 0.0 and self._walked.told < DOUBTFUL

    @property
    def is_split(self) -> bool:
        """Somebody elsewhere may have walked like this, and what came since did not tell."""
        return self._split

    def look_elsewhere(self, known: tuple[Floats, Floats], grid: FloorGrid) -> None:
        """Hold the cloud against guesses drawn from what is known without walls (9,), (9, 9), by
        the walls met of late, and keep both by the odds.  Only where it has just moved.
        """
        self._to_doubt_m = LOOKED_M
        guesses, walked, scale = self._guesses, self._walked, self._scale
        weights = normal(self._log_weights)
        inside = bool(grid.is_within((weights @ guesses[:, :2])[None])[0])
        found = look_elsewhere(known, walked, scale, grid, self._rng, inside=inside)
        fits = nearness(known, guesses[:, :2], grid) - walked.room_behind(guesses, scale, grid)
        told = walked.told - float(weights @ walked.met_twice(guesses, scale, grid))
        shares = self._log_weights - np.logaddexp.reduce(self._log_weights)
        told += float(np.logaddexp.reduce(shares + fits))
        if found is not None and (odds := found.odds(told)) > LEAST_ODDS:
            self._split_up(found, min(odds, MOST_ODDS))

    def _split_up(self, found: Elsewhere, odds: float) -> None:
        """``odds``: logarithm of how much likelier what was found is than the cloud."""
        part, rest = 1.0 / (1.0 + math.exp(-odds)), 1.0 / (1.0 + math.exp(odds))
        least = round(LEFT * GUESSES)
        count = min(max(round(part * GUESSES), least), GUESSES - least)
        kept = picked(normal(self._log_weights), GUESSES - count, self._rng)
        fresh, slow = found.pick(count, self._rng)
        self._guesses = np.concatenate((fresh, self._guesses[kept]))
        self._slow = np.concatenate((slow, self._slow[kept]))
        self._slow_covariance = found.drawn.slow_covariance
        shares = part / count, rest / (GUESSES - count)
        self._log_weights = np.log(np.repeat(shares, (count, GUESSES - count)))
        self._walked.retell(part * found.met + rest * self._walked.told)
        self._split, self._moments = True, None
        self._see_what_is_left()

    def _see_what_is_left(self) -> None:
        """Where guesses lie together again, one place is left."""
        if self._split:
            _, covariance = self.moments()
            self._split = bool(covariance[0, 0] + covariance[1, 1] > TOGETHER_M**2)

    def spread(self, variance_m2: float) -> None:
        self._guesses[:, :2] += math.sqrt(variance_m2) * self._rng.normal(size=(GUESSES, 2))
        self._walked, self._moments = Walked([]), None

    def fade(self, keeps: Floats) -> None:
        """Time went by for the fixes' slow errors (4,), of unit variance."""
        self._slow *= keeps
        self._slow_covariance *= np.outer(keeps, keeps)
        self._slow_covariance += np.diag(1.0 - keeps**2)
        self._moments = None

    def agree(self, mean: Floats, covariance: Floats) -> bool:
        """Take over what is known of ``[north, east, c, s, drift]`` (5,), (5, 5) and keep what
        walls have made of the rest: guesses are weighed by how much likelier they are by it than
        by the cloud's own moments, which it has considered already.  False, and nothing changed,
        where too few guesses are left: it lies elsewhere.
        """
        c, s = float(mean[2]), float(mean[3])
        to_own = np.zeros((4, 5))
        to_own[[0, 1, 3], [0, 1, 4]] = 1.0
        to_own[2, 2:4] = np.array([-s, c]) / (c * c + s * s)
        here = self._guesses.copy()
        here[:, :2] += self._turned(float(self._pending[0]), float(self._pending[1]))
        weights = normal(self._log_weights)
        turn_rad = math.atan2(
            float(weights @ np.sin(here[:, 2])), float(weights @ np.cos(here[:, 2]))
        )
        here[:, 2] = turn_rad + (here[:, 2] - turn_rad + math.pi) % math.tau - math.pi
        own = here - weights @ here
        known = np.array([mean[0], mean[1], math.atan2(s, c), mean[4]])
        known[2] = turn_rad + (known[2] - turn_rad + math.pi) % math.tau - math.pi
        floor = np.diag([SHAKEN_M**2, SHAKEN_M**2, 1e-6, 1e-12])
        spread = (own * weights[:, None]).T @ own + floor
        told = to_own @ covariance @ to_own.T + floor
        gain = 0.5 * (squares(own, spread) - squares(here - known, told))
        log_weights = self._log_weights + gain
        after = normal(log_weights)
        if 1.0 / float(after @ after) < LEFT * GUESSES:
            return False
        self._log_weights, self._moments, self._contradiction = log_weights, None, 0.0
        self._walked = Walked([])
        self._draw_anew()
        self._see_what_is_left()
        return True

    def distance2(self, sighting: Sighting) -> float:
        """From the cloud as a whole, chi-square of two degrees of freedom."""
        apart, spread = self._innovations(sighting)
        weights = normal(self._log_weights)
        middle = weights @ apart
        off = apart - middle
        whole = spread + (off * weights[:, None]).T @ off
        return float(middle @ np.linalg.solve(whole, middle))

    def update(self, sighting: Sighting) -> None:
        apart, spread = self._innovations(sighting)
        inverse = np.linalg.inv(spread)
        self._log_weights = self._log_weights - 0.5 * ((apart @ inverse) * apart).sum(axis=1)
        observe = slow_errors(sighting)
        gain = self._slow_covariance @ observe.T @ inverse
        self._slow += apart @ gain.T
        self._slow_covariance = self._slow_covariance - gain @ observe @ self._slow_covariance
        self._moments = None
        self._draw_anew()
        self._see_what_is_left()

    def moments(self) -> tuple[Floats, Floats]:
        """Mean (9,) and covariance (9, 9) in the state of ``HorizontalFilter``."""
        if self._moments is None:
            weights, guesses = normal(self._log_weights), self._guesses
            states = np.empty((GUESSES, STATES))
            states[:, :2] = guesses[:, :2]
            states[:, 2], states[:, 3] = np.cos(guesses[:, 2]), np.sin(guesses[:, 2])
            states[:, 2:4] *= self._scale
            states[:, SLOW], states[:, DRIFT] = self._slow, guesses[:, 3]
            mean = weights @ states
            apart = states - mean
            covariance = (apart * weights[:, None]).T @ apart
            covariance[SLOW, SLOW] += self._slow_covariance
            covariance[[0, 1], [0, 1]] += FLOOR_VAR_M2
            along = mean[2:4] / np.linalg.norm(mean[2:4])
            covariance[2:4, 2:4] += self._scale_var * np.outer(along, along)
            self._moments = mean, covariance
        mean, covariance = self._moments
        north_m, east_m = float(self._pending[0]), float(self._pending[1])
        mean = mean.copy()
        mean[0] += mean[2] * north_m - mean[3] * east_m
        mean[1] += mean[3] * north_m + mean[2] * east_m
        return mean, covariance

    def _innovations(self, sighting: Sighting) -> tuple[Floats, Floats]:
        """By guess (n, 2), and their covariance (2, 2)."""
        since_m = self._turned(
            sighting.since_north_m - self._pending[0], sighting.since_east_m - self._pending[1]
        )
        seen_m = np.array([sighting.north_m, sighting.east_m])
        observe = slow_errors(sighting)
        apart = seen_m + since_m - self._guesses[:, :2] - self._slow @ observe.T
        spread = observe @ self._slow_covariance @ observe.T + sighting.white_m2 * np.eye(2)
        return apart, spread

    def _turned(self, north_m: float, east_m: float) -> Floats:
        """An own-frame vector in the incident frame, by every guess (n, 2)."""
        cosine = self._scale * np.cos(self._guesses[:, 2])
        sine = self._scale * np.sin(self._guesses[:, 2])
        return np.stack(
            [cosine * north_m - sine * east_m, sine * north_m + cosine * east_m], axis=1
        )

    def _draw_anew(self) -> None:
        """Guesses that are hardly believed give way to others, shaken a little."""
        weights = normal(self._log_weights)
        self._log_weights -= self._log_weights.max()
        if 1.0 / float(weights @ weights) > 0.5 * GUESSES:
            return
        left = picked(weights, GUESSES, self._rng)
        self._guesses, self._slow = shaken(self._guesses[left], self._rng), self._slow[left]
        self._log_weights = np.zeros(GUESSES)
        self._moments = None
