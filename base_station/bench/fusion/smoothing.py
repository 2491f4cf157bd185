"""What is known afterwards beside what was shown at the time, and what one pin is worth.

The incidents are those of ``muster bench fusion``; the trails of all six people are smoothed
together.  A pin half a metre off is set in the middle of the ten minutes inside, once with all
that came until then and nothing later.  The times are those of ten units that walk for an hour.
"""

from __future__ import annotations

import time
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray
from rich.console import Console
from rich.progress import track as progress_bar
from rich.table import Table

from base_station.bench.fusion.kept_paths import PathKeeping
from base_station.bench.fusion.walks import RATE_HZ as WALK_RATE_HZ
from base_station.bench.fusion.walks import Receiver, Walk
from base_station.bench.incident.people import Truth
from base_station.bench.incident.scores import CHI2_95_2DOF
from base_station.bench.rig.said import mono_ns
from base_station.fusion.path.history import PathHistory
from base_station.fusion.path.points import PathArrays
from base_station.fusion.smoother.port import PlaceSeen, SmoothedPath, Smoother, UnitEvidence

Floats = NDArray[np.float64]

PIN_STD_M = 0.5
AROUND_S = 120.0  # of a pin: the trail that it should better
UNITS, HOUR_S, OUTSIDE_S = 10, 3600.0, 180.0


@dataclass(frozen=True, slots=True)
class SmoothingReport:
    """Horizontal errors in metres, live and smoothed, by way of knowing and stage."""

    smoother: str
    live_mean_m: dict[str, dict[str, float]]
    smoothed_mean_m: dict[str, dict[str, float]]
    live_ce95_m: dict[str, dict[str, float]]
    smoothed_ce95_m: dict[str, dict[str, float]]
    bound_mean_m: dict[str, tuple[float, float]]  # best by path and fixes: live, afterwards
    held_95: dict[str, dict[str, float]]  # the smoothed trail's stated region held the truth
    pin_before_m: dict[str, float]  # mean error of the trail around a pin, without it
    pin_after_m: dict[str, float]  # and with it
    hour_s: float  # CPU time of smoothing ten units that walked for an hour
    pin_solve_s: float  # and of solving one of them again with a pin


@dataclass
class _Errors:
    live: list[Floats] = field(default_factory=list)
    smoothed: list[Floats] = field(default_factory=list)
    held: list[NDArray[np.bool_]] = field(default_factory=list)


class SmoothingScores:
    """Collects incidents: what was shown of each person, and the paths behind it."""

    def __init__(self, smoother: Smoother) -> None:
        self._smoother = smoother
        self._errors: dict[str, dict[str, _Errors]] = {}
        self._pins: dict[str, list[tuple[float, float]]] = {}
        self._bound: dict[str, list[tuple[Floats, Floats]]] = {}

    def note_bound(self, truth: Truth, live_m: Floats, afterwards_m: Floats) -> None:
        """Errors (n, 2) of whoever makes the best of one person's path and fixes."""
        for stage, rows in _stages(truth).items():
            live, afterwards = (np.hypot(*one[rows].T) for one in (live_m, afterwards_m))
            self._bound.setdefault(stage, []).append((live, afterwards))

    def note(
        self,
        way: str,
        truths: list[Truth],
        shown_m: list[Floats],
        recorded: PathKeeping,
        rng: np.random.Generator,
    ) -> None:
        """One incident, person by person in the same order."""
        evidence = {
            str(number): UnitEvidence(
                history.arrays(), history.start, history.start_ns, grid=recorded.grid
            )
            for number, history in enumerate(recorded.histories)
        }
        paths = self._smoother.smooth(evidence).paths
        for number, truth in enumerate(truths):
            errors, held = _against(truth, paths[str(number)])
            live = np.linalg.norm(shown_m[number] - truth.place_m[:, :2], axis=1)
            for stage, rows in _stages(truth).items():
                one = self._errors.setdefault(way, {}).setdefault(stage, _Errors())
                one.live.append(live[rows])
                one.smoothed.append(errors[rows])
                one.held.append(held[rows])
            gain = self._pin_gain(truth, evidence[str(number)], rng)
            self._pins.setdefault(way, []).append(gain)

    def report(self, seed: int) -> SmoothingReport:
        pins = {way: np.array(gains) for way, gains in self._pins.items()}
        hour_s, pin_solve_s = _times(self._smoother, seed)
        return SmoothingReport(
            smoother=self._smoother.name,
            live_mean_m=self._each(lambda one: float(np.concatenate(one.live).mean())),
            smoothed_mean_m=self._each(lambda one: float(np.concatenate(one.smoothed).mean())),
            live_ce95_m=self._each(lambda one: _ce95_m(one.live)),
            smoothed_ce95_m=self._each(lambda one: _ce95_m(one.smoothed)),
            bound_mean_m={stage: _means(pairs) for stage, pairs in self._bound.items()},
            held_95=self._each(lambda one: float(np.concatenate(one.held).mean())),
            pin_before_m={way: float(gains[:, 0].mean()) for way, gains in pins.items()},
            pin_after_m={way: float(gains[:, 1].mean()) for way, gains in pins.items()},
            hour_s=hour_s,
            pin_solve_s=pin_solve_s,
        )

    def _each(self, figure: Any) -> dict[str, dict[str, float]]:
        return {
            way: {stage: figure(one) for stage, one in stages.items()}
            for way, stages in self._errors.items()
        }

    def _pin_gain(
        self, truth: Truth, evidence: UnitEvidence, rng: np.random.Generator
    ) -> tuple[float, float]:
        """Mean error of the trail around a pin, without and with it, as of coming out."""
        until = _until(evidence, mono_ns(truth.comes_out_s))
        row = int(np.searchsorted(truth.t_s, (truth.goes_in_s + truth.comes_out_s) / 2.0))
        north_m, east_m = truth.place_m[row, :2] + rng.normal(0.0, PIN_STD_M, 2)
        t_ns = mono_ns(float(truth.t_s[row]))
        pin = PlaceSeen("pin", t_ns, float(north_m), float(east_m), PIN_STD_M)
        around = np.abs(truth.t_s - truth.t_s[row]) < AROUND_S
        means = []
        for places in ((), (pin,)):
            solved = self._smoother.solve({"0": replace(until, places=places)})
            errors, _ = _against(truth, solved.paths["0"])
            means.append(float(errors[around].mean()))
        return means[0], means[1]


def tables_of(report: SmoothingReport) -> list[Table]:
    errors = Table(title="Afterwards: mean / CE95 in metres")
    for heading in ("", "stage", "as shown", report.smoother, "part of it", "region holds"):
        errors.add_column(heading, justify="left" if heading in {"", "stage"} else "right")
    for way, stages in report.live_mean_m.items():
        for stage, live_m in stages.items():
            smoothed_m = report.smoothed_mean_m[way][stage]
            errors.add_row(
                way,
                stage,
                f"{live_m:.2f} / {report.live_ce95_m[way][stage]:.2f}",
                f"{smoothed_m:.2f} / {report.smoothed_ce95_m[way][stage]:.2f}",
                f"{smoothed_m / live_m:.2f}",
                f"{report.held_95[way][stage]:.1%}",
            )
    for stage, (live_m, then_m) in report.bound_mean_m.items():
        cells = f"{live_m:.2f}", f"{then_m:.2f}", f"{then_m / live_m:.2f}"
        errors.add_row("best by path and fixes", stage, *cells, "")
    errors.add_row("to reach", "", "", "", "0.50", "92 to 98 %")
    figures = Table(title="Pins and times")
    for heading in ("", "measured", "to reach"):
        figures.add_column(heading, justify="left" if not heading else "right")
    for way, before_m in report.pin_before_m.items():
        after_m = report.pin_after_m[way]
        figures.add_row(
            f"trail around a pin, without and with it, {way}",
            f"{before_m:.2f} m, {after_m:.2f} m ({after_m / before_m:.2f})",
            "0.50",
        )
    figures.add_row(f"smoothing {UNITS} units of an hour", f"{report.hour_s:.2f} s", "5 s")
    figures.add_row("one pin, an hour's path solved again", f"{report.pin_solve_s:.2f} s", "0.5 s")
    return [errors, figures]


def _times(smoother: Smoother, seed: int) -> tuple[float, float]:
    """CPU seconds of ten units' hour, and of one pin in one of them."""
    evidence: dict[str, UnitEvidence] = {}
    for number in progress_bar(
        range(UNITS), description="An hour", console=Console(stderr=True), transient=True
    ):
        evidence[str(number)] = UnitEvidence(_hour(seed + number).arrays(), None)
    begin_s = time.thread_time()
    smoother.smooth(evidence)
    hour_s = time.thread_time() - begin_s
    path = evidence["0"].path
    row = len(path) // 2
    place = path.own_m[row]
    pin = PlaceSeen("pin", int(path.t_ns[row]), float(place[0]), float(place[1]), 5.0)
    begin_s = time.thread_time()
    smoother.solve({"0": replace(evidence["0"], places=(pin,))})
    return hour_s, time.thread_time() - begin_s


def _hour(seed: int) -> PathHistory:
    rng = np.random.default_rng(seed)
    walk, receiver, history = Walk.wander(rng, HOUR_S), Receiver(rng), PathHistory()
    for row in range(len(walk)):
        position = walk.position(row)
        t_ns, t_s = position.header.t_mono_ns, float(walk.t_s[row])
        history.note(position, t_ns, jumped=False)
        if row % WALK_RATE_HZ == 0 and t_s < OUTSIDE_S:
            history.fix(receiver.fix(t_s, walk.truth_m[row]), t_ns)
    return history


def _until(evidence: UnitEvidence, t_ns: int) -> UnitEvidence:
    """What was known until then."""
    path = evidence.path
    rows, fixes = path.t_ns <= t_ns, path.fix_t_ns <= t_ns
    columns: Mapping[str, Any] = {
        name: getattr(path, name)[fixes if name.startswith("fix_") else rows]
        for name in path.__dataclass_fields__
    }
    return replace(evidence, path=PathArrays(**columns))


def _against(truth: Truth, path: SmoothedPath) -> tuple[Floats, NDArray[np.bool_]]:
    """Horizontal errors (n,), and where the stated 95 % region held the truth."""
    t_ns = np.array([mono_ns(float(t_s)) for t_s in truth.t_s])
    north, east, std_north, std_east, correlation = (
        np.interp(t_ns, path.t_ns, column)
        for column in (
            path.north_m,
            path.east_m,
            path.std_north_m,
            path.std_east_m,
            path.correlation_ne,
        )
    )
    off_north = (north - truth.place_m[:, 0]) / std_north
    off_east = (east - truth.place_m[:, 1]) / std_east
    cross = 2.0 * correlation * off_north * off_east
    distance2 = (off_north**2 + off_east**2 - cross) / (1.0 - correlation**2)
    errors = np.hypot(north - truth.place_m[:, 0], east - truth.place_m[:, 1])
    return errors, distance2 < CHI2_95_2DOF


def _stages(truth: Truth) -> dict[str, NDArray[np.bool_]]:
    inside = (truth.t_s > truth.goes_in_s) & (truth.t_s < truth.comes_out_s)
    return {"inside": inside, "outside": ~inside}


def _means(pairs: list[tuple[Floats, Floats]]) -> tuple[float, float]:
    live, afterwards = (float(np.concatenate(column).mean()) for column in zip(*pairs, strict=True))
    return live, afterwards


def _ce95_m(errors: list[Floats]) -> float:
    return float(np.percentile(np.concatenate(errors), 95.0))
