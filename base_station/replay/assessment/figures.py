"""Errors in the terms of ISO/IEC 18305: circular, vertical and spherical error of 50 and 95 %."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from scipy.special import erf

from base_station.storage.db.records import TrackSample
from base_station.views.answer import Answer

Floats = NDArray[np.float64]

DRAWS = 512  # of each place's normal distribution; they are the same for every place
MOST_PLACES = 300


class Figures(Answer, frozen=True):
    """Metres; half, or 95 %, of all errors are no larger."""

    ce50_m: float
    ce95_m: float
    ve50_m: float
    ve95_m: float
    se50_m: float
    se95_m: float


def stated_m(samples: Sequence[TrackSample]) -> Floats:
    """Standard deviations (n, 3) north, east, down."""
    stds = [(one.std_north_m, one.std_east_m, one.std_down_m) for one in samples]
    return np.array(stds).reshape(-1, 3)


def stated_figures(stds_m: Floats) -> Figures | None:
    """Return the figures that the standard deviations (n, 3) state; None without any."""
    if not len(stds_m):
        return None
    stds = stds_m[:: max(1, len(stds_m) // MOST_PLACES)]
    draws = np.random.default_rng(18305).standard_normal((DRAWS, 3))
    return figures_of((stds[:, None, :] * draws[None, :, :]).reshape(-1, 3))


def figures_of(errors_m: Floats) -> Figures | None:
    """Figures of errors (n, 3) north, east, down."""
    if not len(errors_m):
        return None
    circular = np.hypot(errors_m[:, 0], errors_m[:, 1])
    vertical = np.abs(errors_m[:, 2])
    spherical = np.linalg.norm(errors_m, axis=1)
    values = [
        round(float(np.percentile(one, percent)), 3)
        for one in (circular, vertical, spherical)
        for percent in (50.0, 95.0)
    ]
    return Figures(*values)


def errors_against(live: Sequence[TrackSample], truth: Sequence[TrackSample]) -> Floats:
    """North, east and down (n, 3) of each live place less the other trail's at that time, where
    that trail reaches.
    """
    if not live or not truth:
        return np.zeros((0, 3))
    begin_ns, end_ns = truth[0].t_ns, truth[-1].t_ns
    inside = [one for one in live if begin_ns <= one.t_ns <= end_ns]
    t_s = np.array([(one.t_ns - begin_ns) * 1e-9 for one in inside])
    true_t_s = np.array([(one.t_ns - begin_ns) * 1e-9 for one in truth])
    columns = [
        np.array([getattr(one, name) for one in inside])
        - np.interp(t_s, true_t_s, [getattr(one, name) for one in truth])
        for name in ("north_m", "east_m", "down_m")
    ]
    return np.column_stack(columns)


def floor_probability(samples: Sequence[TrackSample], storey_m: float) -> float | None:
    """Probability that the shown floor is right, by the stated standard deviations of height."""
    if not samples:
        return None
    std = np.maximum([one.std_down_m for one in samples], 1e-3)
    return round(float(np.mean(erf(storey_m / 2.0 / (np.sqrt(2.0) * std)))), 4)
