"""Runs of a path by the process noise that its tracker stated of them."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

import msgspec
import numpy as np
from numpy.typing import NDArray

from shared.path_noise import PathNoise

MOST_RUNS = 512  # of one path: the shortest are joined to their neighbours


class NoiseRun(msgspec.Struct, frozen=True, array_like=True):
    """Ended run; it began where the one before it ended."""

    until_ns: int  # time of its last position
    noise: PathNoise | None  # None: nothing was stated


def end_run(runs: list[NoiseRun], until_ns: int, noise: PathNoise | None) -> None:
    """Append a run; of too many, the shortest one counts as the run with the larger scale of it
    and the one behind it.
    """
    runs.append(NoiseRun(until_ns, noise))
    if len(runs) <= MOST_RUNS:
        return
    lasts_ns = [after.until_ns - before.until_ns for before, after in pairwise(runs)]
    at = int(np.argmin(lasts_ns[:-1])) + 1
    wider = max(runs[at : at + 2], key=lambda run: _scale_std(run.noise))
    runs[at : at + 2] = [NoiseRun(runs[at + 1].until_ns, wider.noise)]


def cut_runs(runs: list[NoiseRun], before_ns: int) -> list[NoiseRun]:
    """Return the runs that are not over before a time."""
    return [run for run in runs if run.until_ns >= before_ns]


def run_of(runs: Sequence[NoiseRun], t_ns: NDArray[np.int64]) -> NDArray[np.int64]:
    """Index (n,) of the run in which each time lies; ``len(runs)``: the one that goes on."""
    ends_ns = np.array([run.until_ns for run in runs], np.int64)
    return np.searchsorted(ends_ns, t_ns, side="left")


def _scale_std(noise: PathNoise | None) -> float:
    return 0.0 if noise is None else noise.scale_std or 0.0
