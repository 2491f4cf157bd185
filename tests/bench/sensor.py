"""``muster bench sensor``: cost of a unit's agent with emulated sensors of the kernel, and the
delay of a temperature on the console.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from contextlib import ExitStack, closing
from dataclasses import dataclass, field
from itertools import takewhile
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Annotated

import numpy as np
import typer
from rich.console import Console as Terminal
from rich.table import Table

from edge.sources.registry import open_source
from shared.bench_figures import FiguresFile, write_figures
from shared.clock import NS_PER_S
from shared.errors import ConfigError
from tests.bench.whole_unit import WholeUnitFigures, measure_whole_unit
from tests.rig.device_requests import DeviceRequests
from tests.rig.iio_device import BMI160, ICM_ACCEL, ICM_GYRO, EmulatedIio, Raw, without_buffer
from tests.rig.kernel_devices import EmulatedAgent, SysfsTree, has_umockdev
from tests.rig.station_process import free_port
from tests.rig.waiting import until

_RATE_HZ = 400.0
_WALK = "simulated:search-ground-floor"
_WALK_S = 120.0
_SCALES = np.array([0.001065] * 3 + [0.004788] * 3)  # rad/s and m/s2 of a raw value
_SETTLED_S = 10.0  # after the first samples
_TWO_RATES = {"sampling_frequency_available": "100 400"}
_POLLING_HZ = 100.0

Walk = Callable[[int], Raw]


@dataclass(frozen=True, slots=True)
class SensorRow:
    sensor: str
    tracker: str
    cores: float  # share of one that the agent takes
    rate_hz: float  # of samples that it has taken
    longest_gap_ms: float


@dataclass(frozen=True, slots=True)
class SensorFigures:
    rows: list[SensorRow] = field(default_factory=list)
    whole_unit: WholeUnitFigures = field(default_factory=WholeUnitFigures)


def bench_sensor(
    seconds: Annotated[float, typer.Option(min=5.0, help="Duration of each measurement.")] = 60.0,
    steps: Annotated[int, typer.Option(min=1, help="Steps of the temperature.")] = 40,
    json_file: FiguresFile = None,
) -> None:
    """Measure the processor time of an agent with emulated sensors, and the delay of a
    temperature on the console.
    """
    if not has_umockdev():
        raise ConfigError("no umockdev on this machine: install the package umockdev")
    walk = raw_walk()
    rows = [
        measure("one device", "iio:bmi160", "eskf", seconds, walk),
        measure("two devices", "iio:icm42688-accel+icm42688-gyro", "eskf", seconds, walk),
        measure("one device", "iio:bmi160", "none", seconds, walk),
        measure("polled", f"iio:bmi160?rate={_POLLING_HZ:g}", "eskf", seconds, walk),
    ]
    with TemporaryDirectory(prefix="muster") as name:
        whole_unit = measure_whole_unit(seconds, steps, Path(name), walk)
    Terminal().print(_table(rows))
    Terminal().print(_whole_unit_table(whole_unit))
    write_figures(json_file, SensorFigures(rows, whole_unit))


def raw_walk() -> Walk:
    """Return the raw values of a walk that begins anew at its end."""
    end_ns = round(_WALK_S * NS_PER_S)
    walk = (batch.imu for batch in open_source(_WALK).batches())
    batches = list(takewhile(lambda imu: imu.t_ns[0] < end_ns, walk))
    t_ns = np.concatenate([imu.t_ns for imu in batches])
    values = np.concatenate([np.hstack((imu.gyro_radps, imu.accel_mps2)) for imu in batches])
    at_ns = np.arange(t_ns[0], t_ns[-1], NS_PER_S / _RATE_HZ)
    columns = [np.interp(at_ns, t_ns, column) for column in (values / _SCALES).T]
    raw = np.clip(np.rint(np.stack(columns, axis=1)), -(2**15), 2**15 - 1).astype(int)
    rows = [tuple(row) for row in raw.tolist()]
    return lambda k: rows[k % len(rows)]


def measure(sensor: str, source: str, tracker: str, seconds: float, walk: Walk) -> SensorRow:
    """Measure an agent for some seconds; ``walk``: raw values of the kth sample."""
    with TemporaryDirectory(prefix="muster") as name, ExitStack() as stack:
        machine = Path(name)
        tree, devices = SysfsTree(machine / "sys"), machine / "dev"
        for number in range(2):
            stack.enter_context(closing(DeviceRequests(machine, f"iio:device{number}")))
        for device in _emulated(sensor, tree, devices, walk):
            stack.enter_context(closing(device))
        flags = (
            *("--unit", "u1", "--source", source, "--tracker", tracker),
            *("--data", f"{machine}/edge", "--connect", f"tcp/127.0.0.1:{free_port()}"),
        )
        with EmulatedAgent(machine, machine / "agent.txt", *flags) as agent:
            until(lambda: "samples/s" in agent.output(), "the agent with its sensor")
            time.sleep(_SETTLED_S)
            begun_s, spent_s = time.monotonic(), agent.cpu_s()
            time.sleep(seconds)
            cores = (agent.cpu_s() - spent_s) / (time.monotonic() - begun_s)
            agent.stop()
        (boot,) = (machine / "edge" / "u1" / "black_box").iterdir()
        t_ns = np.concatenate([batch.imu.t_ns for batch in open_source(f"mcap:{boot}").batches()])
    rate_hz = (len(t_ns) - 1) * NS_PER_S / (t_ns[-1] - t_ns[0])
    return SensorRow(sensor, tracker, cores, float(rate_hz), float(np.diff(t_ns).max()) / 1e6)


def _emulated(sensor: str, tree: SysfsTree, devices: Path, walk: Walk) -> list[EmulatedIio]:
    if sensor == "one device":
        return [EmulatedIio(tree, devices, BMI160, values=walk)]
    if sensor == "two devices":
        return [
            EmulatedIio(
                tree, devices, ICM_ACCEL, 0, values=lambda k: (*walk(k)[3:], 0), **_TWO_RATES
            ),
            EmulatedIio(tree, devices, ICM_GYRO, 1, values=lambda k: walk(k)[:3], **_TWO_RATES),
        ]
    without_buffer(tree, BMI160)  # it lies still
    return []


def _table(rows: list[SensorRow]) -> Table:
    table = Table(title="A unit's agent with an emulated sensor of Industrial I/O")
    table.add_column("sensor")
    table.add_column("tracker")
    for title in ("share of a core", "samples/s", "longest gap"):
        table.add_column(title, justify="right")
    for row in rows:
        shown = f"{row.cores:.1%}", f"{row.rate_hz:.1f}", f"{row.longest_gap_ms:.1f} ms"
        table.add_row(row.sensor, row.tracker, *shown)
    return table


def _whole_unit_table(figures: WholeUnitFigures) -> Table:
    table = Table("", "measured", "to reach", title="A whole unit beside a station")
    table.add_row("all sensors at 400 Hz: share of a core", f"{figures.cores:.1%}", "15 %")
    p50_s, p99_s, most_s = np.percentile(figures.temperature_s, (50, 99, 100))
    shown = f"p50 {p50_s:.2f} s, p99 {p99_s:.2f} s, at most {most_s:.2f} s"
    table.add_row("temperature step to the console", shown, "2 s")
    return table
