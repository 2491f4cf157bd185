"""Guesses and their weights: which are drawn, and how they are shaken."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

KEPT = 0.97  # how much of themselves guesses keep when drawn anew (Liu and West 2001)
SHAKEN_M = 0.05  # and how far their places are shaken


def normal(log_weights: Floats) -> Floats:
    """Weights whose sum is 1."""
    weights = np.exp(log_weights - log_weights.max())
    return np.asarray(weights / weights.sum())


def picked(weights: Floats, count: int, rng: np.random.Generator) -> NDArray[np.intp]:
    """Which are drawn, evenly."""
    at = (np.arange(count) + rng.random()) / count
    return np.minimum(np.searchsorted(np.cumsum(weights), at), len(weights) - 1)


def shaken(guesses: Floats, rng: np.random.Generator) -> Floats:
    """Guesses (n, 4) of north, east, turn and drift, so that those drawn twice are two."""
    guesses, inner = guesses.copy(), guesses[:, 2:]
    middle = inner[0] + wrapped(inner - inner[0]).mean(axis=0)
    off = wrapped(inner - middle)
    fresh = rng.normal(size=(len(guesses), 4))
    spread = math.sqrt(1.0 - KEPT**2) * off.std(axis=0)
    guesses[:, 2:] = middle + KEPT * off + spread * fresh[:, 2:]
    guesses[:, :2] += SHAKEN_M * fresh[:, :2]
    return guesses


def squares(apart: Floats, spread: Floats) -> Floats:
    """Chi-squares (n,) of rows."""
    return np.asarray(((apart @ np.linalg.inv(spread)) * apart).sum(axis=1))


def wrapped(turn_and_drift: Floats) -> Floats:
    turn_and_drift[:, 0] = (turn_and_drift[:, 0] + math.pi) % (2.0 * math.pi) - math.pi
    return turn_and_drift
