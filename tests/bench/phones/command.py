"""``muster bench phones``: telephones in the hand on floors with plans, from sensor to station.

Every walk is tracked by ``body``, published as a unit does and fused at the station, once without
and once with the plan of its floor.  Errors are those at surveyed waypoints.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Annotated

import numpy as np
import typer
from rich import box
from rich.console import Console
from rich.table import Table

from shared.bench_figures import FiguresFile, write_figures
from shared.errors import UserError
from tests.bench.phones.walks import AFTERWARDS, LIVE, WaypointErrors, fuse_walk, publish_walk
from tests.rig.incident.scores import CHI2_95_2DOF
from tests.rig.parallel_work import side_by_side

WITHOUT, WITH_PLAN = "no plan", "plan"
WAYS = tuple(f"{known}, {when}" for known in (WITHOUT, WITH_PLAN) for when in (LIVE, AFTERWARDS))
_TARGET_M = 1.5  # median with the plan
_ALL = "all"

Errors = dict[str, WaypointErrors]  # of one walk, by way


@dataclass(frozen=True, slots=True)
class PhoneFigures:
    """Figures of one floor, or of all, and one way of knowing."""

    floor: str
    way: str
    walks: int
    median_m: float
    p95_m: float
    held_95: float  # part of the waypoints in the stated 95 % region
    stated_by_error: float  # root mean squares: 1 where the stated deviation is the error's


def bench_phones(
    data: Annotated[Path, typer.Argument(help="The folder with phones/FLOOR/TRIAL.")],
    tracker: Annotated[str, typer.Option(help="Tracker of the units.")] = "body",
    json_file: FiguresFile = None,
) -> None:
    """Measure the error of telephones in the hand at surveyed waypoints, without and with the plan
    of the floor, live and smoothed.
    """
    figures = measure(data, tracker)
    Console().print(_table(figures))
    write_figures(json_file, figures)


def measure(data: Path, tracker: str) -> list[PhoneFigures]:
    trials = sorted(path.parent for path in data.glob("phones/*/*/imu.csv.gz"))
    if not trials:
        raise UserError(f"no phones/FLOOR/TRIAL below {data}; give the folder of phones")
    by_trial = list(side_by_side(partial(errors_of, tracker=tracker), trials, "Walks"))
    floors = [trial.parent.name for trial in trials]
    figures = []
    for floor in (*sorted(set(floors)), _ALL):
        walks = [one for one, of in zip(by_trial, floors, strict=True) if floor in (of, _ALL)]
        figures += [_figures(floor, way, [walk[way] for walk in walks]) for way in WAYS]
    return figures


def errors_of(trial: Path, tracker: str) -> Errors:
    """Return the errors of one walk by every way."""
    walk = publish_walk(trial, tracker)
    return {
        f"{known}, {when}": errors
        for known, floor in ((WITHOUT, None), (WITH_PLAN, trial.parent))
        for when, errors in fuse_walk(walk, floor).items()
    }


def _figures(floor: str, way: str, walks: list[WaypointErrors]) -> PhoneFigures:
    error_m = np.concatenate([one.error_m for one in walks])
    squares = np.concatenate([one.normalised2 for one in walks])
    stated_m = np.concatenate([one.stated_m for one in walks])
    return PhoneFigures(
        floor=floor,
        way=way,
        walks=len(walks),
        median_m=float(np.median(error_m)),
        p95_m=float(np.percentile(error_m, 95.0)),
        held_95=float(np.mean(squares <= CHI2_95_2DOF)),
        stated_by_error=float(np.sqrt(np.mean(stated_m**2) / np.mean(error_m**2))),
    )


def _table(figures: list[PhoneFigures]) -> Table:
    title = f"{figures[-1].walks} telephones in the hand, errors at waypoints"
    table = Table(title=title, box=box.SIMPLE_HEAD)
    for title in ("floor", "fused", "median, m", "95 %, m", "in 95 %", "stated/error"):
        table.add_column(title, justify="left" if title in ("floor", "fused") else "right")
    for one in figures:
        table.add_row(
            one.floor,
            one.way,
            f"{one.median_m:.1f}",
            f"{one.p95_m:.1f}",
            f"{100.0 * one.held_95:.0f} %",
            f"{one.stated_by_error:.1f}",
            end_section=one.way == WAYS[-1],
        )
    target = f"{_TARGET_M:.1f}"
    table.add_row("to reach", f"{WITH_PLAN}, {LIVE}", target, "", "92-98 %", "at most 2")
    return table
