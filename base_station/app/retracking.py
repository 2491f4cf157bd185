"""Tracks raw recordings again, each in a process of the agent's program, as many at a time as there
are cores.  A recording that was tracked with the same settings before is not tracked again.
"""

from __future__ import annotations

import hashlib
import os
import subprocess
import sys
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor, as_completed
from importlib.metadata import version
from pathlib import Path
from threading import Event
from typing import NamedTuple

from base_station.replay.rerun.black_boxes import BlackBoxBoot
from shared.errors import UserError
from shared.mcap_log import segment_paths

_ONE_THREAD = {"OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}  # each has a core


class RetrackSettings(NamedTuple):
    """Settings of a re-run; empty: as the unit had them."""

    tracker: str = ""
    calibration: Path | None = None
    settings: tuple[str, ...] = ()

    @property
    def options(self) -> list[str]:
        """Options of ``muster edge retrack``."""
        options = ["--tracker", self.tracker] if self.tracker else []
        if self.calibration is not None:
            options += ["--calibration", str(self.calibration)]
        return [*options, *(part for one in self.settings for part in ("--set", one))]


class Retracking(NamedTuple):
    """One recording, and the positions a second that its unit sent."""

    boot: BlackBoxBoot
    rate_hz: float


class Retracker:
    """Writes the logs of the results into a folder, from which it goes on."""

    def __init__(self, folder: Path, settings: RetrackSettings) -> None:
        self._folder = folder
        self._settings = settings
        self._done_ns: dict[Path, int] = {}  # by boot: of its recording
        self._stopped = Event()
        self._processes: set[subprocess.Popen[str]] = set()

    def track(
        self, wanted: Sequence[Retracking], on_progress: Callable[[float], None]
    ) -> Iterator[tuple[BlackBoxBoot, Path]]:
        """Yield each recording with its log as it is done.

        Raises UserError, with the reason, where one cannot be tracked; the others are ended then.
        """
        self._folder.mkdir(parents=True, exist_ok=True)
        total_ns = sum(_duration_ns(one.boot) for one in wanted)
        with ThreadPoolExecutor(os.cpu_count() or 1) as pool:
            by_size = sorted(wanted, key=lambda one: -one.boot.size_bytes)  # the longest first
            running = {
                pool.submit(self._track, one, total_ns, on_progress): one.boot for one in by_size
            }
            try:
                for future in as_completed(running):
                    yield running[future], future.result()
            finally:
                self._stopped.set()
                for process in list(self._processes):
                    process.terminate()

    def _track(
        self, wanted: Retracking, total_ns: int, on_progress: Callable[[float], None]
    ) -> Path:
        boot = wanted.boot
        out = self._folder / f"{boot.unit_id}-{boot.boot_id:016x}-{self._digest(wanted)}"
        if not out.is_dir() and not self._stopped.is_set():
            self._run(wanted, out, total_ns, on_progress)
        self._note(boot, _duration_ns(boot), total_ns, on_progress)
        return out

    def _run(
        self,
        wanted: Retracking,
        out: Path,
        total_ns: int,
        on_progress: Callable[[float], None],
    ) -> None:
        boot = wanted.boot
        command = [sys.executable, "-m", "shared.command_line", "edge", "retrack", str(boot.path)]
        command += ["--out", str(out), "--rate-hz", str(wanted.rate_hz), *self._settings.options]
        with subprocess.Popen(
            command,
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
            env={**os.environ, **_ONE_THREAD},
        ) as process:
            self._processes.add(process)
            assert process.stdout is not None
            for line in process.stdout:
                if line.strip().isdecimal():
                    self._note(boot, int(line) - boot.from_ns, total_ns, on_progress)
            assert process.stderr is not None
            error_text = process.stderr.read().strip()
            process.wait()
        self._processes.discard(process)
        if process.returncode:
            reason = error_text.splitlines()[-1] if error_text else "it was ended"
            raise UserError(
                f"the recording {boot.path} cannot be tracked: {reason.removeprefix('muster: ')}"
            )

    def _note(
        self,
        boot: BlackBoxBoot,
        done_ns: int,
        total_ns: int,
        on_progress: Callable[[float], None],
    ) -> None:
        self._done_ns[boot.path] = done_ns
        on_progress(min(sum(list(self._done_ns.values())) / max(total_ns, 1), 1.0))

    def _digest(self, wanted: Retracking) -> str:
        """Return the digest of everything that the result depends on."""
        digest = hashlib.sha256(version("muster").encode())
        digest.update(repr((wanted.rate_hz, self._settings.tracker)).encode())
        digest.update(repr(self._settings.settings).encode())
        if self._settings.calibration is not None:
            digest.update(self._settings.calibration.read_bytes())
        for segment in segment_paths(wanted.boot.path):
            state = segment.stat()
            digest.update(repr((segment.name, state.st_size, state.st_mtime_ns)).encode())
        return digest.hexdigest()[:16]


def _duration_ns(boot: BlackBoxBoot) -> int:
    return max(boot.until_ns - boot.from_ns, 1)
