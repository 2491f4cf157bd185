"""``muster bench fusion``: how well the station knows where people are, beside simpler ways.

Simulated incidents, each with another seed: three minutes outside with satellite fixes, ten
minutes inside without any, two minutes outside again.  Nobody tells where a unit starts or which
way it looks.  The peers are given a heading that is right to some five degrees.
"""

from __future__ import annotations

import json
import math
import time
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Annotated

import numpy as np
import typer
from numpy.typing import NDArray
from rich.console import Console
from rich.progress import track as progress_bar
from rich.table import Table

from base_station.bench.fusion_walks import RATE_HZ, Receiver, Scores, Walk
from base_station.fusion import FUSERS
from base_station.fusion.port import FuserKind

Floats = NDArray[np.float64]

OUTSIDE_S, INSIDE_S, AGAIN_S = 180.0, 600.0, 120.0
CHI2_95_2DOF = 5.991
SOLVED_RAD = 0.2
PEER_HEADING_STD_RAD = math.radians(5.0)
LAST_MINUTE_S = 60.0


@dataclass
class Errors:
    """Horizontal errors in metres by stage."""

    outside: list[float] = field(default_factory=list)
    inside: list[float] = field(default_factory=list)  # in the last of the ten minutes
    again: list[float] = field(default_factory=list)  # in the last minute

    def note(self, errors_m: Floats) -> None:
        out, into = round(OUTSIDE_S * RATE_HZ), round((OUTSIDE_S + INSIDE_S) * RATE_HZ)
        minute = round(LAST_MINUTE_S * RATE_HZ)
        self.outside += errors_m[minute:out].tolist()
        self.inside += errors_m[into - minute : into].tolist()
        self.again += errors_m[-minute:].tolist()


@dataclass(frozen=True, slots=True)
class FusionReport:
    """One run; circular errors by ISO/IEC 18305 in metres, by way of knowing and stage."""

    fuser: str
    incidents: int
    ce50_m: dict[str, dict[str, float]]
    ce95_m: dict[str, dict[str, float]]
    held_95: dict[str, float]  # part of the time in which the stated region held the truth
    heading_walked_m: dict[str, float]  # walked with fixes until the heading is solved
    step_us: dict[str, float]  # of a position, and of one with a fix


def bench_fusion(
    incidents: Annotated[int, typer.Option(min=1, help="Simulated people.")] = 100,
    seed: Annotated[int, typer.Option(help="Of the first one.")] = 1,
    json_file: Annotated[
        Path | None, typer.Option("--json", help="Also write the figures to this file.")
    ] = None,
) -> None:
    """Error and honesty of the fused position over simulated incidents, beside satellite fixes
    alone, the unit's own path alone, and switching between them.
    """
    report = measure(FUSERS[0], incidents, seed)
    Console().print(_errors_table(report))
    Console().print(_figures_table(report))
    if json_file is not None:
        json_file.write_text(json.dumps(asdict(report), indent=2) + "\n", encoding="utf-8")


def measure(kind: FuserKind, incidents: int, seed: int) -> FusionReport:
    ways = {name: Errors() for name in ("fused", "fixes alone", "path alone", "switching")}
    normalised2, walked_m, steps_ns, fixes_ns = [], [], [], []
    for number in progress_bar(
        range(incidents), description="Walking", console=Console(stderr=True), transient=True
    ):
        rng = np.random.default_rng(seed + number)
        walk = Walk.wander(rng, OUTSIDE_S + INSIDE_S + AGAIN_S)
        run = _run(kind, walk, Receiver(rng))
        ways["fused"].note(np.array(run.scores.error_m))
        normalised2.append(run.scores.normalised2)
        walked_m.append(run.heading_walked_m)
        steps_ns += run.steps_ns
        fixes_ns += run.fixes_ns
        for name, places_m in _peers(walk, run.fixes_m, rng).items():
            ways[name].note(np.linalg.norm(places_m - walk.truth_m, axis=1))
    held = np.array(normalised2) < CHI2_95_2DOF
    out, into = round(OUTSIDE_S * RATE_HZ), round((OUTSIDE_S + INSIDE_S) * RATE_HZ)
    return FusionReport(
        fuser=kind.name,
        incidents=incidents,
        ce50_m={name: _percentiles(errors, 50.0) for name, errors in ways.items()},
        ce95_m={name: _percentiles(errors, 95.0) for name, errors in ways.items()},
        held_95={
            "outside": float(held[:, RATE_HZ:out].mean()),
            "inside": float(held[:, out:into].mean()),
            "outside again": float(held[:, into:].mean()),
        },
        heading_walked_m={
            "median": float(np.median(walked_m)),
            "worst": float(np.max(walked_m)),
        },
        step_us={
            "position": float(np.median(steps_ns)) / 1e3,
            "position and fix": float(np.median(fixes_ns)) / 1e3,
        },
    )


@dataclass
class _Run:
    """One walk through the fuser."""

    scores: Scores = field(default_factory=Scores)
    heading_walked_m: float = math.inf
    fixes_m: dict[int, tuple[float, float]] = field(default_factory=dict)  # by row of the walk
    steps_ns: list[int] = field(default_factory=list)
    fixes_ns: list[int] = field(default_factory=list)


def _run(kind: FuserKind, walk: Walk, receiver: Receiver) -> _Run:
    run, fuser = _Run(), kind.new()
    for index in range(len(walk)):
        t_s = float(walk.t_s[index])
        position = walk.position(index)
        is_fix = index % RATE_HZ == 0 and not OUTSIDE_S <= t_s < OUTSIDE_S + INSIDE_S
        fix = receiver.fix(t_s, walk.truth_m[index]) if is_fix else None
        began_ns = time.perf_counter_ns()
        fuser.advance(position)
        if fix is not None:
            fuser.correct(fix)
        estimate = fuser.estimate()
        took_ns = time.perf_counter_ns() - began_ns
        assert estimate is not None
        if fix is not None:
            run.fixes_m[index] = (fix.north_m, fix.east_m)
        (run.steps_ns if fix is None else run.fixes_ns).append(took_ns)
        if math.isinf(run.heading_walked_m) and estimate.heading_std_rad < SOLVED_RAD:
            run.heading_walked_m = float(walk.distance_m[index])
        run.scores.note(fuser, walk.truth_m[index])
    return run


def _peers(
    walk: Walk, fixes_m: dict[int, tuple[float, float]], rng: np.random.Generator
) -> dict[str, Floats]:
    """Where simpler ways put the wearer, row by row."""
    turn_rad = walk.turn_rad + rng.normal(0.0, PEER_HEADING_STD_RAD)
    cosine, sine = math.cos(turn_rad), math.sin(turn_rad)
    path_m = walk.own_m @ np.array([[cosine, sine], [-sine, cosine]])
    alone = np.zeros_like(path_m)
    switching = np.zeros_like(path_m)
    last, last_path_m = np.array(fixes_m[0]), path_m[0]
    for index in range(len(walk)):
        if index in fixes_m:
            last, last_path_m = np.array(fixes_m[index]), path_m[index]
        alone[index] = last
        switching[index] = last + path_m[index] - last_path_m
    begin = walk.truth_m[0] - path_m[0]
    return {"fixes alone": alone, "path alone": path_m + begin, "switching": switching}


def _percentiles(errors: Errors, percent: float) -> dict[str, float]:
    return {
        "outside": float(np.percentile(errors.outside, percent)),
        "inside": float(np.percentile(errors.inside, percent)),
        "outside again": float(np.percentile(errors.again, percent)),
    }


def _errors_table(report: FusionReport) -> Table:
    table = Table(title=f"{report.incidents} simulated people: CE50 / CE95 in metres")
    table.add_column("")
    stages = ("outside", "inside", "outside again")
    for heading in ("outside, with fixes", "after 10 min without", "outside again"):
        table.add_column(heading, justify="right")
    for name, ce50_m in report.ce50_m.items():
        cells = [f"{ce50_m[stage]:.1f} / {report.ce95_m[name][stage]:.1f}" for stage in stages]
        table.add_row(report.fuser if name == "fused" else name, *cells)
    return table


def _figures_table(report: FusionReport) -> Table:
    table = Table(title="What is said of it")
    for heading, justify in (("", "left"), ("measured", "right"), ("to reach", "right")):
        table.add_column(heading, justify="right" if justify == "right" else "left")
    for stage, part in report.held_95.items():
        table.add_row(f"95 % region holds the truth, {stage}", f"{part:.1%}", "92 to 98 %")
    for which, walked_m in report.heading_walked_m.items():
        table.add_row(f"heading solved after a walk of, {which}", f"{walked_m:.1f} m", "25 m")
    for what, step_us in report.step_us.items():
        table.add_row(f"step, {what}, median", f"{step_us:.0f} us", "250 us")
    return table
