"""Map-matching particle filter: places on a plan whose walls people do not cross.

A particle is a place, a heading correction, a drift rate and a scale; the path moves all, and one
that crosses a wall of the plan loses weight (Woodman and Harle 2008). The stages of a step: predict
(``Particles.predict``), weight (``particle_likelihood``), resample (``Particles.reweight``) and
estimate (``Particles.moments``); ``reseeding`` searches elsewhere where walls contradict the path.
"""

from __future__ import annotations

import math

import msgspec
import numpy as np
from numpy.typing import NDArray

from base_station.fusion.horizontal.heading_hypotheses import GnssObservation
from base_station.fusion.horizontal.motion_window import MotionStep, MotionWindow
from base_station.fusion.horizontal.particle_likelihood import (
    distance2,
    innovations,
    posterior_log_ratio,
    wall_likelihood,
)
from base_station.fusion.horizontal.particles import PARTICLES, Particles, SavedParticles
from base_station.fusion.horizontal.resampling import normalised
from base_station.fusion.horizontal.reseeding import Reseeding, log_density_ratio, reseed
from base_station.fusion.kernels import STATES
from base_station.fusion.wall_likelihood import CLIMBS, UNSEEN_M, log_beside_wall
from base_station.site.floor_grid import FloorGrid

Floats = NDArray[np.float64]

MOVE_M = 0.35  # walked until the particles are moved and walls looked at
MIN_EFFECTIVE_PART = 0.1  # of the particles, that agree with a posterior: else they begin anew
CONTRADICTED = 1.0  # of log weight lost a move, on the mean: the plan or the path is wrong
OBSTRUCTED = 0.2  # the same where the plan or the path may be wrong
CONTRADICTION_GAIN = 1.0 / 30.0  # of that mean, a move
DOUBTFUL_LOG_LIKELIHOOD = -8.0  # of the walls met of late: below, another place may be likelier
RELOCALISE_EVERY_M = 5.0  # walked between two attempts
MIN_LOG_ODDS, MAX_LOG_ODDS = -3.0, 30.0  # logarithms; less is let be
SPLIT_STD_M = 1.5  # standard deviation of a place below which one is left


class SavedMapParticles(msgspec.Struct, frozen=True):
    particles: SavedParticles
    pending: list[float]
    contradiction: float
    window: list[MotionStep] = msgspec.field(default_factory=list)
    to_relocalise_m: float = 0.0
    split: bool = False


class MapParticleFilter:
    """Begun from the moments of ``HorizontalFilter``, and given back as such."""

    def __init__(self, mean: Floats, covariance: Floats, seed: int) -> None:
        self._particles = Particles(mean, covariance, seed)
        self._window = MotionWindow([])
        self._to_relocalise_m = 0.0
        self._split = False
        self._pending = np.zeros(4)  # own north and east, seconds moving, climbed
        self._contradiction = 0.0

    def save(self) -> SavedMapParticles:
        return SavedMapParticles(
            self._particles.save(),
            self._pending.tolist(),
            self._contradiction,
            self._window.save(),
            self._to_relocalise_m,
            self._split,
        )

    @staticmethod
    def restore(saved: SavedMapParticles) -> MapParticleFilter:
        cloud = MapParticleFilter(np.eye(STATES)[2], np.eye(STATES), 0)
        cloud._particles = Particles.restore(saved.particles)
        cloud._pending = np.array(saved.pending)
        cloud._contradiction = saved.contradiction
        cloud._window = MotionWindow(list(saved.window))
        cloud._to_relocalise_m, cloud._split = saved.to_relocalise_m, saved.split
        return cloud

    @property
    def is_contradicted(self) -> bool:
        """Move after move walls stood in the way of nearly all particles."""
        return self._contradiction > CONTRADICTED

    @property
    def is_obstructed(self) -> bool:
        """Walls stood in the way of many particles of late."""
        return self._contradiction > OBSTRUCTED

    @property
    def wall_log_loss(self) -> float:
        """Logarithm (0 or more) of the likelihood that crossed walls have cost of late."""
        return self._contradiction / CONTRADICTION_GAIN

    @property
    def is_doubtful(self) -> bool:
        """True where the cloud has just moved and recent walls were unlikely."""
        moved = not self._pending.any()
        return (
            moved
            and self._to_relocalise_m <= 0.0
            and self._window.log_likelihood < DOUBTFUL_LOG_LIKELIHOOD
        )

    @property
    def is_split(self) -> bool:
        """True while more than one place is likely."""
        return self._split

    def predict(
        self,
        path: tuple[float, float, float, float],
        noise: tuple[float, float],
        grid: FloorGrid,
        floor: int | None,
    ) -> None:
        """Predict, weight by walls and resample. ``path``: own north and east, seconds moving and
        metres climbed (up positive); ``noise``: variances of place and turn by metre walked.
        """
        self._pending += path
        way_m = math.hypot(self._pending[0], self._pending[1])
        if way_m < MOVE_M:
            return
        north_m, east_m, moving_s, climbed_m = self._pending.tolist()
        self._pending[:] = 0.0
        from_m = self._particles.predict(north_m, east_m, moving_s, noise)
        checked_floor, log_likelihood, climbs = None, 0.0, abs(climbed_m) > CLIMBS * way_m
        log_beside = 0.0
        if floor is not None and grid.has_floor(floor) and way_m < UNSEEN_M:
            checked_floor = floor
            log_beside = float(log_beside_wall(np.array(noise[0] * way_m)))
            log_likelihood = self._weight_by_walls(
                grid, floor, from_m, climbs=climbs, log_beside=log_beside
            )
        self._window.append(
            MotionStep(north_m, east_m, moving_s, climbs, checked_floor, log_likelihood, log_beside)
        )
        self._to_relocalise_m -= way_m
        self._update_is_split()

    def update(self, observation: GnssObservation) -> None:
        """Weight by a GNSS observation and resample."""
        particles = self._particles
        particles.update(*innovations(particles, observation, self._pending))
        self._update_is_split()

    def reweight_to(self, mean: Floats, covariance: Floats) -> bool:
        """Reweight the cloud to moments (5,), (5, 5) of ``[north, east, c, s, drift]`` from another
        source: particles are weighted by the ratio of that density to the one of the cloud's own
        moments, so that what walls have shown is kept. False, and nothing changed, where too few
        effective particles are left.
        """
        gain = posterior_log_ratio(self._particles, mean, covariance, self._pending)
        log_weights = self._particles.log_weights + gain
        after = normalised(log_weights)
        if 1.0 / float(after @ after) < MIN_EFFECTIVE_PART * PARTICLES:
            return False
        self._contradiction, self._window = 0.0, MotionWindow([])
        self._particles.reweight(log_weights)
        self._update_is_split()
        return True

    def moments(self) -> tuple[Floats, Floats]:
        """Mean (9,) and covariance (9, 9) in the state of ``HorizontalFilter``."""
        mean, covariance = self._particles.moments()
        north_m, east_m = float(self._pending[0]), float(self._pending[1])
        mean = mean.copy()
        mean[0] += mean[2] * north_m - mean[3] * east_m
        mean[1] += mean[3] * north_m + mean[2] * east_m
        return mean, covariance

    def distance2(self, observation: GnssObservation) -> float:
        """Squared distance to the cloud as one normal distribution, chi-square of two degrees of
        freedom.
        """
        particles = self._particles
        return distance2(particles, innovations(particles, observation, self._pending))

    def set_map(self, grid: FloorGrid) -> None:
        """Use other walls than before: the recent path is weighted by them."""
        particles = self._particles
        met = self._window.wall_log_likelihood(particles.states, grid, -math.inf)
        self._window.set_log_likelihood(float(np.logaddexp.reduce(particles.log_shares + met)))
        self._to_relocalise_m = 0.0

    def try_relocalise(self, known: tuple[Floats, Floats], grid: FloorGrid) -> None:
        """Compare the cloud with particles drawn from the estimate without walls (9,), (9, 9) by
        the walls of the recent path, and keep both by their odds. Only where the cloud has just
        moved.
        """
        self._to_relocalise_m = RELOCALISE_EVERY_M
        particles, window = self._particles, self._window
        states, weights = particles.states, particles.weights
        inside = bool(grid.is_in_building((weights @ states[:, :2])[None])[0])
        found = reseed(known, window, grid, particles.rng, inside=inside)
        fits = log_density_ratio(known, states[:, :2], grid) - window.log_free_fraction(
            states, grid
        )
        log_likelihood = window.log_likelihood - float(
            weights @ window.repeated_wall_log_ratio(states, grid)
        )
        log_likelihood += float(np.logaddexp.reduce(particles.log_shares + fits))
        if found is not None and (log_odds := found.log_odds(log_likelihood)) > MIN_LOG_ODDS:
            self._mix_in(found, min(log_odds, MAX_LOG_ODDS))

    def scale_drift(self, share: float) -> None:
        """Scale every drift rate."""
        self._particles.scale_drift(share)

    def inflate_place(self, variance_m2: float) -> None:
        self._particles.inflate_place(variance_m2)
        self._window = MotionWindow([])

    def decay_slow_errors(self, keeps: Floats) -> None:
        """Time went by for the fixes' slow errors (4,), of unit variance."""
        self._particles.decay_slow_errors(keeps)

    def _weight_by_walls(
        self, grid: FloorGrid, floor: int, from_m: Floats, *, climbs: bool, log_beside: float
    ) -> float:
        """Weight particles by the walls they crossed; returns the log likelihood of the step."""
        particles, before = self._particles, self._particles.weights
        crossed, met = wall_likelihood(
            particles, grid, floor, from_m, climbs=climbs, log_beside=log_beside
        )
        passed = float(before @ np.exp(crossed))
        self._contradiction += CONTRADICTION_GAIN * (-math.log(passed) - self._contradiction)
        particles.reweight(particles.log_weights + met)
        return math.log(float(before @ np.exp(met)))

    def _mix_in(self, found: Reseeding, log_odds: float) -> None:
        """Replace a part of the particles; ``log_odds``: logarithm of the odds of the new ones
        against the cloud.
        """
        part, rest = 1.0 / (1.0 + math.exp(-log_odds)), 1.0 / (1.0 + math.exp(log_odds))
        least = round(MIN_EFFECTIVE_PART * PARTICLES)
        count = min(max(round(part * PARTICLES), least), PARTICLES - least)
        self._particles.replace_part(found, count, part, rest)
        self._window.set_log_likelihood(part * found.met + rest * self._window.log_likelihood)
        self._split = True
        self._update_is_split()

    def _update_is_split(self) -> None:
        """End the split once the particles lie together."""
        if self._split:
            _, covariance = self.moments()
            self._split = bool(covariance[0, 0] + covariance[1, 1] > SPLIT_STD_M**2)
