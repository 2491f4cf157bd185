"""What tests of every kind share."""

from __future__ import annotations

import fcntl
import hashlib
import itertools
import os
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from hypothesis import settings

from base_station.bench.rig import said
from edge.journal.spool import Spool
from edge.journal.writer import JournalWriter
from shared.clock import ManualClock
from shared.envelope import Stamper
from shared.messages import Position

PROJECT_ROOT = Path(__file__).resolve().parent.parent

# How long an example takes says how busy the machine is.
settings.register_profile("muster", deadline=None)
settings.load_profile("muster")


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Else all others would wait at the end for the ones that take longest."""
    items.sort(key=lambda item: item.get_closest_marker("begun_first") is None)


def pytest_collection_finish(session: pytest.Session) -> None:
    """Compile the trackers before the first test: its time is limited, and this may take a minute.

    Once after each change of them; of tests side by side the first process does it for all.
    """
    if session.config.option.collectonly or not session.items:
        return
    digest = hashlib.sha256()
    for path in sorted((PROJECT_ROOT / "edge" / "tracker").glob("*.py")):
        digest.update(path.read_bytes())
    folder = PROJECT_ROOT / "build"
    folder.mkdir(exist_ok=True)
    with (folder / "trackers.sha256").open("a+") as stamp:
        fcntl.flock(stamp, fcntl.LOCK_EX)
        stamp.seek(0)
        if stamp.read() == digest.hexdigest():
            return
        command = [sys.executable, "-m", "shared.command_line", "edge", "compile"]
        if subprocess.run(command, cwd=PROJECT_ROOT, check=False).returncode == 0:  # else tests say
            stamp.truncate(0)
            stamp.write(digest.hexdigest())


@pytest.fixture
def spool(tmp_path: Path) -> Iterator[Spool]:
    """A unit's journal, with room for everything."""
    spool = Spool(tmp_path / "journal.sqlite", itertools.count(1).__next__, 0, 10**9)
    yield spool
    spool.close()


@pytest.fixture
def journal(spool: Spool) -> Iterator[JournalWriter]:
    journal = JournalWriter(spool)
    yield journal
    journal.close()


@pytest.fixture(scope="session")
def walks() -> Path:
    """The folder of recorded walks; the test is skipped where it is not there."""
    data = Path(os.environ.get("MUSTER_DATA", PROJECT_ROOT.parent / "shared" / "data"))
    folder = data / "walks"
    if not folder.is_dir():
        pytest.skip(
            f"no recorded walks in {data} (set MUSTER_DATA to the folder that holds 'walks')"
        )
    return folder


@pytest.fixture
def clock() -> ManualClock:
    return ManualClock()


@pytest.fixture
def stamper(clock: ManualClock) -> Stamper:
    """Headers of a unit called FF-01."""
    return Stamper("FF-01", boot_id=0xB007, clock=clock)


@pytest.fixture
def make_position(stamper: Stamper) -> Callable[..., Position]:
    """A plausible position of FF-01; keyword arguments replace fields."""

    def make(**changes: object) -> Position:
        usual: dict[str, object] = {
            "north_m": 1.0,
            "east_m": 2.0,
            "down_m": -3.0,
            "velocity_north_mps": 0.1,
            "velocity_east_mps": 0.2,
            "std_down_m": 0.2,
            "heading_rad": 0.5,
            "distance_m": 12.3,
            "stationary": True,
        }
        return said.position(stamper.header(), **{**usual, **changes})

    return make
