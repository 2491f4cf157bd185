"""A machine's clock for programs that a test starts: their UTC can be set while they run."""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from unittest import mock

# Python runs it first in every program that finds it on its path.
_SITE = """
import os, time
_utc_ns, _file, _read = time.time_ns, os.environ["MUSTER_TEST_CLOCK"], [0.0, 0]
def _ahead_ns():
    if time.monotonic() - _read[0] > 0.05:
        with open(_file) as said:
            _read[:] = time.monotonic(), int(said.read())
    return _read[1]
time.time_ns = lambda: _utc_ns() + _ahead_ns()
time.time = lambda: time.time_ns() / 1e9
"""


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
        path = os.pathsep.join(filter(None, (str(self._site), os.environ.get("PYTHONPATH"))))
        with mock.patch.dict(os.environ, PYTHONPATH=path, MUSTER_TEST_CLOCK=str(self._file)):
            yield
