"""``muster bench aids``: effect of magnetometer, barometer and calibration.

The same walks with and without each.  Only what is simulated has a truth for it: no recording
at hand has a barometer, and those with a magnetometer last a minute.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import asdict, dataclass, replace
from functools import partial
from pathlib import Path
from typing import Annotated

import msgspec
import numpy as np
import typer
from rich.console import Console
from rich.progress import track as progress_bar
from rich.table import Table

from edge.samples import ImuBatch
from edge.simulation.factory import find_scenario
from edge.simulation.simulation import (
    CONSUMER_SENSORS,
    UNCALIBRATED_SENSORS,
    SensorErrors,
    Simulation,
)
from edge.sources.recording import RecordingSource
from edge.tracker.registry import TRACKERS
from shared.bench_figures import FiguresFile, write_figures
from tests.bench.tracker.magnetic_north import NorthErrors, find_north, north_table
from tests.bench.tracker.simulated_calibration import calibration_of
from tests.bench.tracker.walk_errors import WalkErrors, rms, track, walk_errors
from tests.rig.inertial_walk import samples

SEEDS = range(8)
_SEARCH_S = 600.0
_LIFT_S = 300.0
_WORSE_DEG = 1.0
_SLOW_BEND_UT = 5.0  # root mean square, each axis
_SLOW_WAVES_M = (25.0, 80.0)

Change = Callable[[ImuBatch, Simulation], ImuBatch]


@dataclass(frozen=True, slots=True)
class Comparison:
    """One aid on walks of one kind, averaged (root mean square) over the seeds."""

    aid: str
    walks: str
    without: WalkErrors
    with_: WalkErrors
    worse: int  # wearers whose heading got worse by more than a degree


@dataclass(frozen=True, slots=True)
class Closure:
    """A recorded closed loop: how far from its start it ends, with and without magnetometer."""

    trial: str
    without_m: float
    with_m: float


def bench_aids(
    data: Annotated[
        Path | None, typer.Argument(help="Recorded walks, such as shared/data/walks.")
    ] = None,
    json_file: FiguresFile = None,
    tracker: Annotated[
        str, typer.Option(help="One of: " + ", ".join(entry.name for entry in TRACKERS) + ".")
    ] = TRACKERS[0].name,
) -> None:
    """Measure the errors of simulated walks with and without magnetometer, barometer and
    calibration.
    """
    console = Console(width=max(Console().width, 130))
    jobs = list(_jobs(tracker))
    bar = progress_bar(jobs, description="Walking", console=Console(stderr=True), transient=True)
    comparisons = [job() for job in bar]
    norths = [find() for find in _norths(tracker)]
    closures = [] if data is None else closures_of(data, tracker)
    console.print(comparison_table(comparisons))
    console.print(north_table(norths))
    if closures:
        console.print(closure_table(closures))
    figures = {"comparisons": comparisons, "norths": norths, "closures": closures}
    write_figures(json_file, figures)


def _jobs(tracker: str) -> Iterator[Callable[[], Comparison]]:
    def job(
        aid: str, walks: str, scenario: str, without: Change, with_: Change, **changes: object
    ) -> Callable[[], Comparison]:
        sensors = UNCALIBRATED_SENSORS if aid == "calibration" else CONSUMER_SENSORS
        make = partial(_simulation, scenario, sensors, tuple(changes.items()))
        return partial(_compare, tracker, aid, walks, make, without, with_)

    search, searching = "search-ground-floor", {"duration_s": _SEARCH_S}
    yield job("magnetometer", "10 min on open ground", search, _blind, _as_is,
              building=False, **searching)  # fmt: skip
    yield job("magnetometer", "10 min, 5 uT bent over 25-80 m", search, _blind, _bent,
              building=False, **searching)  # fmt: skip
    yield job("magnetometer", "10 min in the training house", search, _blind, _as_is, **searching)
    yield job("magnetometer", "10 min in a steel building", search, _blind, _as_is,
              steel_ut=12.0, **searching)  # fmt: skip
    yield job("barometer", "lift, 5 min", "lift", _airless, _as_is, duration_s=_LIFT_S)
    yield job("barometer", "stairs and rooms, 10 min", "climbs-stairs", _airless, _as_is,
              duration_s=_SEARCH_S)  # fmt: skip
    yield job("barometer", "one floor, 10 min", search, _airless, _as_is, **searching)
    for name in ("square-60m", "track-400m", "stairs"):
        yield job("calibration", name, name, _as_is, _calibrated)


def _norths(tracker: str) -> Iterator[Callable[[], NorthErrors]]:
    def find(walks: str, change: Change, **changes: object) -> Callable[[], NorthErrors]:
        settings = (("duration_s", _SEARCH_S), *changes.items())
        simulations = [
            _simulation("search-ground-floor", CONSUMER_SENSORS, settings, seed) for seed in SEEDS
        ]
        return partial(
            find_north, walks, simulations, lambda one: change(_walked(one), one), tracker
        )

    yield find("10 min on open ground", _as_is, building=False)
    yield find("10 min, 5 uT bent over 25-80 m", _bent, building=False)
    yield find("10 min in the training house", _as_is)
    yield find("10 min in a steel building", _as_is, steel_ut=12.0)


def _as_is(imu: ImuBatch, _: Simulation) -> ImuBatch:
    return imu


def _blind(imu: ImuBatch, _: Simulation) -> ImuBatch:
    return replace(imu, mag_ut=None)


def _bent(imu: ImuBatch, simulation: Simulation) -> ImuBatch:
    """As by the steel of a whole district: no footfall differs much from the next."""
    rng = simulation.sensor_rngs()[1]
    truth = simulation.truth(np.asarray(imu.t_ns * 1e-9, dtype=np.float64))
    direction = rng.normal(0.0, 1.0, (6, 3))
    direction /= np.linalg.norm(direction, axis=1, keepdims=True)
    wave_per_m = 2.0 * np.pi / rng.uniform(*_SLOW_WAVES_M, (6, 1)) * direction
    phase = rng.uniform(0.0, 2.0 * np.pi, 6)
    amplitude_ut = rng.normal(0.0, _SLOW_BEND_UT / 3.0**0.5, (6, 3))
    bend_n_ut = np.sin(truth.position_n_m @ wave_per_m.T + phase) @ amplitude_ut
    bend_ut = np.einsum("nji,nj->ni", truth.rotation_nb, bend_n_ut)
    assert imu.mag_ut is not None
    return replace(imu, mag_ut=imu.mag_ut + bend_ut)


def _airless(imu: ImuBatch, _: Simulation) -> ImuBatch:
    return replace(imu, pressure_pa=None)


def _calibrated(imu: ImuBatch, simulation: Simulation) -> ImuBatch:
    return calibration_of(simulation).apply(imu, simulation.description)


def _simulation(
    name: str, sensors: SensorErrors, changes: tuple[tuple[str, object], ...], seed: int
) -> Simulation:
    scenario = msgspec.structs.replace(find_scenario(name), **dict(changes))
    return Simulation(scenario, seed, sensors)


def _compare(
    tracker: str,
    aid: str,
    walks: str,
    make: Callable[[int], Simulation],
    without: Change,
    with_: Change,
) -> Comparison:
    errors: tuple[list[WalkErrors], list[WalkErrors]] = ([], [])
    for seed in SEEDS:
        simulation = make(seed)
        imu = _walked(simulation)
        truth = simulation.truth(np.asarray(imu.t_ns * 1e-9, dtype=np.float64))
        for change, found in zip((without, with_), errors, strict=True):
            rows = track(simulation.description, change(imu, simulation), tracker)
            found.append(walk_errors(rows, truth))
    both = zip(*errors, strict=True)
    worse = sum(after.heading_deg > before.heading_deg + _WORSE_DEG for before, after in both)
    return Comparison(aid, walks, _mean(errors[0]), _mean(errors[1]), worse)


def _walked(simulation: Simulation) -> ImuBatch:
    return samples(simulation, simulation.duration_s)


def _mean(errors: list[WalkErrors]) -> WalkErrors:
    fields = asdict(errors[0])
    return WalkErrors(
        **{name: rms(np.array([getattr(one, name) for one in errors])) for name in fields}
    )


def closures_of(data: Path, tracker: str) -> list[Closure]:
    """Track every closed loop below ``data`` that has a magnetometer, with and without it."""
    closures = []
    for folder in sorted({path.parent for path in data.rglob("imu.csv*")}):
        source = RecordingSource(folder)
        if source.trial.truth_kind != "closed_loop" or source.imu.mag_ut is None:
            continue
        ends_m = []
        for imu in (replace(source.imu, mag_ut=None), source.imu):
            position_n_m = track(source.description, imu, tracker).position_n_m
            ends_m.append(float(np.hypot(*(position_n_m[-1] - position_n_m[0])[:2])))
        closures.append(Closure(f"{folder.parent.name}/{folder.name}", *ends_m))
    return closures


def comparison_table(comparisons: list[Comparison]) -> Table:
    table = Table(title="Errors without -> with (over stated deviation; 1 is honest)")
    for title in ("aid", "walks", "heading, deg", "horizontal, m", "height, m", "heading worse"):
        table.add_column(title)
    for one in comparisons:
        a, b = one.without, one.with_
        table.add_row(
            one.aid,
            one.walks,
            f"{a.heading_deg:.1f} ({a.heading_stated:.1f}) -> "
            f"{b.heading_deg:.1f} ({b.heading_stated:.1f})",
            f"{a.horizontal_m:.2f} -> {b.horizontal_m:.2f}",
            f"{a.height_m:.3f} ({a.height_stated:.1f}) -> {b.height_m:.3f} ({b.height_stated:.1f})",
            f"{one.worse} of {len(SEEDS)}" if one.aid == "magnetometer" else "",
        )
    return table


def closure_table(closures: list[Closure]) -> Table:
    table = Table(title="Closed loops with a magnetometer: closure, m")
    for title in ("trial", "without", "with"):
        table.add_column(title)
    for one in closures:
        table.add_row(one.trial, f"{one.without_m:.3f}", f"{one.with_m:.3f}")
    return table
