"""Session of a calibration, from its first step to the file."""

from __future__ import annotations

import time
from collections.abc import Iterator, Mapping
from contextlib import closing
from datetime import UTC, datetime
from pathlib import Path

from rich.console import Console

from edge.calibration.file import write_calibration
from edge.calibration.procedure import run_step, solve, take
from edge.calibration.report import print_report
from edge.calibration.steps import PosesStep, Step, StillStep, TurningStep, WarmUpStep
from edge.clocks.timeline import Pacer
from edge.samples import SensorBatch
from edge.sources.interface import Source
from edge.sources.registry import SOURCES, open_source
from shared.clock import NS_PER_S
from shared.errors import UserError

_LIMIT_S = 600.0
_WARM_UP_LIMIT_S = 3600.0


def calibrate_guided(
    source: Source,
    out: Path,
    unit: str,
    sensor: str | None,
    *,
    with_warm_up: bool,
    speed: float | None = None,
) -> None:
    """Guide a person through the steps with samples from ``source``.

    ``speed`` plays a recorded or simulated unit at that multiple of real time; None: at once.
    """
    console = _console()
    batches = source.batches() if speed is None else _played(source.batches(), speed)
    steps = _guided(source.description.mag_present, with_warm_up, batches, console)
    _finish(steps, unit, source.description.name if sensor is None else sensor, out, console)


def calibrate_recorded(
    recordings: Mapping[str, str], out: Path, unit: str, sensor: str | None
) -> None:
    """Use recordings, by the name of the step that they are of."""
    made: tuple[Step, ...] = (StillStep(), PosesStep(), TurningStep(), WarmUpStep())
    steps = [step for step in made if step.name in recordings]
    for step in steps:
        _take_recording(step, recordings[step.name])
    _finish(steps, unit, sensor or "", out, _console())


def _console() -> Console:
    return Console(stderr=True, width=max(Console(stderr=True).width, 110))


def _finish(steps: list[Step], unit: str, sensor: str, out: Path, console: Console) -> None:
    calibration = solve(steps, unit, sensor, datetime.now(UTC).replace(microsecond=0))
    write_calibration(calibration, out)
    print_report(calibration, out, console)


def _take_recording(step: Step, text: str) -> None:
    named = any(text.startswith(f"{kind.scheme}:") for kind in SOURCES)
    with closing(open_source(text if named else f"recording:{text}")) as source:
        try:
            take(step, source.batches())
        except UserError as error:
            raise UserError(f"{text}: {error}") from error


def _guided(
    has_magnetometer: bool, with_warm_up: bool, batches: Iterator[SensorBatch], console: Console
) -> list[Step]:
    steps: list[Step] = [StillStep(), PosesStep()]
    if has_magnetometer:
        steps.append(TurningStep())
    if with_warm_up:
        steps.append(WarmUpStep())
    for number, step in enumerate(steps, start=1):
        console.print(f"[bold]{number} of {len(steps)}: {step.name}.[/] {step.instruction}")
        limit_s = _WARM_UP_LIMIT_S if isinstance(step, WarmUpStep) else _LIMIT_S
        with console.status("waiting for samples") as status:
            run_step(step, batches, limit_s, status.update)
        console.print(f"   done: {step.progress()}")
    return steps


def _played(batches: Iterator[SensorBatch], speed: float) -> Iterator[SensorBatch]:
    pacer = Pacer(speed)
    for batch in batches:
        if len(batch.imu):
            first_ns, last_ns = int(batch.imu.t_ns[0]), int(batch.imu.t_ns[-1])
            due_ns = pacer.place(first_ns, last_ns, time.monotonic_ns()).to_mono_ns(last_ns)
            time.sleep(max(0.0, (due_ns - time.monotonic_ns()) / NS_PER_S))
        yield batch
