"""Recordings from elsewhere on the body: lower backs and telephones, for ``muster bench track``.

Whatever was fitted to people is left out for the person who is scored: a length of one person is
corrected by what the tracker makes of all others.
"""

from __future__ import annotations

import json
import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import permutations
from pathlib import Path

import msgspec
import numpy as np
from numpy.typing import NDArray
from rich import box
from rich.table import Table

from edge.agent.step_learning import learn, scale_by_length
from edge.app.track import run_tracker
from edge.samples import Floats
from edge.sources.recording import RecordedTruth, RecordingSource, read_truth
from edge.tracker.body.config import BodyConfig
from edge.tracker.interface import FOOT, TrackBatch
from edge.tracker.registry import TRACKERS
from shared.errors import UserError
from shared.path_noise import PathNoise
from tests.bench.tracker.scoring import (
    CHI2_95_2DOF,
    horizontal_nees,
    rows_at,
    turn_about_start,
)

_BEFORE_S, _AFTER_S = 0.8, 1.2  # of the marked walk: they stand
_RETURN_STD_M = 0.2  # to which people come back to where they began
_WAYPOINT_STD_M = 0.5  # to which they stand where they say
_FIT_OF = {"body"}  # trackers with a length that was fitted to these people


class _Walk(msgspec.Struct):
    """Fields in use of the ``trial.json`` of a walk."""

    subject: int
    path_length_m: float
    walk_s: tuple[float, float]


@dataclass(frozen=True, slots=True)
class ReturnWalk:
    """One walk out and back."""

    person: int
    length_m: float  # in truth
    length_ratio: float  # tracked by true
    closure_m: float
    covered: bool  # where it began is in the stated 95 % region of its end


@dataclass(frozen=True, slots=True)
class Elsewhere:
    """Figures of one tracker; shares are of 1."""

    tracker: str
    backs: int
    length_error: float  # median, the person left out of the fit
    known_length_error: float  # median, scaled by another walk of the same person
    learnt_length_error: float  # median, learnt from another walk as `muster edge learn-steps` does
    closure_median_m: float
    closure_coverage_95: float
    phones: int
    waypoint_error: float  # median over walks of the median error, by the way
    waypoint_error_90: float  # ... of the worst tenth
    phone_length_error: float  # median
    waypoint_coverage_95: float


def measure_elsewhere(data: Path) -> list[Elsewhere]:
    """Run every tracker that is not for a foot over the recordings below ``data``."""
    names = [entry.name for entry in TRACKERS if FOOT not in entry.worn_on]
    return [measure_tracker_elsewhere(data, name) for name in names]


def measure_tracker_elsewhere(data: Path, name: str) -> Elsewhere:
    """Run one tracker over the recordings below ``data``."""
    backs = sorted(data.glob("body/ipol/*/lower_back.csv.gz"))
    phones = _phones(data)
    if not backs or not phones:
        raise UserError(f"no body/ipol and phones below {data}; give the folder of both")
    walks = [track_back(path, name) for path in backs]
    ways = [_track_phone(path, name) for path in phones]
    waypoint_errors = [float(np.median(way.error_m)) / way.length_m for way in ways]
    return Elsewhere(
        tracker=name,
        backs=len(walks),
        length_error=float(np.median(left_out_errors(walks, fitted=name in _FIT_OF))),
        known_length_error=float(np.median(list(_known_length_errors(walks)))),
        learnt_length_error=float(np.median(list(_learnt_length_errors(walks)))),
        closure_median_m=float(np.median([walk.closure_m for walk in walks])),
        closure_coverage_95=float(np.mean([walk.covered for walk in walks])),
        phones=len(ways),
        waypoint_error=float(np.median(waypoint_errors)),
        waypoint_error_90=float(np.quantile(waypoint_errors, 0.9)),
        phone_length_error=float(np.median([abs(way.length_ratio - 1.0) for way in ways])),
        waypoint_coverage_95=float(np.mean(np.concatenate([way.covered for way in ways]))),
    )


def phone_length_ratios(data: Path, name: str) -> list[float]:
    """Return tracked by true length of every walk with a telephone."""
    return [_track_phone(path, name).length_ratio for path in _phones(data)]


def _phones(data: Path) -> list[Path]:
    return sorted(path.parent for path in data.glob("phones/*/*/imu.csv.gz"))


def track_back(file: Path, name: str) -> ReturnWalk:
    """Track one lower back between standing and standing."""
    return score_return(file.parent, run_tracker(RecordingSource(file), name, quiet=True))


def score_return(folder: Path, rows: TrackBatch) -> ReturnWalk:
    """Score the rows of a walk out and back between standing and standing."""
    text = (folder / "trial.json").read_text(encoding="utf-8")
    trial = msgspec.convert(json.loads(text), _Walk)  # a weight may be NaN
    first_s, last_s = trial.walk_s[0] - _BEFORE_S, trial.walk_s[1] + _AFTER_S
    place_m, covariance_m2 = rows_at(rows, np.array([first_s, last_s]))
    distance_m = np.interp([first_s, last_s], rows.t_ns * 1e-9, rows.distance_m)
    known_m2 = covariance_m2[1:] + _RETURN_STD_M**2 * np.eye(3)
    nees = horizontal_nees(place_m[1:], place_m[:1], known_m2)
    return ReturnWalk(
        person=trial.subject,
        length_m=trial.path_length_m,
        length_ratio=float(distance_m[1] - distance_m[0]) / trial.path_length_m,
        closure_m=float(np.hypot(*(place_m[1] - place_m[0])[:2])),
        covered=bool(nees[0] <= CHI2_95_2DOF),
    )


def left_out_errors(walks: Sequence[ReturnWalk], *, fitted: bool) -> list[float]:
    """Return the share by which each length is off, corrected by all other people if fitted."""
    errors = []
    for walk in walks:
        others = [other.length_ratio for other in walks if other.person != walk.person]
        scale = float(np.exp(np.mean(np.log(others)))) if fitted else 1.0
        errors.append(abs(walk.length_ratio / scale - 1.0))
    return errors


def _known_length_errors(walks: Sequence[ReturnWalk]) -> Iterator[float]:
    """Each walk, scaled by each other walk of the same person."""
    for known, walk in permutations(walks, 2):
        if known.person == walk.person:
            yield abs(walk.length_ratio / known.length_ratio - 1.0)


def _learnt_length_errors(walks: Sequence[ReturnWalk]) -> Iterator[float]:
    """Each walk, with the steps that each other walk of the same person has shown."""
    config = BodyConfig()
    noise = PathNoise(None, config.trunk_step_std * math.sqrt(config.usual_step_m))
    for known, walk in permutations(walks, 2):
        if known.person == walk.person:
            tracked_m = known.length_ratio * known.length_m
            learnt = learn(None, scale_by_length(known.length_m, tracked_m, noise))
            yield abs(walk.length_ratio * learnt.factor - 1.0)


@dataclass(frozen=True, slots=True, eq=False)
class _Way:
    """One walk with a telephone, its start and first heading held."""

    length_m: float
    length_ratio: float
    error_m: Floats  # (waypoints - 1,)
    covered: NDArray[np.bool_]


def _track_phone(trial: Path, name: str) -> _Way:
    truth = read_truth(trial)
    assert truth is not None, trial
    rows = run_tracker(RecordingSource(trial), name, quiet=True)
    away_m = truth.position_n_m - truth.position_n_m[0]
    length_m = float(np.hypot(*np.diff(away_m[:, :2], axis=0).T).sum())
    held_m, held_m2 = _held(rows, RecordedTruth(truth.t_s, away_m))
    known_m2 = held_m2 + _WAYPOINT_STD_M**2 * np.eye(3)
    distance_m = np.interp(truth.t_s[[0, -1]], rows.t_ns * 1e-9, rows.distance_m)
    return _Way(
        length_m=length_m,
        length_ratio=float(distance_m[1] - distance_m[0]) / length_m,
        error_m=np.hypot(*(held_m - away_m)[1:, :2].T),
        covered=np.asarray(horizontal_nees(held_m, away_m, known_m2)[1:] <= CHI2_95_2DOF),
    )


def _held(rows: TrackBatch, truth: RecordedTruth) -> tuple[Floats, Floats]:
    estimate_n_m, covariance_m2 = rows_at(rows, truth.t_s)
    flat = truth.position_n_m.copy()
    flat[:, 2] = 0.0
    return turn_about_start(estimate_n_m - estimate_n_m[0], covariance_m2, flat)


def elsewhere_table(results: Sequence[Elsewhere]) -> Table:
    table = Table(title="Elsewhere on the body", box=box.SIMPLE_HEAD)
    for title in (
        "tracker",
        "lower backs",
        "length off, %",
        "after one known, %",
        "... learnt, %",
        "closure, m",
        "in 95 %",
        "telephones",
        "waypoints off, % of way",
        "worst tenth",
        "length off, %",
        "in 95 %",
    ):
        table.add_column(title, justify="left" if title == "tracker" else "right")
    for one in results:
        table.add_row(
            one.tracker,
            str(one.backs),
            f"{100.0 * one.length_error:.1f}",
            f"{100.0 * one.known_length_error:.1f}",
            f"{100.0 * one.learnt_length_error:.1f}",
            f"{one.closure_median_m:.2f}",
            f"{100.0 * one.closure_coverage_95:.0f}",
            str(one.phones),
            f"{100.0 * one.waypoint_error:.1f}",
            f"{100.0 * one.waypoint_error_90:.1f}",
            f"{100.0 * one.phone_length_error:.1f}",
            f"{100.0 * one.waypoint_coverage_95:.0f}",
        )
    return table
