"""Fixtures for tests of every kind."""

from __future__ import annotations

import fcntl
import gc
import hashlib
import itertools
import os
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from hypothesis import settings

from edge.storage.journal.journal import Journal
from edge.storage.journal.writer import JournalWriter
from shared.clock import ManualClock
from shared.header_factory import HeaderFactory
from shared.messages import Position
from tests.rig import message_factory
from tests.rig.module_order import by_turns

PROJECT_ROOT = Path(__file__).resolve().parent.parent

# How long an example takes says how busy the machine is.
settings.register_profile("muster", deadline=None)
settings.load_profile("muster")
settings.register_profile("quick", deadline=None, max_examples=20)  # ./muster test --quick


@pytest.fixture(autouse=True)
def usual_umask() -> Iterator[None]:
    """Commands that run in this process set another one for the rest of it."""
    before = os.umask(0o022)
    yield
    os.umask(before)


def pytest_collection() -> None:
    """Leave the garbage for later: all that is loaded stays, and a fifth of the time goes to it."""
    gc.disable()


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Take modules by turns, and first those that take longest: else all others would wait for
    them at the end.
    """
    modules = dict.fromkeys(item.path for item in items)
    places = {module: n for n, module in enumerate(by_turns(modules, Path(__file__).parent))}
    items.sort(key=lambda item: (item.get_closest_marker("begun_first") is None, places[item.path]))


def pytest_collection_finish(session: pytest.Session) -> None:
    """Compile the trackers before the first test: its time is limited, and this may take a minute.

    Once after each change of them; of tests side by side the first process does it for all.
    ``./muster`` has done it before it starts the tests.
    """
    gc.freeze()
    gc.enable()
    if session.config.option.collectonly or not session.items:
        return
    if "MUSTER_KERNELS_COMPILED" in os.environ:
        return
    digest = hashlib.sha256()
    for path in sorted((PROJECT_ROOT / "edge" / "tracker").glob("**/*.py")):
        digest.update(path.read_bytes())
    folder = PROJECT_ROOT / "build"
    folder.mkdir(exist_ok=True)
    with (folder / "trackers.sha256").open("a+") as stamp:
        fcntl.flock(stamp, fcntl.LOCK_EX)
        stamp.seek(0)
        if stamp.read() == digest.hexdigest():
            return
        command = [sys.executable, "-m", "shared.command_line", "edge", "compile", "--one-process"]
        if subprocess.run(command, cwd=PROJECT_ROOT, check=False).returncode == 0:  # else tests say
            stamp.truncate(0)
            stamp.write(digest.hexdigest())


@pytest.fixture
def journal(tmp_path: Path) -> Iterator[Journal]:
    """A unit's journal, with room for everything."""
    journal = Journal(tmp_path / "journal.sqlite", itertools.count(1).__next__, 0, 10**9)
    yield journal
    journal.close()


@pytest.fixture
def journal_writer(journal: Journal) -> Iterator[JournalWriter]:
    journal_writer = JournalWriter(journal)
    yield journal_writer
    journal_writer.close()


def _recorded(name: str) -> Path:
    data = Path(os.environ.get("MUSTER_DATA", PROJECT_ROOT.parent / "shared" / "data"))
    folder = data / name
    if not folder.is_dir():
        pytest.skip(
            f"no recorded walks in {data} (set MUSTER_DATA to the folder that holds '{name}')"
        )
    return folder


@pytest.fixture(scope="session")
def walks() -> Path:
    """The folder of recorded walks; the test is skipped where it is not there."""
    return _recorded("walks")


@pytest.fixture(scope="session")
def hard_walks(walks: Path) -> Path:
    """The folder of those that are hard to track, beside ``walks``; skipped likewise."""
    return _recorded("hard")


@pytest.fixture(scope="session")
def worn_elsewhere() -> tuple[Path, ...]:
    """Folders of recordings on lower backs (with both feet) and of telephones; skipped likewise."""
    return _recorded("body"), _recorded("phones")


@pytest.fixture
def clock() -> ManualClock:
    return ManualClock()


@pytest.fixture
def header_factory(clock: ManualClock) -> HeaderFactory:
    """Headers of a unit called FF-01."""
    return HeaderFactory("FF-01", boot_id=0xB007, clock=clock)


@pytest.fixture
def make_position(header_factory: HeaderFactory) -> Callable[..., Position]:
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
        return message_factory.position(header_factory.header(), **{**usual, **changes})

    return make
