"""Processor time of a station for the messages of many wearers, and the times that its
parts could take alone.
"""

from __future__ import annotations

import time
from dataclasses import dataclass
from importlib.machinery import ExtensionFileLoader
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
import psutil
from rich.progress import Progress

from base_station.core import pipeline
from base_station.process import gc_tuning
from tests.rig.accelerated_station import CompressedStation, compressed_station
from tests.rig.raw_zenoh_baseline import bare_subscriber, measure_flood
from tests.rig.recorder_baseline import recording_hz
from tests.rig.simulated_units import unit_names
from tests.rig.station_process import free_port

_WARM_S = 5.0
_FLOOD_S = 3.0
_RECORDED = 200_000


@dataclass(frozen=True, slots=True)
class ThroughputReport:
    units: int
    rate_hz: float  # of each unit
    consoles: int
    minutes: float  # of the station's time
    is_compiled: bool  # the core, as in a wheel that was built so
    messages: int
    cpu_us: dict[str, float]  # by part, a message
    per_core_hz: float
    times_real: float  # how much faster than time goes by, on this machine now
    memory_mb: tuple[float, ...]  # once a minute of the station's time, the first at the start
    # Over the last third: by then trails are full; None: the run was too short to tell.
    memory_slope_mb_per_minute: float | None
    console_messages: int


@dataclass(frozen=True, slots=True)
class Yardsticks:
    """Speed of this machine now."""

    bare_zenoh_hz: float  # messages of 200 bytes that a subscriber takes that does nothing else
    recording_hz: float  # messages that the log alone takes, a second of processor time


def measure_yardsticks(progress: Progress) -> Yardsticks:
    """Rates of a station that does nothing with the messages."""
    task = progress.add_task("bare Zenoh, and the log alone", total=2.0)
    address = f"tcp/127.0.0.1:{free_port()}"
    with bare_subscriber(address) as far_end:
        bare = measure_flood(address, far_end, _FLOOD_S)
    progress.advance(task)
    recording = recording_hz(_RECORDED)
    progress.advance(task)
    return Yardsticks(bare.rate_hz, recording)


def measure(
    units: int, rate_hz: float, minutes: float, consoles: int, progress: Progress
) -> ThroughputReport:
    gc_tuning.configure()  # as the station does
    task = progress.add_task(f"{units} units, {rate_hz:g}/s each", total=minutes)
    with (
        TemporaryDirectory(prefix="muster-bench-") as folder,
        compressed_station(Path(folder), unit_names(units), rate_hz, consoles) as station,
    ):
        station.run(_WARM_S)
        gc_tuning.freeze()
        messages, spent_s, began = station.messages, station.cpu_s(), time.perf_counter()
        memory_mb = [_memory_mb()]
        while (left := minutes - (len(memory_mb) - 1)) > 0.0:
            station.run(60.0 * min(left, 1.0))
            memory_mb.append(_memory_mb())
            progress.advance(task, min(left, 1.0))
        took_s, messages = time.perf_counter() - began, station.messages - messages
        cpu_us = _cost_us(station, spent_s, messages)
        shown = station.console_messages
    return ThroughputReport(
        units=units,
        rate_hz=rate_hz,
        consoles=consoles,
        minutes=minutes,
        is_compiled=isinstance(pipeline.__loader__, ExtensionFileLoader),
        messages=messages,
        cpu_us=cpu_us,
        per_core_hz=1e6 / sum(cpu_us.values()),
        times_real=minutes * 60.0 / took_s,
        memory_mb=tuple(memory_mb),
        memory_slope_mb_per_minute=_slope(memory_mb),
        console_messages=shown,
    )


def _cost_us(
    station: CompressedStation, before_s: dict[str, float], messages: int
) -> dict[str, float]:
    now_s = station.cpu_s()
    return {part: (now_s[part] - before_s.get(part, 0.0)) * 1e6 / messages for part in now_s}


def _memory_mb() -> float:
    return float(psutil.Process().memory_info().rss) / 1e6


def _slope(memory_mb: list[float]) -> float | None:
    """Slope of the last third, by least squares; meaningless for a run of a few minutes."""
    late = memory_mb[2 * len(memory_mb) // 3 :]
    if len(late) < 3:
        return None
    return float(np.polyfit(np.arange(len(late)), late, 1)[0])
