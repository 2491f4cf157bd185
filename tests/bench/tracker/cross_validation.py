"""Leave one dataset out: would the other datasets have chosen this configuration?

For each dataset the configuration is chosen that does best on all the others, among
the default and variants of it that double or halve one parameter.  Its error on the
dataset left out, beside the default's, tells how much of the default's accuracy is
tuning to that dataset.
"""

from __future__ import annotations

import math
import statistics
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from rich.console import Console
from rich.progress import track as progress_bar
from rich.table import Table

from edge.sources.recording import RecordingSource, read_truth
from edge.tracker.foot.config import EskfConfig
from edge.tracker.foot.eskf import EskfTracker
from edge.tracker.track_rows import join_rows
from tests.bench.tracker.scoring import score_track

VARIED = (
    "detection.half_window_s",
    "detection.rate_weight_m2ps2",
    "detection.threshold_ratio",
    "detection.threshold_min_m2ps4",
    "zupt.stance_velocity_mps_rthz",
    "zupt.stance_velocity_per_motion",
    "zupt.stance_excess_power",
    "zupt.stance_rate_radps_rthz",
    "zupt.stance_rate_per_unrest",
    "process.accel_noise_mps2_rthz",
    "process.gyro_noise_radps_rthz",
    "process.gyro_bias_walk_radps2_rthz",
    "start.gyro_bias_std_radps",
    "start.accel_bias_std_mps2",
    "start.lever_std_m",
)
FACTORS = (0.5, 2.0)
LEAST_ERROR_M = 0.01  # smaller is luck and must not decide


@dataclass(frozen=True, slots=True)
class LeftOut:
    """One dataset, judged by what the others chose."""

    dataset: str
    chosen: str
    default_mean_m: float  # horizontal error of the default, mean over the trials
    chosen_mean_m: float


def candidates() -> dict[str, EskfConfig]:
    """Return the default and its variants by name."""
    default = EskfConfig()
    named = {"default": default}
    for name in VARIED:
        for factor in FACTORS:
            part, parameter = name.split(".")
            whole = getattr(default, part)
            varied = whole._replace(**{parameter: factor * getattr(whole, parameter)})
            named[f"{name} x {factor:g}"] = default._replace(**{part: varied})
    return named


def cross_validate(trials: Sequence[Path]) -> list[LeftOut]:
    """Run every candidate on every trial folder and leave each dataset out once."""
    sources = [(RecordingSource(path), path) for path in trials]
    errors_m: dict[str, dict[str, list[float]]] = {}
    for name, config in progress_bar(
        candidates().items(),
        description="Cross-validating",
        console=Console(stderr=True),
        transient=True,
    ):
        errors_m[name] = {}
        for source, path in sources:
            dataset = source.trial.dataset or path.parent.name
            errors_m[name].setdefault(dataset, []).append(_error_m(source, path, config))
    return leave_one_out(errors_m)


def leave_one_out(errors_m: Mapping[str, Mapping[str, Sequence[float]]]) -> list[LeftOut]:
    """Choose per dataset from ``errors_m[candidate][dataset]`` by the other datasets."""
    datasets = list(errors_m["default"])
    result = []
    for dataset in datasets:
        others = [name for name in datasets if name != dataset] or [dataset]
        means = {name: _mean_log(by_dataset, others) for name, by_dataset in errors_m.items()}
        chosen = min(means, key=means.__getitem__)
        result.append(
            LeftOut(
                dataset=dataset,
                chosen=chosen,
                default_mean_m=statistics.fmean(errors_m["default"][dataset]),
                chosen_mean_m=statistics.fmean(errors_m[chosen][dataset]),
            )
        )
    return result


def left_out_table(result: Sequence[LeftOut]) -> Table:
    table = Table(title="Leave one dataset out: mean horizontal error, m")
    for title in ("left out", "the others choose", "their choice", "the default"):
        table.add_column(title, justify="left" if title.startswith(("left", "the o")) else "right")
    for entry in result:
        table.add_row(
            entry.dataset, entry.chosen, f"{entry.chosen_mean_m:.3f}", f"{entry.default_mean_m:.3f}"
        )
    return table


def _mean_log(errors_m: Mapping[str, Sequence[float]], datasets: Sequence[str]) -> float:
    """Return the mean over datasets of the mean log error: no dataset outweighs another."""
    return statistics.fmean(
        statistics.fmean(math.log(max(error_m, LEAST_ERROR_M)) for error_m in errors_m[dataset])
        for dataset in datasets
    )


def _error_m(source: RecordingSource, path: Path, config: EskfConfig) -> float:
    tracker = EskfTracker(source.description, config)
    rows = join_rows([tracker.push(source.imu), tracker.finish()])
    score = score_track(rows, read_truth(path), closed_loop=True)
    return score.closure_horizontal_m if score.ate_m is None else score.ate_m
