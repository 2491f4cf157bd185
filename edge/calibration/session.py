"""One calibration from its first step to the file."""

from __future__ import annotations

from collections.abc import Mapping
from contextlib import closing
from datetime import UTC, datetime
from pathlib import Path

from rich.console import Console

from edge.calibration.file import write_calibration
from edge.calibration.guide import guide, solve, take
from edge.calibration.report import print_report
from edge.calibration.steps import PosesStep, Step, StillStep, TurningStep, WarmUpStep
from edge.sources import SOURCES, open_source
from shared.errors import UserError

_LIMIT_S = 600.0
_WARM_UP_LIMIT_S = 3600.0


def calibrate_guided(
    source: str, out: Path, unit: str, sensor: str | None, *, with_warm_up: bool
) -> None:
    """Guide a person through the steps with samples from ``source``."""
    console = _console()
    steps, name = _guided(source, with_warm_up, console)
    _finish(steps, unit, name if sensor is None else sensor, out, console)


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


def _guided(text: str, with_warm_up: bool, console: Console) -> tuple[list[Step], str]:
    with closing(open_source(text)) as source:
        steps: list[Step] = [StillStep(), PosesStep()]
        if source.description.mag_present:
            steps.append(TurningStep())
        if with_warm_up:
            steps.append(WarmUpStep())
        batches = source.batches()
        for number, step in enumerate(steps, start=1):
            console.print(f"[bold]{number} of {len(steps)}: {step.name}.[/] {step.instruction}")
            limit_s = _WARM_UP_LIMIT_S if isinstance(step, WarmUpStep) else _LIMIT_S
            with console.status("waiting for samples") as status:
                guide(step, batches, limit_s, status.update)
            console.print(f"   done: {step.progress()}")
        return steps, source.description.name
