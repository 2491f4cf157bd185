"""``muster bench track --simulated``: where walks of hard motions end, and what is stated of it.

Accelerometer and gyroscope alone; held at the true start and heading.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from rich.console import Console
from rich.progress import track as progress_bar
from rich.table import Table

from edge.samples import Floats
from edge.simulation.hard_motions import HARD_MOTIONS
from edge.simulation.scenario import Scenario
from edge.sources.recording import RecordedTruth
from tests.bench.tracker.scoring import Score, score_track
from tests.bench.tracker.walk_errors import rms, track, true_way_m
from tests.rig.inertial_walk import inertial_walk, motion_at

SEEDS = range(4)
_EVERY_S = 0.5


@dataclass(frozen=True, slots=True)
class WalkEnd:
    """One walk: the error at its end with the deviation stated of it, and its score."""

    horizontal_m: float
    horizontal_stated_m: float
    vertical_m: float
    vertical_stated_m: float
    score: Score


@dataclass(frozen=True, slots=True)
class HardMotion:
    """All walks of a scenario; root mean squares, and of shares the mean."""

    scenario: str
    walks: int
    horizontal_m: float
    horizontal_stated_m: float
    vertical_m: float
    vertical_stated_m: float
    stated_by_error: float  # over the whole walk
    silently_wrong: float
    lost: float


def measure_hard_motions(
    tracker: str, scenarios: Sequence[Scenario] = HARD_MOTIONS, seeds: Sequence[int] = SEEDS
) -> list[HardMotion]:
    """Let every seed's person do every hard motion."""
    bar = progress_bar(
        scenarios, description="Walking", console=Console(stderr=True), transient=True
    )
    return [
        _together(scenario.name, [walk_end(scenario, seed, tracker) for seed in seeds])
        for scenario in bar
    ]


def walk_end(scenario: Scenario, seed: int, tracker: str) -> WalkEnd:
    """Walk once, track by accelerometer and gyroscope, and compare."""
    walk = inertial_walk(scenario, seed)
    description = replace(walk.description, mag_present=False, barometer_present=False)
    rows = track(description, walk.sensed(), tracker)
    every = slice(0, None, round(_EVERY_S * scenario.rate_hz))
    way_m, _ = true_way_m(rows.quaternion_nb[every], motion_at(walk.truth, every))
    truth = RecordedTruth(walk.t_s[every], way_m)
    # Both stand still from the last of these times on.
    off_m = rows.position_n_m[-1] - way_m[-1]
    stated_m = np.sqrt(np.diag(rows.position_cov_m2[-1]))
    return WalkEnd(
        horizontal_m=float(np.hypot(off_m[0], off_m[1])),
        horizontal_stated_m=float(np.hypot(stated_m[0], stated_m[1])),
        vertical_m=float(off_m[2]),
        vertical_stated_m=float(stated_m[2]),
        score=score_track(rows, truth, closed_loop=False, heading_known=True),
    )


def _together(scenario: str, ends: Sequence[WalkEnd]) -> HardMotion:
    def of(name: str) -> Floats:
        return np.array([getattr(end, name) for end in ends])

    def share(name: str) -> float:
        return float(np.mean([getattr(end.score, name) for end in ends]))

    return HardMotion(
        scenario=scenario,
        walks=len(ends),
        horizontal_m=rms(of("horizontal_m")),
        horizontal_stated_m=rms(of("horizontal_stated_m")),
        vertical_m=rms(of("vertical_m")),
        vertical_stated_m=rms(of("vertical_stated_m")),
        stated_by_error=share("stated_by_error"),
        silently_wrong=share("silently_wrong"),
        lost=share("lost"),
    )


def hard_motions_table(results: Sequence[HardMotion]) -> Table:
    table = Table(title="Simulated hard motions: error at the end / stated, m")
    table.add_column("hard motion")
    titles = ("horizontal", "vertical", "stated/error", "silent, %", "lost, %")
    for title in titles:
        table.add_column(title, justify="right")
    for one in results:
        table.add_row(
            one.scenario,
            f"{one.horizontal_m:.2f} / {one.horizontal_stated_m:.2f}",
            f"{one.vertical_m:.2f} / {one.vertical_stated_m:.2f}",
            f"{one.stated_by_error:.1f}",
            f"{100.0 * one.silently_wrong:.1f}",
            f"{100.0 * one.lost:.1f}",
        )
    return table
