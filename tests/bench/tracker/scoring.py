"""Scores of a track: error figures against a reference, or against closing the loop.

A foot tracker knows neither where north is nor where it started, so a reference
is first turned about the vertical and shifted, never scaled or mirrored.
Positions are (n, 3) NED in m.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from edge.samples import Floats
from edge.sources.recording import RecordedTruth
from edge.tracker.interface import Quality, TrackBatch

_KNOWN_M = 0.02  # to which the truth is
CHI2_95_2DOF = 5.991464547107979  # the 95 % quantile of chi-square with two degrees of freedom
CHI2_95_1DOF = 3.841458820694124  # ... with one
_FASTEST_MPS = 12.0  # that a foot is moved; a truth that jumps farther had been held before
_SILENT = 3.0  # stated regions by which an error is off that a good quality must not have


@dataclass(frozen=True, slots=True)
class Score:
    """Figures of one trial; ``None`` where its reference cannot say."""

    samples: int
    lost: float  # share of the rows whose quality is lost
    distance_m: float
    closure_horizontal_m: float  # last position from the first
    closure_vertical_m: float
    ate_m: float | None  # RMS horizontal distance after fitting yaw and translation
    armse_2d_m: float | None  # the same divided by the square root of 2
    per_cent_of_distance: float | None  # ATE, or the closure of a closed loop, by distance
    vertical_rms_m: float | None  # after fitting the mean height
    coverage_95: float | None  # share of reference points in the stated 95 % ellipse, fitted
    coverage_95_from_start: float | None  # the same, start held, turned by the first heading only
    mean_nees: float | None  # of the fitted horizontal error; 2 is honest
    coverage_95_vertical: float | None  # share of heights in the stated 95 % interval, start held
    stated_by_error: float | None  # RMS stated horizontally by RMS error, start held; 1 is honest
    silently_wrong: float | None  # share of points over three stated regions off, quality good


def score_track(
    rows: TrackBatch,
    truth: RecordedTruth | None,
    *,
    closed_loop: bool,
    heading_known: bool = False,
) -> Score:
    """Score one trial's rows; without ``truth`` only closure and distance are known.

    ``heading_known``: the truth is in the rows' own frame, so that holding the start leaves
    nothing to fit.
    """
    position_n_m = rows.position_n_m
    step_m = position_n_m[-1] - position_n_m[0]
    distance_m = float(rows.distance_m[-1])
    closure_m = float(np.hypot(step_m[0], step_m[1]))
    figures: dict[str, Any] = dict.fromkeys(
        (
            "ate_m",
            "armse_2d_m",
            "vertical_rms_m",
            "coverage_95",
            "coverage_95_from_start",
            "mean_nees",
            "coverage_95_vertical",
            "stated_by_error",
            "silently_wrong",
        )
    )
    error_m = closure_m if closed_loop else None
    if closed_loop:
        figures |= _against_start(rows)
    if truth is not None:
        figures |= _against_truth(rows, truth, heading_known=heading_known)
        error_m = figures["ate_m"]
    return Score(
        samples=len(rows),
        lost=float(np.mean(rows.quality == Quality.LOST)),
        distance_m=distance_m,
        closure_horizontal_m=closure_m,
        closure_vertical_m=abs(float(step_m[2])),
        per_cent_of_distance=(
            100.0 * error_m / distance_m if error_m is not None and distance_m else None
        ),
        **figures,
    )


def _against_truth(
    rows: TrackBatch, truth: RecordedTruth, *, heading_known: bool
) -> dict[str, float | None]:
    estimate_n_m, covariance_m2 = rows_at(rows, truth.t_s)
    fitted_m, turned_m2 = fit_yaw(estimate_n_m, covariance_m2, truth.position_n_m)
    ate_m = rms_distance(fitted_m, truth.position_n_m)
    nees = horizontal_nees(fitted_m, truth.position_n_m, turned_m2)
    held_m, held_m2 = estimate_n_m.copy(), covariance_m2
    held_m[:, :2] += truth.position_n_m[0, :2] - held_m[0, :2]
    if not heading_known:
        held_m, held_m2 = turn_about_start(held_m, covariance_m2, truth.position_n_m)
    nees_from_start = horizontal_nees(held_m[1:], truth.position_n_m[1:], held_m2[1:])
    # By how well the truth is known, or millimetres of the first second would count.
    nees_known = horizontal_nees(held_m, truth.position_n_m, held_m2 + _KNOWN_M**2 * np.eye(3))
    up_nees = vertical_nees(held_m, truth.position_n_m, held_m2)[1:]
    _, before = _rows_before(rows, truth.t_s)
    silent = is_silent(nees_known[1:], up_nees, rows.quality[before][1:])
    return {
        "ate_m": ate_m,
        "armse_2d_m": ate_m / np.sqrt(2.0),
        "vertical_rms_m": vertical_rms(estimate_n_m, truth.position_n_m),
        "coverage_95": float(np.mean(nees <= CHI2_95_2DOF)),
        "coverage_95_from_start": float(np.mean(nees_from_start <= CHI2_95_2DOF)),
        "mean_nees": float(np.mean(nees)),
        "coverage_95_vertical": (
            None if np.isnan(up_nees).any() else float(np.mean(up_nees <= CHI2_95_1DOF))
        ),
        "stated_by_error": float(
            np.sqrt(np.mean(np.trace(held_m2[1:, :2, :2], axis1=1, axis2=2)))
            / rms_distance(held_m[1:], truth.position_n_m[1:])
        ),
        "silently_wrong": float(np.mean(silent & ~is_held(truth)[1:])),
    }


def _against_start(rows: TrackBatch) -> dict[str, float | None]:
    """Figures of a walk that ends where it began."""
    first_m, last_m, last_m2 = (
        rows.position_n_m[:1], rows.position_n_m[-1:], rows.position_cov_m2[-1:]
    )  # fmt: skip
    nees = horizontal_nees(last_m, first_m, last_m2)
    silent = is_silent(nees, vertical_nees(last_m, first_m, last_m2), rows.quality[-1:])
    closure_m = max(rms_distance(last_m, first_m), _KNOWN_M)
    return {
        "stated_by_error": float(np.sqrt(np.trace(last_m2[0, :2, :2])) / closure_m),
        "silently_wrong": float(silent[0]),
    }


def is_silent(nees: Floats, up_nees: Floats, quality: NDArray[np.uint8]) -> NDArray[np.bool_]:
    """True where an error is over three stated 95 % regions (n,) and the quality is good.

    Where the truth has no height ``up_nees`` is NaN and decides nothing.
    """
    off = (nees > _SILENT**2 * CHI2_95_2DOF) | (up_nees > _SILENT**2 * CHI2_95_1DOF)
    silent: NDArray[np.bool_] = off & (quality == Quality.GOOD)
    return silent


def is_held(truth: RecordedTruth) -> NDArray[np.bool_]:
    """True where a truth (n,) repeats its last position until it jumps.

    Motion capture that has lost its markers does so; no foot goes from rest to that speed at once.
    """
    steps_m = np.linalg.norm(np.diff(truth.position_n_m[:, :2], axis=0), axis=1)
    jumps = steps_m > _FASTEST_MPS * np.diff(truth.t_s)
    held = np.zeros(len(truth.t_s), np.bool_)
    for jump in np.flatnonzero(jumps):
        first = jump
        while first > 0 and steps_m[first - 1] == 0.0:
            first -= 1
        held[first + 1 : jump + 1] = True
    return held


def rows_at(rows: TrackBatch, t_s: Floats) -> tuple[Floats, Floats]:
    """Return positions (m, 3), interpolated, and covariances (m, 3, 3) of the row before."""
    row_s, before = _rows_before(rows, t_s)
    position_n_m = np.column_stack(
        [np.interp(t_s, row_s, rows.position_n_m[:, axis]) for axis in range(3)]
    )
    return position_n_m, rows.position_cov_m2[before]


def _rows_before(rows: TrackBatch, t_s: Floats) -> tuple[Floats, NDArray[np.intp]]:
    """Return the times of the rows, and the row (m,) at or before each of ``t_s``."""
    row_s = np.asarray(rows.t_ns * 1e-9, np.float64)
    return row_s, np.clip(np.searchsorted(row_s, t_s, side="right") - 1, 0, len(rows) - 1)


def fit_yaw(
    estimate_n_m: Floats, covariance_m2: Floats, truth_n_m: Floats
) -> tuple[Floats, Floats]:
    """Return ``estimate_n_m`` turned and shifted horizontally onto the truth (least squares).

    The covariances are turned along; heights are left alone.
    """
    estimate = estimate_n_m[:, :2] - estimate_n_m[:, :2].mean(axis=0)
    truth = truth_n_m[:, :2] - truth_n_m[:, :2].mean(axis=0)
    sine = np.sum(estimate[:, 0] * truth[:, 1] - estimate[:, 1] * truth[:, 0])
    yaw_rad = float(np.arctan2(sine, np.sum(estimate * truth)))
    fitted, turned_m2 = _turned(estimate_n_m, covariance_m2, yaw_rad)
    fitted[:, :2] += truth_n_m[:, :2].mean(axis=0) - fitted[:, :2].mean(axis=0)
    return fitted, turned_m2


def turn_about_start(
    estimate_n_m: Floats, covariance_m2: Floats, truth_n_m: Floats
) -> tuple[Floats, Floats]:
    """Return ``estimate_n_m`` turned about its first point by the walk's first heading.

    That is what the frame leaves open.  Every point tells of it as far as it is known, so what the
    heading drifts by later is not spread over the beginning.
    """
    away, true = estimate_n_m[:, :2] - estimate_n_m[0, :2], truth_n_m[:, :2] - truth_n_m[0, :2]
    weight = 1.0 / (np.trace(covariance_m2[:, :2, :2], axis1=1, axis2=2) + _KNOWN_M**2)
    sine = np.sum(weight * (away[:, 0] * true[:, 1] - away[:, 1] * true[:, 0]))
    yaw_rad = float(np.arctan2(sine, np.sum(weight[:, np.newaxis] * away * true)))
    turned_m, turned_m2 = _turned(estimate_n_m - estimate_n_m[0], covariance_m2, yaw_rad)
    return turned_m + estimate_n_m[0], turned_m2


def _turned(position_n_m: Floats, covariance_m2: Floats, yaw_rad: float) -> tuple[Floats, Floats]:
    c, s = np.cos(yaw_rad), np.sin(yaw_rad)
    turn = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
    return position_n_m @ turn.T, turn @ covariance_m2 @ turn.T


def rms_distance(estimate_n_m: Floats, truth_n_m: Floats) -> float:
    """Return the root mean square horizontal distance."""
    squares = np.sum((estimate_n_m[:, :2] - truth_n_m[:, :2]) ** 2, axis=1)
    return float(np.sqrt(squares.mean()))


def vertical_rms(estimate_n_m: Floats, truth_n_m: Floats) -> float | None:
    """Return the RMS height error after taking out its mean; ``None`` for a flat truth."""
    error_m = estimate_n_m[:, 2] - truth_n_m[:, 2]
    return None if np.isnan(error_m).any() else float(np.std(error_m))


def vertical_nees(estimate_n_m: Floats, truth_n_m: Floats, covariance_m2: Floats) -> Floats:
    """Return the normalised squared height error (n,) from the first point, or NaN.

    A truth's heights, and what a shoe gives way, are no better than 2 cm.
    """
    error_m = estimate_n_m[:, 2] - truth_n_m[:, 2]
    if len(error_m) > 1:
        error_m = error_m - error_m[0]
    squares: Floats = error_m**2 / (covariance_m2[:, 2, 2] + _KNOWN_M**2)
    return squares


def horizontal_nees(estimate_n_m: Floats, truth_n_m: Floats, covariance_m2: Floats) -> Floats:
    """Return the normalised squared horizontal error (n,); chi-square with 2 when honest."""
    error_m = (estimate_n_m - truth_n_m)[:, :2, np.newaxis]
    # A millimetre keeps the first row, whose position is known by definition, solvable.
    covariance_m2 = covariance_m2[:, :2, :2] + 1e-6 * np.eye(2)
    squares: Floats = np.sum(error_m * np.linalg.solve(covariance_m2, error_m), axis=(1, 2))
    return squares
