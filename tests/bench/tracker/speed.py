"""Speed of the tracker: samples a second and core in batch, latency of a sample live."""

from __future__ import annotations

import time
from dataclasses import dataclass

import numpy as np
from rich.console import Console
from rich.table import Table

from edge.samples import Floats, ImuBatch
from edge.sources.recording import RecordingSource
from edge.tracker.foot.config import EskfConfig
from edge.tracker.foot.error_state import SIZE
from edge.tracker.interface import TrackBatch
from edge.tracker.registry import make_tracker
from edge.tracker.track_rows import join_rows
from tests.bench.tracker.reference_filter import PlainFilter

BATCH_SAMPLES = 1_000_000  # at least, for a steady figure
LIVE_SAMPLES = 20_000  # at most
PLAIN_SAMPLES = 4_000  # at most


@dataclass(frozen=True, slots=True)
class Speed:
    """Figures of this machine, after compilation."""

    batch_samples_per_s: float  # of processor time
    plain_samples_per_s: float  # the same filter in plain NumPy, without detection and smoothing
    live_median_us: float  # of wall time, detection included
    live_p99_us: float
    live_worst_us: float


def measure_speed(source: RecordingSource, tracker: str) -> Speed:
    """Time one recording: whole and repeated for batch, one sample a push for live."""
    imu = source.imu
    rows = _drive(source, tracker)  # compiles
    repeats = max(1, BATCH_SAMPLES // len(imu))
    began_s = time.process_time()
    for _ in range(repeats):
        _drive(source, tracker)
    batch_s = time.process_time() - began_s
    latencies_us = _live_latencies_us(source, tracker)
    return Speed(
        batch_samples_per_s=repeats * len(imu) / batch_s,
        plain_samples_per_s=_plain_samples_per_s(imu, rows),
        live_median_us=float(np.median(latencies_us)),
        live_p99_us=float(np.quantile(latencies_us, 0.99)),
        live_worst_us=float(latencies_us.max()),
    )


def print_speed(console: Console, speed: Speed) -> None:
    table = Table(title="Speed")
    table.add_column("what")
    table.add_column("figure", justify="right")
    table.add_row("batch, one core", f"{speed.batch_samples_per_s:,.0f} samples/s")
    table.add_row("plain NumPy, filter alone", f"{speed.plain_samples_per_s:,.0f} samples/s")
    table.add_row("live, median", f"{speed.live_median_us:.1f} us a sample")
    table.add_row("live, p99", f"{speed.live_p99_us:.1f} us a sample")
    table.add_row("live, worst", f"{speed.live_worst_us:.1f} us a sample")
    console.print(table)


def _drive(source: RecordingSource, name: str) -> TrackBatch:
    tracker = make_tracker(name, source.description)
    return join_rows([tracker.push(source.imu), tracker.finish()])


def _live_latencies_us(source: RecordingSource, name: str) -> Floats:
    tracker = make_tracker(name, source.description)
    count = min(len(source.imu), LIVE_SAMPLES)
    samples = [source.imu.part(slice(k, k + 1)) for k in range(count)]
    latencies_us = np.empty(count)
    for k, sample in enumerate(samples):
        began_ns = time.perf_counter_ns()
        tracker.push(sample)
        latencies_us[k] = 1e-3 * (time.perf_counter_ns() - began_ns)
    return latencies_us


def _plain_samples_per_s(imu: ImuBatch, rows: TrackBatch) -> float:
    """Time prediction and stance updates; stance comes from the tracker's rows."""
    plain = PlainFilter(np.eye(3), 1e-4 * np.eye(SIZE), EskfConfig())
    count = min(len(imu), PLAIN_SAMPLES)
    step_s = np.diff(imu.t_ns[:count]) * 1e-9
    began_s = time.process_time()
    for k in range(1, count):
        plain.predict(imu.accel_mps2[k], imu.gyro_radps[k], step_s[k - 1])
        if rows.stationary[k]:
            plain.apply_zupt(imu.gyro_radps[k], 1e-4, 1e-2)
    return count / (time.process_time() - began_s)
