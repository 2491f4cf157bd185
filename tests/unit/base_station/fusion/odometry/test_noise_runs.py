"""Runs of a path by the noise that its tracker stated of them."""

from __future__ import annotations

import msgspec
import numpy as np

from base_station.fusion.odometry.noise_runs import MOST_RUNS, NoiseRun, cut_runs, end_run, run_of
from base_station.fusion.odometry.path_history import PathHistory
from shared.clock import NS_PER_S
from shared.messages import Header
from shared.path_noise import PathNoise
from tests.rig.message_factory import position

WIDE, NARROW = PathNoise(0.08, 0.3, 0.01), PathNoise(0.02, 0.1, 0.005)


def walked(noises: list[PathNoise | None]) -> PathHistory:
    """A metre a second, with the noise of each position."""
    history = PathHistory()
    for row, noise in enumerate(noises):
        stated = position(Header("a", 1, row + 1, row * NS_PER_S), north_m=float(row))
        history.append(msgspec.structs.replace(stated, path_noise=noise), row * NS_PER_S, False)
    return history


def test_each_interval_has_the_noise_of_its_time() -> None:
    history = walked([None, None, WIDE, WIDE, NARROW, NARROW])
    assert [(run.until_ns // NS_PER_S, run.noise) for run in history.noise_runs] == [
        (1, None),
        (3, WIDE),
    ]
    assert history.path_noise == NARROW
    times_ns = np.array([0, 1, 2, 3, 4, 5]) * NS_PER_S
    assert run_of(history.noise_runs, times_ns).tolist() == [0, 0, 1, 1, 2, 2]


def test_one_noise_makes_no_run() -> None:
    assert walked([WIDE] * 5).noise_runs == []


def test_history_of_a_version_without_runs_has_its_noise_all_along() -> None:
    packed = msgspec.msgpack.decode(msgspec.msgpack.encode(walked([None, WIDE, NARROW])))
    del packed["noise_runs"]
    history = msgspec.convert(packed, PathHistory)
    assert history.path_noise == NARROW
    assert run_of(history.noise_runs, np.array([0, 5 * NS_PER_S])).tolist() == [0, 0]


def test_runs_that_are_over_before_a_cut_go() -> None:
    runs = [NoiseRun(10, WIDE), NoiseRun(20, NARROW)]
    assert cut_runs(runs, 11) == [NoiseRun(20, NARROW)]


def test_of_too_many_runs_the_shortest_joins_the_next_with_the_larger_scale() -> None:
    runs: list[NoiseRun] = []
    ends_ns = [1000 * (at + 1) for at in range(MOST_RUNS + 1)]
    ends_ns[7] = ends_ns[6] + 1
    for at, until_ns in enumerate(ends_ns):
        end_run(runs, until_ns, WIDE if at % 2 else NARROW)
    assert len(runs) == MOST_RUNS
    assert ends_ns[7] not in [run.until_ns for run in runs]
    assert runs[7] == NoiseRun(ends_ns[8], WIDE)
