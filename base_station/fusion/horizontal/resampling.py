"""Particles by their weights: systematic resampling, and jitter for those drawn twice."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

KEPT = 0.99  # how much of themselves particles keep when drawn anew (Liu and West 2001)
JITTER_M = 0.05  # and how far their places are shaken


def normalised(log_weights: Floats) -> Floats:
    """Weights whose sum is 1."""
    weights = np.exp(log_weights - log_weights.max())
    return np.asarray(weights / weights.sum())


def resampled(weights: Floats, count: int, rng: np.random.Generator) -> NDArray[np.intp]:
    """Indices (count,) drawn by systematic resampling (Kitagawa 1996)."""
    at = (np.arange(count) + rng.random()) / count
    return np.minimum(np.searchsorted(np.cumsum(weights), at), len(weights) - 1)


def jittered(particles: Floats, rng: np.random.Generator) -> Floats:
    """Particles (n, 5) of north, east, turn, drift and scale, so that those drawn twice are two."""
    particles, inner = particles.copy(), particles[:, 2:]
    middle = inner[0] + wrapped(inner - inner[0]).mean(axis=0)
    off = wrapped(inner - middle)
    fresh = rng.normal(size=particles.shape)
    spread = math.sqrt(1.0 - KEPT**2) * off.std(axis=0)
    particles[:, 2:] = middle + KEPT * off + spread * fresh[:, 2:]
    particles[:, :2] += JITTER_M * fresh[:, :2]
    return particles


def mahalanobis2(apart: Floats, spread: Floats) -> Floats:
    """Chi-squares (n,) of rows."""
    return np.asarray(((apart @ np.linalg.inv(spread)) * apart).sum(axis=1))


def wrapped(inner: Floats) -> Floats:
    inner[:, 0] = (inner[:, 0] + math.pi) % (2.0 * math.pi) - math.pi
    return inner
