"""How fast the tracker is: samples per second in batch, latency a sample live."""

from __future__ import annotations

import time
from dataclasses import dataclass

import numpy as np
from rich.console import Console
from rich.table import Table

from edge.samples import ImuBatch
from edge.sources.recording import RecordingSource
from edge.tracker import make_tracker

MIN_BATCH_SAMPLES = 400_000  # enough for a steady figure
MAX_LIVE_SAMPLES = 20_000


@dataclass(frozen=True, slots=True)
class Speed:
    """Wall-clock figures of this machine, after compilation."""

    batch_samples_per_s: float
    live_median_us: float
    live_p99_us: float
    live_worst_us: float


def measure_speed(source: RecordingSource, tracker: str) -> Speed:
    """Time one recording: whole and repeated for batch, one sample a push for live."""
    imu = source.imu
    _drive(source, tracker, imu, len(imu))  # compiles
    repeats = max(1, MIN_BATCH_SAMPLES // len(imu))
    began_s = time.perf_counter()
    for _ in range(repeats):
        _drive(source, tracker, imu, len(imu))
    batch_s = time.perf_counter() - began_s
    latencies_us = _live_latencies_us(source, tracker)
    return Speed(
        batch_samples_per_s=repeats * len(imu) / batch_s,
        live_median_us=float(np.median(latencies_us)),
        live_p99_us=float(np.quantile(latencies_us, 0.99)),
        live_worst_us=float(latencies_us.max()),
    )


def print_speed(console: Console, speed: Speed) -> None:
    table = Table(title="Speed")
    table.add_column("what")
    table.add_column("figure", justify="right")
    table.add_row("batch", f"{speed.batch_samples_per_s:,.0f} samples/s")
    table.add_row("live, median", f"{speed.live_median_us:.1f} us a sample")
    table.add_row("live, p99", f"{speed.live_p99_us:.1f} us a sample")
    table.add_row("live, worst", f"{speed.live_worst_us:.1f} us a sample")
    console.print(table)


def _drive(source: RecordingSource, name: str, imu: ImuBatch, rows: int) -> None:
    tracker = make_tracker(name, source.description)
    for first in range(0, len(imu), rows):
        tracker.push(_part(imu, first, first + rows))
    tracker.finish()


def _live_latencies_us(source: RecordingSource, name: str) -> np.ndarray:
    imu = source.imu
    tracker = make_tracker(name, source.description)
    samples = [_part(imu, k, k + 1) for k in range(min(len(imu), MAX_LIVE_SAMPLES))]
    latencies_us = np.empty(len(samples))
    for k, sample in enumerate(samples):
        began_ns = time.perf_counter_ns()
        tracker.push(sample)
        latencies_us[k] = 1e-3 * (time.perf_counter_ns() - began_ns)
    return latencies_us


def _part(imu: ImuBatch, first: int, stop: int) -> ImuBatch:
    return ImuBatch(imu.t_ns[first:stop], imu.accel_mps2[first:stop], imu.gyro_radps[first:stop])
