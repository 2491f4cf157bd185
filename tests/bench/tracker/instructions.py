"""``muster bench instructions``: instructions of a sample, independent of the machine's load.

Times on a shared machine say little; the number of instructions is the same to a hundredth of
a per cent wherever it is counted.  Valgrind's callgrind counts those of one fixed simulated
walk, for two lengths of it: the difference is the tracker's alone.  The kernels are compiled
for the plainest x86-64, which every machine has and valgrind knows.
"""

from __future__ import annotations

import re
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import fields
from pathlib import Path
from threading import Timer
from typing import Annotated, Any

import numpy as np
import typer
from numpy.typing import NDArray

from edge.samples import ImuBatch
from edge.simulation.factory import open_simulation
from edge.tracker.registry import TRACKERS
from shared.errors import UserError

WALK = "square-60m?seed=0"
LENGTHS = (2_000, 6_000)  # samples: ten seconds and thirty, most of it walking
_PLAIN = ("env", "NUMBA_CPU_NAME=generic", "NUMBA_CPU_FEATURES=", "PYTHONHASHSEED=0")
_LONGEST_S = 900.0  # beside other work; alone it takes a minute
_CONTROL = "callgrind_control"


class CannotCountError(UserError):
    """This machine has no means to count instructions."""


def bench_instructions(
    tracker: Annotated[
        str, typer.Option(help="One of: " + ", ".join(entry.name for entry in TRACKERS) + ".")
    ] = TRACKERS[0].name,
) -> None:
    """Measure the instructions that a sample takes (with valgrind; skipped where it is missing)."""
    try:
        count = count_instructions(tracker)
    except CannotCountError as error:
        typer.echo(f"instructions a sample: skipped, {error}")
        return
    typer.echo(f"instructions a sample ({tracker}, {WALK}, plain x86-64): {count:,.0f}")


def count_instructions(tracker: str) -> float:
    """Return the instructions a sample of ``WALK``; ``CannotCountError`` where that cannot be."""
    for tool in ("valgrind", _CONTROL):
        if shutil.which(tool) is None:
            raise CannotCountError(f"{tool} is not installed (Debian: apt-get install valgrind)")
    with tempfile.TemporaryDirectory() as folder:
        samples = Path(folder) / "samples.npz"
        np.savez(samples, allow_pickle=False, **_columns(_walk(LENGTHS[-1])))
        probe = (
            sys.executable,
            "-m",
            "tests.bench.tracker.instruction_probe",
            tracker,
            str(samples),
        )
        with _probing((*_PLAIN, *probe)) as native:  # compiles, so that valgrind need not
            _track(native, LENGTHS[0])
        counts = _counts(probe, Path(folder) / "counts")
    return (counts[1] - counts[0]) / (LENGTHS[1] - LENGTHS[0])


def _walk(count: int) -> ImuBatch:
    batches = open_simulation(WALK).batches(count / 200.0)
    return next(batches).imu.part(slice(0, count))


def _columns(imu: ImuBatch) -> dict[str, NDArray[Any]]:
    return {field.name: getattr(imu, field.name) for field in fields(imu)}


def _counts(probe: tuple[str, ...], out: Path) -> list[int]:
    valgrind = ("valgrind", "-q", "--tool=callgrind", "--instr-atstart=no")
    with _probing((*_PLAIN, *valgrind, f"--callgrind-out-file={out}", *probe)) as process:
        _track(process, LENGTHS[0])  # what happens once has happened
        _control(process, "--instr=on")
        for length in LENGTHS:
            _track(process, length)
            _control(process, "--dump")
        _control(process, "--instr=off")
    dumps = [out.with_name(f"{out.name}.{number}") for number in (1, 2)]
    return [_total(dump.read_text()) for dump in dumps]


@contextmanager
def _probing(command: tuple[str, ...]) -> Iterator[subprocess.Popen[str]]:
    pipe = subprocess.PIPE
    with subprocess.Popen(command, stdin=pipe, stdout=pipe, text=True) as process:
        # Were nothing cached, valgrind would compile for hours.
        late = Timer(_LONGEST_S, process.kill)
        late.start()
        try:
            _receive(process, "ready")
            yield process
            assert process.stdin is not None
            process.stdin.close()
            process.wait()
        finally:
            late.cancel()
            process.kill()


def _track(process: subprocess.Popen[str], count: int) -> None:
    assert process.stdin is not None
    try:
        process.stdin.write(f"{count}\n")
        process.stdin.flush()
    except BrokenPipeError:
        raise CannotCountError("the counted process ended") from None
    _receive(process, "done")


def _receive(process: subprocess.Popen[str], word: str) -> None:
    assert process.stdout is not None
    reported = process.stdout.readline().strip()
    if reported != word:
        raise CannotCountError(
            f"the counted process said '{reported}' instead of '{word}'"
            if reported
            else "the counted process ended, or took too long"
        )


def _control(process: subprocess.Popen[str], order: str) -> None:
    command = (_CONTROL, order, str(process.pid))
    try:
        done = subprocess.run(command, capture_output=True, text=True, timeout=60.0, check=False)
        reached = done.returncode == 0 and "OK" in done.stdout
    except subprocess.TimeoutExpired:
        reached = False
    if not reached:
        raise CannotCountError(f"{_CONTROL} cannot reach the counted process here")


def _total(dump: str) -> int:
    found = re.search(r"^totals: (\d+)", dump, flags=re.MULTILINE)
    if found is None:
        raise CannotCountError("callgrind wrote no total")
    return int(found[1])
