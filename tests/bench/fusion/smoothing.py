"""Accuracy of smoothed trails beside what was shown at the time, and the gain of one pin.

The incidents are those of ``muster bench fusion``; the trails of all six people are smoothed
together.  Errors are told as they are, and *relative* (ISO/IEC 18305): less the one shift that is
everybody's for the whole incident, which only a survey could tell.  A pin is set in the middle of
the ten minutes inside, once with all that came until coming out and nothing later: half a metre
off, or of a place that was surveyed.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray
from rich.table import Table

from base_station.fusion.odometry.points import PathArrays
from base_station.fusion.smoothing.interface import (
    PositionConstraint,
    SmoothedPath,
    Smoother,
    UnitEvidence,
)
from tests.bench.fusion.kept_paths import ENGINE
from tests.bench.fusion.smoothing_time import UNITS, times_s
from tests.rig.incident.people import Truth
from tests.rig.incident.run import Person, Run
from tests.rig.incident.scores import CHI2_95_2DOF
from tests.rig.message_factory import mono_ns

Floats = NDArray[np.float64]

PIN_STD_M = {"a pin": 0.5, "a pin at a surveyed place": 0.3}  # each axis
AROUND_S = 120.0  # of a pin: the trail that it should better


@dataclass(frozen=True, slots=True)
class SmoothingReport:
    """Horizontal errors in metres, live and smoothed, by way of knowing and stage."""

    smoother: str
    live_mean_m: dict[str, dict[str, float]]
    smoothed_mean_m: dict[str, dict[str, float]]
    live_ce95_m: dict[str, dict[str, float]]
    smoothed_ce95_m: dict[str, dict[str, float]]
    live_relative_m: dict[str, dict[str, float]]  # means
    smoothed_relative_m: dict[str, dict[str, float]]
    bound_mean_m: dict[str, tuple[float, float]]  # best by path and fixes: live, afterwards
    held_95: dict[str, dict[str, float]]  # the smoothed trail's stated region held the truth
    pin_before_m: dict[str, float]  # mean error of the trail around a pin, without it
    pin_after_m: dict[str, dict[str, float]]  # and with it, by way and kind of pin
    times_s: dict[str, float]  # CPU time of smoothing ten units' hour, and of solving with a pin


@dataclass
class _Errors:
    live: list[Floats] = field(default_factory=list)
    smoothed: list[Floats] = field(default_factory=list)
    live_relative: list[Floats] = field(default_factory=list)
    smoothed_relative: list[Floats] = field(default_factory=list)
    held: list[NDArray[np.bool_]] = field(default_factory=list)

    def add(self, other: _Errors) -> None:
        self.live += other.live
        self.smoothed += other.smoothed
        self.live_relative += other.live_relative
        self.smoothed_relative += other.smoothed_relative
        self.held += other.held


class SmoothingScores:
    """Collects incidents: what was shown of each person, and the paths behind it."""

    def __init__(self, smoother: Smoother) -> None:
        self._smoother = smoother
        self._errors: dict[str, dict[str, _Errors]] = {}
        self._pins: dict[str, list[list[float]]] = {}
        self._walled: Mapping[str, UnitEvidence] = {}
        self._bound: dict[str, list[tuple[Floats, Floats]]] = {}

    def note_bound(self, truth: Truth, live_m: Floats, afterwards_m: Floats) -> None:
        """Errors (n, 2) of whoever makes the best of one person's path and fixes."""
        for stage, rows in _stages(truth).items():
            live, afterwards = (np.hypot(*one[rows].T) for one in (live_m, afterwards_m))
            self._bound.setdefault(stage, []).append((live, afterwards))

    def note(
        self,
        way: str,
        people: Sequence[Person],
        runs: Sequence[Run],
        evidence: Mapping[str, UnitEvidence],
        rng: np.random.Generator,
    ) -> None:
        """One incident; ``evidence`` by a person's number, and the engine's if heard."""
        paths = self._smoother.smooth(evidence).paths
        if evidence["0"].grid is not None or not self._walled:
            self._walled = {one: kept for one, kept in evidence.items() if one != ENGINE}
        truths = [person.truth for person in people]
        against = [_against(truth, paths[str(number)]) for number, truth in enumerate(truths)]
        live = [
            run.places_m - truth.place_m[:, :2] for truth, run in zip(truths, runs, strict=True)
        ]
        shared_live_m, shared_m = (
            np.mean(np.concatenate(errors), axis=0)
            for errors in (live, [errors for errors, _ in against])
        )
        for number, truth in enumerate(truths):
            errors, held = against[number]
            for stage, rows in _stages(truth).items():
                one = self._errors.setdefault(way, {}).setdefault(stage, _Errors())
                one.live.append(np.hypot(*live[number][rows].T))
                one.smoothed.append(np.hypot(*errors[rows].T))
                one.live_relative.append(np.hypot(*(live[number][rows] - shared_live_m).T))
                one.smoothed_relative.append(np.hypot(*(errors[rows] - shared_m).T))
                one.held.append(held[rows])
            self._pins.setdefault(way, []).append(self._pinned_m(truth, evidence, str(number), rng))

    def add(self, other: SmoothingScores) -> None:
        """Other incidents, behind one's own."""
        for way, stages in other._errors.items():
            for stage, errors in stages.items():
                self._errors.setdefault(way, {}).setdefault(stage, _Errors()).add(errors)
        for way, pins in other._pins.items():
            self._pins.setdefault(way, []).extend(pins)
        for stage, pairs in other._bound.items():
            self._bound.setdefault(stage, []).extend(pairs)
        self._walled = other._walled or self._walled

    def report(self, seed: int) -> SmoothingReport:
        pins = {way: np.array(gains) for way, gains in self._pins.items()}
        return SmoothingReport(
            smoother=self._smoother.name,
            live_mean_m=self._each(lambda one: float(np.concatenate(one.live).mean())),
            smoothed_mean_m=self._each(lambda one: float(np.concatenate(one.smoothed).mean())),
            live_ce95_m=self._each(lambda one: _ce95_m(one.live)),
            smoothed_ce95_m=self._each(lambda one: _ce95_m(one.smoothed)),
            live_relative_m=self._each(lambda one: float(np.concatenate(one.live_relative).mean())),
            smoothed_relative_m=self._each(
                lambda one: float(np.concatenate(one.smoothed_relative).mean())
            ),
            bound_mean_m={stage: _means(pairs) for stage, pairs in self._bound.items()},
            held_95=self._each(lambda one: float(np.concatenate(one.held).mean())),
            pin_before_m={way: float(gains[:, 0].mean()) for way, gains in pins.items()},
            pin_after_m={
                way: dict(zip(PIN_STD_M, gains[:, 1:].mean(axis=0).tolist(), strict=True))
                for way, gains in pins.items()
            },
            times_s=times_s(self._smoother, seed, self._walled),
        )

    def _each(self, figure: Any) -> dict[str, dict[str, float]]:
        return {
            way: {stage: figure(one) for stage, one in stages.items()}
            for way, stages in self._errors.items()
        }

    def _pinned_m(
        self,
        truth: Truth,
        evidence: Mapping[str, UnitEvidence],
        unit_id: str,
        rng: np.random.Generator,
    ) -> list[float]:
        """Mean error of the trail around a pin, without and with each kind, as of coming out."""
        out_ns = mono_ns(truth.comes_out_s)
        until = {one: _until(evidence[one], out_ns) for one in (unit_id, ENGINE) if one in evidence}
        row = int(np.searchsorted(truth.t_s, (truth.goes_in_s + truth.comes_out_s) / 2.0))
        off, t_ns = rng.normal(0.0, 1.0, 2), mono_ns(float(truth.t_s[row]))
        pins: list[tuple[PositionConstraint, ...]] = [()]
        for std_m in PIN_STD_M.values():
            north_m, east_m = (truth.place_m[row, :2] + std_m * off).tolist()
            pins.append((PositionConstraint("pin", t_ns, north_m, east_m, std_m),))
        around = np.abs(truth.t_s - truth.t_s[row]) < AROUND_S
        means = []
        for places in pins:
            known = until | {unit_id: replace(until[unit_id], places=places)}
            errors, _ = _against(truth, self._smoother.solve(known).paths[unit_id])
            means.append(float(np.hypot(*errors[around].T).mean()))
        return means


def tables_of(report: SmoothingReport) -> list[Table]:
    errors = Table(title="Afterwards: mean / CE95 in metres")
    headings = ("", "stage", "as shown", report.smoother, "part of it", "relative", "region holds")
    for heading in headings:
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
                _relative(report, way, stage),
                f"{report.held_95[way][stage]:.1%}",
            )
    for stage, (live_m, then_m) in report.bound_mean_m.items():
        cells = f"{live_m:.2f}", f"{then_m:.2f}", f"{then_m / live_m:.2f}"
        errors.add_row("best by path and fixes", stage, *cells, "", "")
    errors.add_row("to reach", "", "", "", "0.50", "", "92 to 98 %")
    figures = Table(title="Pins and times")
    for heading in ("", "measured", "to reach"):
        figures.add_column(heading, justify="left" if not heading else "right")
    for way, before_m in report.pin_before_m.items():
        for kind, after_m in report.pin_after_m[way].items():
            figures.add_row(
                f"trail around {kind}, without and with it, {way}",
                f"{before_m:.2f} m, {after_m:.2f} m ({after_m / before_m:.2f})",
                "0.50",
            )
    for what, took_s, least in (
        (f"smoothing {UNITS} units of an hour", "hour", "5 s"),
        (f"smoothing {UNITS} units of an hour among walls", "hour among walls", "5 s"),
        ("one pin, an hour's path solved again", "pin", "0.5 s"),
    ):
        figures.add_row(what, f"{report.times_s[took_s]:.2f} s", least)
    return [errors, figures]


def _relative(report: SmoothingReport, way: str, stage: str) -> str:
    live_m, smoothed_m = report.live_relative_m[way][stage], report.smoothed_relative_m[way][stage]
    return f"{live_m:.2f} to {smoothed_m:.2f}"


def _until(evidence: UnitEvidence, t_ns: int) -> UnitEvidence:
    """Evidence until then."""
    path = evidence.path
    rows, fixes = path.t_ns <= t_ns, path.fix_t_ns <= t_ns
    columns: Mapping[str, Any] = {
        name: getattr(path, name)[fixes if name.startswith("fix_") else rows]
        for name in path.__dataclass_fields__
    }
    return replace(evidence, path=PathArrays(**columns))


def _against(truth: Truth, path: SmoothedPath) -> tuple[Floats, NDArray[np.bool_]]:
    """Horizontal errors (n, 2), and where the stated 95 % region held the truth."""
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
    errors = np.column_stack([north, east]) - truth.place_m[:, :2]
    off_north, off_east = errors[:, 0] / std_north, errors[:, 1] / std_east
    cross = 2.0 * correlation * off_north * off_east
    distance2 = (off_north**2 + off_east**2 - cross) / (1.0 - correlation**2)
    return errors, distance2 < CHI2_95_2DOF


def _stages(truth: Truth) -> dict[str, NDArray[np.bool_]]:
    inside = (truth.t_s > truth.goes_in_s) & (truth.t_s < truth.comes_out_s)
    return {"inside": inside, "outside": ~inside}


def _means(pairs: list[tuple[Floats, Floats]]) -> tuple[float, float]:
    live, afterwards = (float(np.concatenate(column).mean()) for column in zip(*pairs, strict=True))
    return live, afterwards


def _ce95_m(errors: list[Floats]) -> float:
    return float(np.percentile(np.concatenate(errors), 95.0))
