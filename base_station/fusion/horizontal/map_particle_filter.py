"""Map-matching particle filter: places on a plan whose walls people do not cross.

A particle is a place, a heading correction and a drift rate; the path moves all, and one that
crosses a wall of the plan loses weight (Woodman and Harle 2008). Given a particle's path, the slow
error of fixes is a linear problem with one covariance for all particles, as in
``heading_hypotheses`` (a Rao-Blackwellised filter). Random numbers come from a seeded generator
whose state is part of the filter.
"""

from __future__ import annotations

import math

import msgspec
import numpy as np
from numpy.typing import NDArray

from base_station.fusion.horizontal.heading_hypotheses import GnssObservation, slow_error_jacobian
from base_station.fusion.horizontal.motion_window import MotionStep, MotionWindow
from base_station.fusion.horizontal.resampling import (
    JITTER_M,
    jittered,
    mahalanobis2,
    normalised,
    resampled,
)
from base_station.fusion.horizontal.reseeding import Reseeding, log_density_ratio, reseed
from base_station.fusion.horizontal.sampling import draw
from base_station.fusion.horizontal.state import SLOW
from base_station.fusion.kernels import DRIFT, STATES
from base_station.fusion.wall_likelihood import (
    BESIDE_WALL,
    CLIMBS,
    OFF_STAIRS,
    THROUGH_WALL,
    UNSEEN_M,
)
from base_station.site.floor_grid import FloorGrid
from base_station.site.wall_crossing import BESIDE, WALL

Floats = NDArray[np.float64]

PARTICLES = 400
MOVE_M = 0.35  # walked until the particles are moved and walls looked at
FLOOR_VAR_M2 = 0.2**2  # of any place: people do not walk on lines, and plans lie decimetres aside
MIN_EFFECTIVE_PART = (
    0.1  # of the particles, that agree with what was told: else the cloud begins anew
)
CONTRADICTED = 1.0  # of log weight lost a move, on the mean: the plan or the path is wrong
CONTRADICTION_GAIN = 1.0 / 30.0  # of that mean, a move
DOUBTFUL_LOG_LIKELIHOOD = (
    -8.0
)  # log likelihood of the walls met of late: is somebody elsewhere likelier?
RELOCALISE_EVERY_M = 5.0  # walked until that is asked again
MIN_LOG_ODDS, MAX_LOG_ODDS = -3.0, 30.0  # logarithms; less is let be
SPLIT_STD_M = 1.5  # standard deviation of a place below which one is left


class SavedParticles(msgspec.Struct, frozen=True):
    particles: bytes
    weights: bytes
    slow: bytes
    slow_covariance: list[list[float]]
    scale: float
    pending: list[float]
    contradiction: float
    random: tuple[str, str, int, int]
    scale_var: float = 0.0
    window: list[MotionStep] = msgspec.field(default_factory=list)
    to_doubt_m: float = 0.0
    split: bool = False


class MapParticleFilter:
    """Begun from the moments of ``HorizontalFilter``, and given back as such."""

    def __init__(self, mean: Floats, covariance: Floats, seed: int) -> None:
        self._rng = np.random.Generator(np.random.PCG64(seed))
        self._scale = float(np.hypot(mean[2], mean[3]))
        along = mean[2:4] / self._scale
        self._scale_var = float(along @ covariance[2:4, 2:4] @ along)  # walls tell nothing of it
        drawn = draw(mean, covariance, self._rng, np.ones(PARTICLES))
        self._particles, self._slow, self._slow_covariance = drawn
        self._window = MotionWindow([])
        self._to_doubt_m = 0.0
        self._split = False
        self._log_weights = np.zeros(PARTICLES)
        self._pending = np.zeros(4)  # own north and east, seconds moving, climbed
        self._contradiction = 0.0
        self._moments: tuple[Floats, Floats] | None = None

    def save(self) -> SavedParticles:
        random = self._rng.bit_generator.state
        inner = random["state"]
        return SavedParticles(
            self._particles.tobytes(),
            self._log_weights.tobytes(),
            self._slow.tobytes(),
            self._slow_covariance.tolist(),
            self._scale,
            self._pending.tolist(),
            self._contradiction,
            (str(inner["state"]), str(inner["inc"]), random["has_uint32"], random["uinteger"]),
            self._scale_var,
            self._window.save(),
            self._to_doubt_m,
            self._split,
        )

    @staticmethod
    def restore(saved: SavedParticles) -> MapParticleFilter:
        cloud = MapParticleFilter(np.eye(STATES)[2], np.eye(STATES), 0)
        cloud._particles = np.frombuffer(saved.particles).reshape(PARTICLES, 4).copy()
        cloud._log_weights = np.frombuffer(saved.weights).copy()
        cloud._slow = np.frombuffer(saved.slow).reshape(PARTICLES, 4).copy()
        cloud._slow_covariance = np.array(saved.slow_covariance)
        cloud._scale, cloud._scale_var = saved.scale, saved.scale_var
        cloud._pending = np.array(saved.pending)
        cloud._contradiction = saved.contradiction
        cloud._window, cloud._to_doubt_m = MotionWindow(list(saved.window)), saved.to_doubt_m
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
        """Move after move walls stood in the way of nearly all particles."""
        return self._contradiction > CONTRADICTED

    def predict(
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
        fresh = self._rng.normal(size=(PARTICLES, 3))
        particles = self._particles
        particles[:, 2] += particles[:, 3] * moving_s + math.sqrt(noise[1] * way_m) * fresh[:, 2]
        from_m = particles[:, :2].copy()
        particles[:, :2] += self._turned(north_m, east_m)
        particles[:, :2] += math.sqrt(noise[0] * way_m) * fresh[:, :2]
        self._moments = None
        looked, told, climbs = None, 0.0, abs(climbed_m) > CLIMBS * way_m
        if floor is not None and grid.has_floor(floor) and way_m < UNSEEN_M:
            looked, told = floor, self._weight_by_walls(grid, floor, from_m, climbs)
        self._window.append(MotionStep(north_m, east_m, moving_s, climbs, looked, told))
        self._to_doubt_m -= way_m
        self._update_is_split()

    def _weight_by_walls(self, grid: FloorGrid, floor: int, from_m: Floats, climbs: bool) -> float:
        """Weight particles by the walls they crossed; returns the log likelihood of the step."""
        before = normalised(self._log_weights)
        met = grid.crossings(floor, from_m, self._particles[:, :2])
        lost = math.log(THROUGH_WALL) * (met == WALL)
        if climbs and grid.has_stairs(floor):
            lost = lost + math.log(OFF_STAIRS) * ~grid.on_stairs(floor, self._particles[:, :2])
        all_lost = lost + math.log(BESIDE_WALL) * (met == BESIDE)
        self._log_weights = self._log_weights + all_lost
        passed = float(before @ np.exp(lost))
        self._contradiction += CONTRADICTION_GAIN * (-math.log(passed) - self._contradiction)
        self._resample()
        return math.log(float(before @ np.exp(all_lost)))

    def set_map(self, grid: FloorGrid) -> None:
        """Use other walls than before: the recent path is weighted by them."""
        met = self._window.wall_log_likelihood(self._particles, self._scale, grid, -math.inf)
        shares = self._log_weights - np.logaddexp.reduce(self._log_weights)
        self._window.set_log_likelihood(float(np.logaddexp.reduce(shares + met)))
        self._to_doubt_m = 0.0

    @property
    def is_doubtful(self) -> bool:
        """True where the cloud has just moved and recent walls were unlikely."""
        moved = not self._pending.any()
        return (
            moved
            and self._to_doubt_m <= 0.0
            and self._window.log_likelihood < DOUBTFUL_LOG_LIKELIHOOD
        )

    @property
    def is_split(self) -> bool:
        """True while more than one place is likely."""
        return self._split

    def try_relocalise(self, known: tuple[Floats, Floats], grid: FloorGrid) -> None:
        """Compare the cloud with particles drawn from the estimate without walls (9,), (9, 9) by
        the walls of the recent path, and keep both by their odds. Only where the cloud has just
        moved.
        """
        self._to_doubt_m = RELOCALISE_EVERY_M
        particles, window, scale = self._particles, self._window, self._scale
        weights = normalised(self._log_weights)
        inside = bool(grid.is_in_building((weights @ particles[:, :2])[None])[0])
        found = reseed(known, window, scale, grid, self._rng, inside=inside)
        fits = log_density_ratio(known, particles[:, :2], grid) - window.log_free_fraction(
            particles, scale, grid
        )
        told = window.log_likelihood - float(
            weights @ window.repeated_wall_log_ratio(particles, scale, grid)
        )
        shares = self._log_weights - np.logaddexp.reduce(self._log_weights)
        told += float(np.logaddexp.reduce(shares + fits))
        if found is not None and (log_odds := found.log_odds(told)) > MIN_LOG_ODDS:
            self._mix_in(found, min(log_odds, MAX_LOG_ODDS))

    def _mix_in(self, found: Reseeding, log_odds: float) -> None:
        """Replace a part of the particles; ``log_odds``: logarithm of the odds of the new ones
        against the cloud.
        """
        part, rest = 1.0 / (1.0 + math.exp(-log_odds)), 1.0 / (1.0 + math.exp(log_odds))
        least = round(MIN_EFFECTIVE_PART * PARTICLES)
        count = min(max(round(part * PARTICLES), least), PARTICLES - least)
        kept = resampled(normalised(self._log_weights), PARTICLES - count, self._rng)
        fresh, slow = found.draw(count, self._rng)
        self._particles = np.concatenate((fresh, self._particles[kept]))
        self._slow = np.concatenate((slow, self._slow[kept]))
        self._slow_covariance = found.drawn.slow_covariance
        shares = part / count, rest / (PARTICLES - count)
        self._log_weights = np.log(np.repeat(shares, (count, PARTICLES - count)))
        self._window.set_log_likelihood(part * found.met + rest * self._window.log_likelihood)
        self._split, self._moments = True, None
        self._update_is_split()

    def _update_is_split(self) -> None:
        """End the split once the particles lie together."""
        if self._split:
            _, covariance = self.moments()
            self._split = bool(covariance[0, 0] + covariance[1, 1] > SPLIT_STD_M**2)

    def scale_drift(self, share: float) -> None:
        """Scale every drift rate."""
        self._particles[:, 3] *= share
        self._moments = None

    def inflate_place(self, variance_m2: float) -> None:
        self._particles[:, :2] += math.sqrt(variance_m2) * self._rng.normal(size=(PARTICLES, 2))
        self._window, self._moments = MotionWindow([]), None

    def decay_slow_errors(self, keeps: Floats) -> None:
        """Time went by for the fixes' slow errors (4,), of unit variance."""
        self._slow *= keeps
        self._slow_covariance *= np.outer(keeps, keeps)
        self._slow_covariance += np.diag(1.0 - keeps**2)
        self._moments = None

    def reweight_to(self, mean: Floats, covariance: Floats) -> bool:
        """Reweight the cloud to moments (5,), (5, 5) of ``[north, east, c, s, drift]`` from another
        source: particles are weighted by the ratio of that density to the one of the cloud's own
        moments, so that what walls have shown is kept. False, and nothing changed, where too few
        effective particles are left.
        """
        c, s = float(mean[2]), float(mean[3])
        to_own = np.zeros((4, 5))
        to_own[[0, 1, 3], [0, 1, 4]] = 1.0
        to_own[2, 2:4] = np.array([-s, c]) / (c * c + s * s)
        here = self._particles.copy()
        here[:, :2] += self._turned(float(self._pending[0]), float(self._pending[1]))
        weights = normalised(self._log_weights)
        turn_rad = math.atan2(
            float(weights @ np.sin(here[:, 2])), float(weights @ np.cos(here[:, 2]))
        )
        here[:, 2] = turn_rad + (here[:, 2] - turn_rad + math.pi) % math.tau - math.pi
        own = here - weights @ here
        known = np.array([mean[0], mean[1], math.atan2(s, c), mean[4]])
        known[2] = turn_rad + (known[2] - turn_rad + math.pi) % math.tau - math.pi
        floor = np.diag([JITTER_M**2, JITTER_M**2, 1e-6, 1e-12])
        spread = (own * weights[:, None]).T @ own + floor
        told = to_own @ covariance @ to_own.T + floor
        gain = 0.5 * (mahalanobis2(own, spread) - mahalanobis2(here - known, told))
        log_weights = self._log_weights + gain
        after = normalised(log_weights)
        if 1.0 / float(after @ after) < MIN_EFFECTIVE_PART * PARTICLES:
            return False
        self._log_weights, self._moments, self._contradiction = log_weights, None, 0.0
        self._window = MotionWindow([])
        self._resample()
        self._update_is_split()
        return True

    def distance2(self, observation: GnssObservation) -> float:
        """Squared distance to the cloud as one normal distribution, chi-square of two degrees of
        freedom.
        """
        apart, spread = self._innovations(observation)
        weights = normalised(self._log_weights)
        middle = weights @ apart
        off = apart - middle
        whole = spread + (off * weights[:, None]).T @ off
        return float(middle @ np.linalg.solve(whole, middle))

    def update(self, observation: GnssObservation) -> None:
        apart, spread = self._innovations(observation)
        inverse = np.linalg.inv(spread)
        self._log_weights = self._log_weights - 0.5 * ((apart @ inverse) * apart).sum(axis=1)
        observe = slow_error_jacobian(observation)
        gain = self._slow_covariance @ observe.T @ inverse
        self._slow += apart @ gain.T
        self._slow_covariance = self._slow_covariance - gain @ observe @ self._slow_covariance
        self._moments = None
        self._resample()
        self._update_is_split()

    def moments(self) -> tuple[Floats, Floats]:
        """Mean (9,) and covariance (9, 9) in the state of ``HorizontalFilter``."""
        if self._moments is None:
            weights, particles = normalised(self._log_weights), self._particles
            states = np.empty((PARTICLES, STATES))
            states[:, :2] = particles[:, :2]
            states[:, 2], states[:, 3] = np.cos(particles[:, 2]), np.sin(particles[:, 2])
            states[:, 2:4] *= self._scale
            states[:, SLOW], states[:, DRIFT] = self._slow, particles[:, 3]
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

    def _innovations(self, observation: GnssObservation) -> tuple[Floats, Floats]:
        """Innovations by particle (n, 2), and their covariance (2, 2)."""
        since_m = self._turned(
            observation.since_north_m - self._pending[0],
            observation.since_east_m - self._pending[1],
        )
        seen_m = np.array([observation.north_m, observation.east_m])
        observe = slow_error_jacobian(observation)
        apart = seen_m + since_m - self._particles[:, :2] - self._slow @ observe.T
        spread = observe @ self._slow_covariance @ observe.T + observation.white_m2 * np.eye(2)
        return apart, spread

    def _turned(self, north_m: float, east_m: float) -> Floats:
        """An own-frame vector in the incident frame, by every particle (n, 2)."""
        cosine = self._scale * np.cos(self._particles[:, 2])
        sine = self._scale * np.sin(self._particles[:, 2])
        return np.stack(
            [cosine * north_m - sine * east_m, sine * north_m + cosine * east_m], axis=1
        )

    def _resample(self) -> None:
        """Resample, with jitter, where the effective number of particles is low."""
        weights = normalised(self._log_weights)
        self._log_weights -= self._log_weights.max()
        if 1.0 / float(weights @ weights) > 0.5 * PARTICLES:
            return
        left = resampled(weights, PARTICLES, self._rng)
        self._particles, self._slow = jittered(self._particles[left], self._rng), self._slow[left]
        self._log_weights = np.zeros(PARTICLES)
        self._moments = None
