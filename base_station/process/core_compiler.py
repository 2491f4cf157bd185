"""Makes machine code of the core's modules with Cython and the machine's C compiler."""

from __future__ import annotations

import os
import shlex
import shutil
import subprocess
import sys
import sysconfig
from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor, as_completed
from pathlib import Path
from tempfile import TemporaryDirectory

from base_station.process.compiled_core import is_whole, machine_code_of, sealed, source_of
from base_station.process.core_modules import CORE_MODULES
from shared.errors import UserError

# The very same as Python does: annotations are no C types.
_CYTHON = ("-3", "-X", "annotation_typing=False", "-X", "binding=True")
# And the very same numbers: no product and sum are rounded in one.
_C = ("-O2", "-g0", "-fPIC", "-shared", "-fwrapv", "-fno-strict-aliasing", "-ffp-contract=off")
_TAIL_LINES = 15


def compile_core(folder: Path, on_progress: Callable[[float], None]) -> int:
    """Compile what is not there whole, or of another source; gives how many modules that were.

    Raises UserError where this machine cannot, or the folder cannot be written.
    """
    compiler = _c_compiler()
    wanted = {name: machine_code_of(name, folder) for name in CORE_MODULES}
    core = wanted[CORE_MODULES[0]].parent
    core.mkdir(parents=True, exist_ok=True)
    due = [name for name, made in wanted.items() if not is_whole(made)]
    with (
        TemporaryDirectory(dir=core) as work,  # so that what is made is there at once
        ThreadPoolExecutor(os.cpu_count()) as pool,
    ):
        making = [pool.submit(_compile, compiler, name, wanted[name], Path(work)) for name in due]
        try:
            for done, one in enumerate(as_completed(making), 1):
                one.result()
                on_progress(done / len(making))
        except BaseException:
            pool.shutdown(cancel_futures=True)
            raise
    for made in {one for one in core.iterdir() if one.is_file()} - set(wanted.values()):
        made.unlink(missing_ok=True)  # of sources that are no more
    return len(due)


def _c_compiler() -> Sequence[str]:
    known = shlex.split(str(sysconfig.get_config_var("CC") or ""))
    for command in (known[:1], ["cc"], ["gcc"], ["clang"]):
        if command and shutil.which(command[0]):
            break
    else:
        raise UserError(
            "there is no C compiler here. The station runs without; for the third that it would "
            "save install one (Debian: apt-get install gcc python3-dev) and compile again"
        )
    headers = Path(sysconfig.get_path("include"))
    if not (headers / "Python.h").is_file():
        raise UserError(
            f"Python's headers are not in {headers}. The station runs without; for the third "
            "that they would save install them (Debian: apt-get install python3-dev) and "
            "compile again"
        )
    return [*command, *_C, f"-I{headers}"]


def _compile(compiler: Sequence[str], name: str, made: Path, work: Path) -> None:
    source, written, built = source_of(name), work / f"{name}.c", work / made.name
    cython = [sys.executable, "-m", "cython", *_CYTHON, "--module-name", name]
    _run(name, [*cython, str(source), "-o", str(written)], work)
    _run(name, [*compiler, "-w", str(written), "-o", str(built)], work)
    written.unlink()
    built.write_bytes(sealed(built.read_bytes()))
    built.replace(made)


def _run(name: str, command: Sequence[str], folder: Path) -> None:
    done = subprocess.run(
        command,
        cwd=folder,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        check=False,
    )
    if done.returncode != 0:
        tail = "\n".join(done.stdout.splitlines()[-_TAIL_LINES:])
        raise UserError(f"{name} could not be compiled, and runs as it is; it was said:\n{tail}")
