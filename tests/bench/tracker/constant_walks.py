"""Walks over which ``muster bench constants`` varies the tracker: of every kind that there is."""

from __future__ import annotations

import zlib
from collections.abc import Iterator
from dataclasses import dataclass, replace
from itertools import cycle
from pathlib import Path

import numpy as np

from edge.samples import ImuBatch, SensorDescription
from edge.simulation.hard_motions import HARD_MOTIONS
from edge.simulation.simulation import CONSUMER_SENSORS, UNCALIBRATED_SENSORS
from edge.sources.recording import RecordedTruth, RecordingSource, read_truth
from edge.tracker.foot.eskf import EskfTracker
from edge.tracker.interface import TrackBatch
from edge.tracker.track_rows import join_rows
from shared.errors import UserError
from tests.bench.tracker.perturbations import PERTURBATIONS
from tests.bench.tracker.scoring import Score, score_track
from tests.bench.tracker.walk_errors import true_way_m
from tests.rig.inertial_walk import InertialWalk, inertial_walk, motion_at

RECORDED, SIMULATED, WORSE = "recorded", "simulated", "worse sensor"
AIDS = ("mag_ut", "pressure_pa", "imu_temperature_degc")
AIDED = ("search-ground-floor", "lift", "stairs", "tower")  # with magnetometer and barometer
AIDED_S = 60.0
_SENSORS = (CONSUMER_SENSORS, UNCALIBRATED_SENSORS)  # calibrated and by the data sheet, in turn
_EVERY_S = 0.5
_START_S = 2.0  # more than the tracker looks ahead


@dataclass(frozen=True, eq=False)
class Walk:
    """Samples of one foot, and what is known of its way."""

    kind: str  # RECORDED, SIMULATED or WORSE
    name: str
    description: SensorDescription
    imu: ImuBatch
    truth: RecordedTruth | None
    closed_loop: bool = False
    heading_known: bool = False


def score_walk(walk: Walk, rows: TrackBatch) -> Score:
    return score_track(
        rows, walk.truth, closed_loop=walk.closed_loop, heading_known=walk.heading_known
    )


def all_walks(data: Path) -> list[Walk]:
    """Return recorded walks, simulated ones, and recorded ones of worse sensors."""
    return [*recorded_walks(data), *hard_walks(), *_aided(), *_worse(_trials(data))]


def recorded_walks(data: Path) -> list[Walk]:
    """Return walks and runs of all datasets, no more than a bench has the time for."""
    recorded = [_recorded(path) for path in _some(_trials(data))]
    # One walk out and back of each person, at 100 Hz by a link that loses samples.
    feet = {path.parent.name.split("-")[0]: path for path in data.glob("body/ipol/*/left_foot.*")}
    return recorded + [_recorded(path) for _, path in sorted(feet.items())]


def hard_walks() -> list[Walk]:
    """Return one walk of each simulated hard motion, whose name it has."""
    return [
        _inertial(scenario.name, inertial_walk(scenario, sensors=sensors))
        for scenario, sensors in zip(HARD_MOTIONS, cycle(_SENSORS), strict=False)
    ]


def _trials(data: Path) -> list[Path]:
    folders = sorted(path.parent for path in data.glob("*/*/*/imu.csv.gz"))
    trials = [path for path in folders if path.parents[1].name in ("walks", "hard")]
    if not trials:
        raise UserError(f"no walks and hard below {data}; give the folder of both")
    return trials


def _some(trials: list[Path]) -> Iterator[Path]:
    """Every hard trial, and every second of each other dataset: all would take twice as long."""
    for folder in dict.fromkeys(path.parent for path in trials):
        members = [path for path in trials if path.parent == folder]
        yield from members if folder.parent.name == "hard" else members[::2]


def _recorded(path: Path) -> Walk:
    source = RecordingSource(path)
    folder = path if path.is_dir() else path.parent
    return Walk(
        kind=RECORDED,
        name=f"{folder.parent.name}/{folder.name}",
        description=source.description,
        imu=source.imu,
        truth=read_truth(folder) if path.is_dir() else None,
        closed_loop=source.trial.truth_kind == "closed_loop",
    )


def _aided() -> Iterator[Walk]:
    for name, sensors in zip(AIDED, cycle(_SENSORS), strict=False):
        yield _inertial(name, inertial_walk(name, sensors=sensors, lasts_s=AIDED_S), *AIDS)


def _inertial(name: str, walk: InertialWalk, *aids: str) -> Walk:
    description = replace(
        walk.description,
        mag_present="mag_ut" in aids,
        barometer_present="pressure_pa" in aids,
    )
    imu = walk.sensed(*aids)
    every = slice(0, None, round(_EVERY_S * description.rate_hz))
    tracker = EskfTracker(description)
    first = imu.part(slice(0, round(_START_S * description.rate_hz)))
    start = join_rows([tracker.push(first), tracker.finish()])
    truth = motion_at(walk.truth, every)
    way_m, _ = true_way_m(np.repeat(start.quaternion_nb[:1], len(truth.t_s), axis=0), truth)
    return Walk(
        kind=SIMULATED,
        name=name,
        description=description,
        imu=imu,
        truth=RecordedTruth(truth.t_s, way_m),
        heading_known=True,
    )


def _worse(trials: list[Path]) -> Iterator[Walk]:
    """Every perturbation, of the two shortest trials of different datasets in turn."""
    shortest: dict[str, tuple[Path, RecordingSource]] = {}
    for path in trials:
        source = RecordingSource(path)
        known = shortest.get(path.parent.name)
        if known is None or len(source.imu) < len(known[1].imu):
            shortest[path.parent.name] = (path, source)
    two = sorted(shortest.values(), key=lambda one: len(one[1].imu))[:2]
    for perturbation, (path, source) in zip(PERTURBATIONS[1:], cycle(two), strict=False):
        rng = np.random.default_rng(zlib.crc32(f"{path.name} {perturbation.name}".encode()))
        description, imu = perturbation.apply(source.description, source.imu, rng)
        truth = read_truth(path)
        if truth is not None:
            known_s = truth.t_s >= imu.t_ns[0] * 1e-9
            truth = RecordedTruth(truth.t_s[known_s], truth.position_n_m[known_s])
        yield Walk(
            kind=WORSE,
            name=f"{path.parent.name}/{path.name}, {perturbation.name}",
            description=description,
            imu=imu,
            truth=truth,
            closed_loop=source.trial.truth_kind == "closed_loop",
        )
