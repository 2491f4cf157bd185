"""A machine's clock for programs that a test starts: their UTC can be set while they run."""

from __future__ import annotations

import os
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from unittest import mock

_PROJECT = Path(__file__).resolve().parents[2]
_FILE = "MUSTER_TEST_CLOCK"
_READ_EACH_S = 0.05
# Python runs it first in every program that finds it on its path.
_SITE = "from tests.rig.settable_clock import go_by_machine_clock\ngo_by_machine_clock()\n"


_true_utc_ns, _true_utc_s = time.time_ns, time.time


def go_by_machine_clock() -> None:
    """This program's UTC is that of the ``MachineClock`` under which it was started, if any."""
    time.time_ns, time.time = _true_utc_ns, _true_utc_s
    if (file := os.environ.get(_FILE)) is None:
        return
    read_s, ahead_ns = 0.0, 0

    def utc_ns() -> int:
        nonlocal read_s, ahead_ns
        if time.monotonic() - read_s > _READ_EACH_S:
            read_s, ahead_ns = time.monotonic(), int(Path(file).read_text())
        return _true_utc_ns() + ahead_ns

    time.time_ns = utc_ns
    time.time = lambda: utc_ns() / 1e9


class MachineClock:
    """``with clock.ticks():`` around the start of whatever is to go by it."""

    def __init__(self, folder: Path, name: str) -> None:
        self._file = folder / f"{name}.clock"
        self._site = folder / "site"
        self._site.mkdir(exist_ok=True)
        (self._site / "sitecustomize.py").write_text(_SITE)
        self.set_ahead(0.0)

    def set_ahead(self, by_s: float) -> None:
        new = self._file.with_suffix(".new")
        new.write_text(str(round(by_s * 1e9)))
        new.replace(self._file)

    @contextmanager
    def ticks(self) -> Iterator[None]:
        path = (str(self._site), str(_PROJECT), os.environ.get("PYTHONPATH", ""))
        changed = {"PYTHONPATH": os.pathsep.join(filter(None, path)), _FILE: str(self._file)}
        with mock.patch.dict(os.environ, changed):
            yield
