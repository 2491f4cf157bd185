"""Particles of a place, heading correction, drift rate and scale: prediction, resampling and
moments.

Given a particle's path, the slow error of fixes is a linear problem with one covariance for all
particles, as in ``heading_hypotheses`` (a Rao-Blackwellised filter).  Random numbers come from a
seeded generator whose state is part of the particles.
"""

from __future__ import annotations

import math

import msgspec
import numpy as np
from numpy.typing import NDArray

from base_station.fusion.horizontal.resampling import jittered, normalised, resampled
from base_station.fusion.horizontal.reseeding import Reseeding
from base_station.fusion.horizontal.sampling import draw
from base_station.fusion.horizontal.state import SCALE, SLOW
from base_station.fusion.kernels import DRIFT, STATES

Floats = NDArray[np.float64]

PARTICLES = 400
FLOOR_VAR_M2 = 0.2**2  # of any place: people do not walk on lines, and plans lie decimetres aside


class SavedParticles(msgspec.Struct, frozen=True):
    states: bytes
    log_weights: bytes
    slow: bytes
    slow_covariance: list[list[float]]
    scale: float
    scale_var: float
    random: tuple[str, str, int, int]


class Particles:
    """Weighted particles; arrays are by particle."""

    def __init__(self, mean: Floats, covariance: Floats, seed: int) -> None:
        """Draw them from the moments (9,), (9, 9) of ``HorizontalFilter``."""
        self.rng = np.random.Generator(np.random.PCG64(seed))
        drawn = draw(mean, covariance, self.rng, np.ones(PARTICLES))
        self.states, self.slow, self.slow_covariance = drawn  # (n, 5), (n, 4), (4, 4)
        self.log_weights = np.zeros(PARTICLES)
        self._moments: tuple[Floats, Floats] | None = None

    def save(self) -> SavedParticles:
        random = self.rng.bit_generator.state
        inner = random["state"]
        scale = self.states[:, SCALE]
        mean = float(self.weights @ scale)
        return SavedParticles(
            self.states.tobytes(),
            self.log_weights.tobytes(),
            self.slow.tobytes(),
            self.slow_covariance.tolist(),
            mean,
            float(self.weights @ (scale - mean) ** 2),
            (str(inner["state"]), str(inner["inc"]), random["has_uint32"], random["uinteger"]),
        )

    @staticmethod
    def restore(saved: SavedParticles) -> Particles:
        particles = Particles(np.eye(STATES)[2], np.eye(STATES), 0)
        states = np.frombuffer(saved.states).reshape(PARTICLES, -1)
        if states.shape[1] == SCALE:  # saved when all had one scale
            drawn = particles.rng.normal(saved.scale, math.sqrt(saved.scale_var), PARTICLES)
            states = np.column_stack((states, drawn))
        particles.states = states.copy()
        particles.log_weights = np.frombuffer(saved.log_weights).copy()
        particles.slow = np.frombuffer(saved.slow).reshape(PARTICLES, 4).copy()
        particles.slow_covariance = np.array(saved.slow_covariance)
        state, inc, has_uint32, uinteger = saved.random
        particles.rng.bit_generator.state = {
            "bit_generator": "PCG64",
            "state": {"state": int(state), "inc": int(inc)},
            "has_uint32": has_uint32,
            "uinteger": uinteger,
        }
        return particles

    @property
    def weights(self) -> Floats:
        """Weights whose sum is 1."""
        return normalised(self.log_weights)

    @property
    def log_shares(self) -> Floats:
        """Logarithms of the weights."""
        return np.asarray(self.log_weights - np.logaddexp.reduce(self.log_weights))

    def turned(self, north_m: float, east_m: float) -> Floats:
        """An own-frame vector in the incident frame, by every particle (n, 2)."""
        cosine, sine = self.turn_and_scale().T
        return np.stack(
            [cosine * north_m - sine * east_m, sine * north_m + cosine * east_m], axis=1
        )

    def turn_and_scale(self) -> Floats:
        """Cosine and sine of the turn times the scale (n, 2)."""
        turn_rad, scale = self.states[:, 2], self.states[:, SCALE]
        return np.column_stack((scale * np.cos(turn_rad), scale * np.sin(turn_rad)))

    def predict(
        self, north_m: float, east_m: float, moving_s: float, noise: tuple[float, float]
    ) -> Floats:
        """Move along the own path; ``noise``: variances of place and turn by metre walked.
        Returns the places (n, 2) before.
        """
        way_m = math.hypot(north_m, east_m)
        fresh = self.rng.normal(size=(PARTICLES, 3))
        states = self.states
        states[:, 2] += states[:, 3] * moving_s + math.sqrt(noise[1] * way_m) * fresh[:, 2]
        from_m = states[:, :2].copy()
        states[:, :2] += self.turned(north_m, east_m)
        states[:, :2] += math.sqrt(noise[0] * way_m) * fresh[:, :2]
        self._moments = None
        return from_m

    def scale_drift(self, share: float) -> None:
        """Scale every drift rate."""
        self.states[:, 3] *= share
        self._moments = None

    def inflate_place(self, variance_m2: float) -> None:
        self.states[:, :2] += math.sqrt(variance_m2) * self.rng.normal(size=(PARTICLES, 2))
        self._moments = None

    def decay_slow_errors(self, keeps: Floats) -> None:
        """Time went by for the fixes' slow errors (4,), of unit variance."""
        self.slow *= keeps
        self.slow_covariance *= np.outer(keeps, keeps)
        self.slow_covariance += np.diag(1.0 - keeps**2)
        self._moments = None

    def update(self, apart: Floats, spread: Floats, observe: Floats) -> None:
        """Weight by innovations (n, 2), whose covariance (2, 2) all share, and update the slow
        errors by their Jacobian (2, 4).
        """
        inverse = np.linalg.inv(spread)
        log_weights = self.log_weights - 0.5 * ((apart @ inverse) * apart).sum(axis=1)
        gain = self.slow_covariance @ observe.T @ inverse
        self.slow += apart @ gain.T
        self.slow_covariance = self.slow_covariance - gain @ observe @ self.slow_covariance
        self.reweight(log_weights)

    def reweight(self, log_weights: Floats) -> None:
        """Set the logarithms of weights, and resample, with jitter, where the effective number of
        particles is low.
        """
        self.log_weights, self._moments = log_weights, None
        weights = self.weights
        self.log_weights -= self.log_weights.max()
        if 1.0 / float(weights @ weights) > 0.5 * PARTICLES:
            return
        left = resampled(weights, PARTICLES, self.rng)
        self.states, self.slow = jittered(self.states[left], self.rng), self.slow[left]
        self.log_weights = np.zeros(PARTICLES)

    def replace_part(self, found: Reseeding, count: int, part: float, rest: float) -> None:
        """Replace so many particles by reseeded ones, which then have ``part`` of the weight; those
        that are kept have the ``rest``.
        """
        kept = resampled(self.weights, PARTICLES - count, self.rng)
        fresh, slow = found.draw(count, self.rng)
        self.states = np.concatenate((fresh, self.states[kept]))
        self.slow = np.concatenate((slow, self.slow[kept]))
        self.slow_covariance = found.drawn.slow_covariance
        shares = part / count, rest / (PARTICLES - count)
        self.log_weights = np.log(np.repeat(shares, (count, PARTICLES - count)))
        self._moments = None

    def moments(self) -> tuple[Floats, Floats]:
        """Mean (9,) and covariance (9, 9) in the state of ``HorizontalFilter``."""
        if self._moments is None:
            weights, particles = self.weights, self.states
            states = np.empty((PARTICLES, STATES))
            states[:, :2] = particles[:, :2]
            states[:, 2:4] = self.turn_and_scale()
            states[:, SLOW], states[:, DRIFT] = self.slow, particles[:, 3]
            mean = weights @ states
            apart = states - mean
            covariance = (apart * weights[:, None]).T @ apart
            covariance[SLOW, SLOW] += self.slow_covariance
            covariance[[0, 1], [0, 1]] += FLOOR_VAR_M2
            self._moments = mean, covariance
        return self._moments
