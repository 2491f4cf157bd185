"""A station that starts on a full disk is live, lets users log in, and is complete when there is
room.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, ExitStack
from pathlib import Path

import pytest

from tests.rig.damaged_database import spoil_table
from tests.rig.full_disk import disk_of_its_own, filled, read_only
from tests.rig.served_station import MakePosition, greet, prepare, snapshot
from tests.rig.station_command import Browser, Command, Unit
from tests.rig.station_process import free_port
from tests.rig.waiting import until


class SmallDisk:
    """Folder of a station on a small disk of its own."""

    def __init__(self, folder: Path, disk: Path, closing: ExitStack) -> None:
        self.disk, self.data, self.closing = disk, disk / "station", closing
        self._folder, self._port = folder, free_port()

    def serve(self, output: str) -> Command:
        """A station there; ``output``: name of the file of what it prints."""
        listens = ("--listen", f"tcp/127.0.0.1:{self._port}", "--http", "127.0.0.1:0")
        return Command(self._folder / output, "serve", "--data", str(self.data), *listens)

    def connect(self, station: Command) -> tuple[Browser, Unit]:
        """A browser and a unit at it, until the end of the test."""
        browser = self.closing.enter_context(Browser(station.wait_ready(), self.data))
        unit = Unit(self._port, "FF-01")
        self.closing.callback(unit.close)
        return browser, unit


@pytest.fixture
def small(tmp_path: Path) -> Iterator[SmallDisk]:
    with disk_of_its_own(tmp_path, 30) as disk, ExitStack() as closing:
        yield SmallDisk(tmp_path, disk, closing)


def problems(browser: Browser) -> str:
    return "; ".join(browser.call("GET", "/health")["problems"])


def test_station_starts_on_a_full_or_read_only_disk(
    small: SmallDisk, make_position: MakePosition
) -> None:
    with small.serve("first.txt") as station:
        station.wait_ready()  # killed, with all that a kill leaves torn
    with filled(small.disk):
        station = small.closing.enter_context(small.serve("full.txt"))
        browser, unit = small.connect(station)
        prepare(browser)
        greet(browser, unit, make_position)
        until(lambda: "log cannot be written" in problems(browser))
        assert "The database is kept in memory" in problems(browser)
        alarms = [one["text"] for one in snapshot(browser)["alarms"]]
        assert any("kept in memory" in text for text in alarms), alarms
    until(lambda: "kept in memory" not in problems(browser), "the database is written")
    until(lambda: "log cannot be written" not in problems(browser), "the log is written")
    station.kill()
    with (
        read_only(small.disk),
        small.serve("failed.txt") as again,
        Browser(again.wait_ready(), small.data) as anew,  # nobody has to have been logged in
    ):
        assert [one["name"] for one in anew.call("GET", "/incidents")] == ["Kitchen"]
        assert [one["name"] for one in anew.call("GET", "/people")] == ["Ada"]
        assert anew.call("GET", "/units")[0]["last_heard_ms"], "what came is in the log"
        until(lambda: "kept in memory" in problems(anew))


def damaged_copies(data: Path) -> list[bytes]:
    return [one.read_bytes() for one in data.glob("station.sqlite.damaged-*Z")]


@pytest.mark.parametrize("takes_nothing", [filled, read_only])
def test_damaged_database_on_a_full_disk_is_rebuilt_in_memory(
    small: SmallDisk,
    make_position: MakePosition,
    takes_nothing: Callable[[Path], AbstractContextManager[None]],
) -> None:
    with small.serve("first.txt") as station:
        with Browser(station.wait_ready(), small.data) as browser:
            prepare(browser)
        station.stop()
    spoil_table(small.data / "station.sqlite", "incidents")
    damaged = (small.data / "station.sqlite").read_bytes()
    with takes_nothing(small.disk):
        station = small.closing.enter_context(small.serve("full.txt"))
        browser, unit = small.connect(station)
        greet(browser, unit, make_position)
        for sentence in ("was damaged (incidents: ", "users and people were kept"):
            assert sentence in problems(browser)
        assert "The database is kept in memory" in problems(browser)
        assert [one["name"] for one in browser.call("GET", "/incidents")] == ["Kitchen"]
        assert [one["name"] for one in browser.call("GET", "/people")] == ["Ada"]
        assert (small.data / "station.sqlite").read_bytes() == damaged
        assert damaged_copies(small.data) == []
    until(lambda: "kept in memory" not in problems(browser), "the database is written")
    assert damaged_copies(small.data) == [damaged]
    station.kill()
    with (
        small.serve("again.txt") as again,
        Browser(again.wait_ready(), small.data) as anew,
    ):
        assert [one["name"] for one in anew.call("GET", "/incidents")] == ["Kitchen"]
        assert [one["name"] for one in anew.call("GET", "/people")] == ["Ada"]
        until(lambda: "was damaged" not in problems(anew), "it is whole, and says so")
