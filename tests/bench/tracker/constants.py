"""``muster bench constants``: constants of the foot's tracker, and those without effect.

Each constant of ``EskfConfig`` is halved and doubled by itself, over recordings, simulated walks
and walks of worse sensors.  A constant that changes no row of any of them, to the last bit, has
never been put to the test: its value is a guess, however well the tracker does.  One that only
simulated walks touch is as good as the simulator.  Of all others the table shows how far they move
the error and what is stated of it.  Of each kind of walks no more are tracked, in a fixed random
order, once a constant has changed six of them: those that are always at work need no more, and
those that seldom are get all.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Annotated

import numpy as np
import typer
from rich import box
from rich.console import Console
from rich.progress import track as progress_bar
from rich.table import Table

from edge.tracker.foot.config import EskfConfig
from edge.tracker.foot.eskf import EskfTracker
from edge.tracker.interface import TrackBatch
from edge.tracker.track_rows import join_rows
from shared.bench_figures import FiguresFile, write_figures
from tests.bench.tracker.constant_walks import RECORDED, Walk, all_walks, score_walk
from tests.bench.tracker.scoring import Score

FACTORS = (0.5, 2.0)
# Shares that lie near 1: what they lack to it is halved and doubled.
NEAR_ONE = {"consistency.memory", "revision.memory", "output.saturation_ratio"}
ENOUGH = 6  # walks of a kind that a constant has changed
LEAST_ERROR_M = 0.01  # smaller is luck
_COLUMNS = ("position_n_m", "position_cov_m2", "heading_std_rad", "quality", "stationary")
WIDTH = 130  # that the table needs


@dataclass(frozen=True, slots=True)
class Tracked:
    """One walk by one configuration."""

    rows: TrackBatch
    score: Score
    error_m: float


@dataclass(frozen=True, slots=True)
class Decision:
    """Influence of a constant: the larger one of the effects of its halving and its doubling."""

    constant: str
    value: float
    walks: Mapping[str, int]  # by kind: on how many walks any row changes
    looked_at: Mapping[str, int]  # ... of how many
    rows: float  # share that change by a millimetre or a hundredth of the deviation
    error_ratio: float  # geometric mean over the walks that change; the farther from 1
    worst_ratio: float  # of one walk; the farther from 1
    stated_ratio: float  # of the deviation at the end, as error_ratio
    silent: int  # walks with a silently wrong row that the default has not

    @property
    def decides(self) -> bool:
        return any(self.walks.values())


def bench_constants(
    data: Annotated[
        Path, typer.Argument(help="Folder with walks, hard and body/ipol, such as shared/data.")
    ],
    json_file: FiguresFile = None,
    only: Annotated[
        str, typer.Option(help="Only constants whose name begins so, such as 'floor.'.")
    ] = "",
) -> None:
    """Measure the effect of every constant of the foot's tracker: each is halved and doubled."""
    console = Console(width=max(Console().width, WIDTH))
    walks = all_walks(data)
    decisions = measure_constants(walks, [name for name in constants() if name.startswith(only)])
    console.print(constants_table(decisions))
    for line in never_lines(decisions):
        console.print(line)
    write_figures(json_file, {"constants": [asdict(one) for one in decisions]})


def constants() -> dict[str, float]:
    """Return every constant by its name, ``part.parameter``."""
    named: dict[str, float] = {}
    default = EskfConfig()
    for part in EskfConfig._fields:
        value = getattr(default, part)
        if isinstance(value, tuple):
            names: tuple[str, ...] = type(value)._fields  # type: ignore[attr-defined]  # NamedTuple
            named |= {f"{part}.{name}": getattr(value, name) for name in names}
        else:
            named[part] = value
    return named


def changed(constant: str, factor: float, default: EskfConfig | None = None) -> EskfConfig:
    """Return ``default``, or that of the tracker, with one constant times ``factor``."""
    default = default or EskfConfig()
    part, _, name = constant.partition(".")
    if not name:
        return default._replace(**{part: factor * getattr(default, part)})
    whole = getattr(default, part)
    value = getattr(whole, name)
    other = 1.0 - factor * (1.0 - value) if constant in NEAR_ONE else factor * value
    return default._replace(**{part: whole._replace(**{name: type(value)(other)})})


def measure_constants(walks: Sequence[Walk], names: Sequence[str]) -> list[Decision]:
    """Return what each constant decides on ``walks``, those that decide least first."""
    before = [_track(walk, EskfConfig()) for walk in walks]
    bar = progress_bar(names, description="Varying", console=Console(stderr=True), transient=True)
    decisions = [_decision(name, walks, before) for name in bar]
    return sorted(decisions, key=lambda one: (_share(one), one.constant))


def _share(decision: Decision) -> float:
    shares = [decision.walks[kind] / count for kind, count in decision.looked_at.items()]
    return sum(shares)


def _track(walk: Walk, config: EskfConfig, like: Tracked | None = None) -> Tracked:
    tracker = EskfTracker(walk.description, config)
    rows = join_rows([tracker.push(walk.imu), tracker.finish()])
    if like is not None and not _differ(rows, like.rows):
        return like
    score = score_walk(walk, rows)
    error_m = score.closure_horizontal_m if score.ate_m is None else score.ate_m
    return Tracked(rows, score, error_m)


def _differ(rows: TrackBatch, others: TrackBatch) -> bool:
    return any(
        not np.array_equal(getattr(rows, name), getattr(others, name), equal_nan=True)
        for name in _COLUMNS
    )


def _decision(constant: str, walks: Sequence[Walk], before: Sequence[Tracked]) -> Decision:
    touched = dict.fromkeys((walk.kind for walk in walks), 0)
    looked_at = dict(touched)
    moved = total = silent = 0
    errors: dict[float, list[float]] = {factor: [] for factor in FACTORS}
    stated: dict[float, list[float]] = {factor: [] for factor in FACTORS}
    for number in np.random.default_rng(0).permutation(len(walks)):
        walk, default = walks[number], before[number]
        if touched[walk.kind] >= ENOUGH:
            continue
        differs = False
        for factor in FACTORS:
            other = _track(walk, changed(constant, factor), default)
            total += len(default.rows)
            if other is default:
                continue
            differs = True
            moved += _moved_rows(other.rows, default.rows)
            errors[factor].append(_log_ratio(other.error_m, default.error_m, LEAST_ERROR_M))
            stated[factor].append(_log_ratio(_end_std_m(other.rows), _end_std_m(default.rows)))
            silent += bool(other.score.silently_wrong) and not default.score.silently_wrong
        looked_at[walk.kind] += 1
        touched[walk.kind] += differs
    return Decision(
        constant=constant,
        value=constants()[constant],
        walks=touched,
        looked_at=looked_at,
        rows=moved / max(total, 1),
        error_ratio=math.exp(_farthest(_mean(logs) for logs in errors.values())),
        worst_ratio=math.exp(_farthest(log for logs in errors.values() for log in logs)),
        stated_ratio=math.exp(_farthest(_mean(logs) for logs in stated.values())),
        silent=silent,
    )


def _moved_rows(rows: TrackBatch, others: TrackBatch) -> int:
    """Return how many rows are elsewhere, or stated otherwise, by more than nobody would see."""
    moved_m = np.linalg.norm(rows.position_n_m - others.position_n_m, axis=1)
    std_m, other_std_m = (
        np.sqrt(np.trace(one.position_cov_m2, axis1=1, axis2=2)) for one in (rows, others)
    )
    seen = (moved_m > 1e-3) | (np.abs(std_m - other_std_m) > 0.01 * other_std_m)
    return int(np.count_nonzero(seen | (rows.quality != others.quality)))


def _end_std_m(rows: TrackBatch) -> float:
    return float(np.sqrt(np.trace(rows.position_cov_m2[-1, :2, :2])))


def _log_ratio(value: float, other: float, least: float = 0.0) -> float:
    return math.log(max(value, least) / max(other, least))


def _mean(logs: Sequence[float]) -> float:
    return float(np.mean(logs)) if logs else 0.0


def _farthest(logs: Iterator[float]) -> float:
    return max(logs, key=abs, default=0.0)


def constants_table(decisions: Sequence[Decision]) -> Table:
    """Return a row for each constant, those that decide least first."""
    table = Table(
        title="Constants halved and doubled: walks that change, and how far",
        caption="how many walks of each kind change, of those tracked; rows: share that move by "
        "1 mm, or are stated otherwise by 1 %; error and stated: mean ratio on the walks that "
        "change; worst: error of one; silent: walks that become silently wrong",
        box=box.SIMPLE_HEAD,
    )
    table.add_column("constant", no_wrap=True)
    table.add_column("value", justify="right")
    kinds = list(decisions[0].walks) if decisions else []
    for kind in kinds:
        table.add_column(kind, justify="right", no_wrap=True)
    for title in ("rows, %", "error x", "worst x", "stated x", "silent"):
        table.add_column(title, justify="right")
    for one in decisions:
        figures = (f"{one.error_ratio:.2f}", f"{one.worst_ratio:.2f}", f"{one.stated_ratio:.2f}")
        table.add_row(
            one.constant,
            f"{one.value:g}",
            *(f"{one.walks[kind]}/{one.looked_at[kind]}" for kind in kinds),
            f"{100.0 * one.rows:.1f}",
            *(figures if one.decides else ("", "", "")),
            str(one.silent or ""),
        )
    return table


def never_lines(decisions: Sequence[Decision]) -> Iterator[str]:
    """Say which constants nothing has put to the test, and which only simulated or worse walks."""
    never = [one.constant for one in decisions if not one.decides]
    unrecorded = [one.constant for one in decisions if one.decides and not one.walks.get(RECORDED)]
    yield f"never decide ({len(never)} of {len(decisions)}): {', '.join(never) or 'none'}"
    yield f"decide on no recording ({len(unrecorded)}): {', '.join(unrecorded) or 'none'}"
