"""A station that starts on a disk that takes nothing: live, with people who log in, and whole again
when there is room.
"""

from __future__ import annotations

from collections.abc import Callable
from contextlib import AbstractContextManager, ExitStack
from pathlib import Path

import pytest

from tests.rig.damaged_database import spoil_table
from tests.rig.full_disk import disk_of_its_own, filled, read_only
from tests.rig.served_station import MakePosition, greet, prepare, snapshot
from tests.rig.station_command import Browser, Command, Unit
from tests.rig.station_process import free_port
from tests.rig.waiting import until


def problems(browser: Browser) -> str:
    return "; ".join(browser.call("GET", "/health")["problems"])


def test_a_station_starts_on_a_full_disk_and_on_one_that_can_only_be_read(
    tmp_path: Path, make_position: MakePosition
) -> None:
    with disk_of_its_own(tmp_path, 30) as disk, ExitStack() as closing:
        data, port = disk / "station", free_port()
        listens = ("--listen", f"tcp/127.0.0.1:{port}", "--http", "127.0.0.1:0")
        serve = ("serve", "--data", str(data), *listens)
        with Command(tmp_path / "first.txt", *serve) as station:
            station.wait_ready()  # killed, with all that a kill leaves torn
        with filled(disk):
            station = closing.enter_context(Command(tmp_path / "full.txt", *serve))
            browser = closing.enter_context(Browser(station.wait_ready(), data))
            unit = Unit(port, "FF-01")
            closing.callback(unit.close)
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
            read_only(disk),
            Command(tmp_path / "failed.txt", *serve) as again,
            Browser(again.wait_ready(), data) as anew,  # nobody has to have been logged in
        ):
            assert [one["name"] for one in anew.call("GET", "/incidents")] == ["Kitchen"]
            assert [one["name"] for one in anew.call("GET", "/people")] == ["Ada"]
            assert anew.call("GET", "/units")[0]["last_heard_ms"], "what came is in the log"
            until(lambda: "kept in memory" in problems(anew))


def damaged_copies(data: Path) -> list[bytes]:
    return [one.read_bytes() for one in data.glob("station.sqlite.damaged-*Z")]


@pytest.mark.parametrize("takes_nothing", [filled, read_only])
def test_a_damaged_database_on_a_disk_that_takes_nothing_is_made_again_in_memory(
    tmp_path: Path,
    make_position: MakePosition,
    takes_nothing: Callable[[Path], AbstractContextManager[None]],
) -> None:
    with disk_of_its_own(tmp_path, 30) as disk, ExitStack() as closing:
        data, port = disk / "station", free_port()
        listens = ("--listen", f"tcp/127.0.0.1:{port}", "--http", "127.0.0.1:0")
        serve = ("serve", "--data", str(data), *listens)
        with Command(tmp_path / "first.txt", *serve) as station:
            with Browser(station.wait_ready(), data) as browser:
                prepare(browser)
            station.stop()
        spoil_table(data / "station.sqlite", "incidents")
        damaged = (data / "station.sqlite").read_bytes()
        with takes_nothing(disk):
            station = closing.enter_context(Command(tmp_path / "full.txt", *serve))
            browser = closing.enter_context(Browser(station.wait_ready(), data))
            unit = Unit(port, "FF-01")
            closing.callback(unit.close)
            greet(browser, unit, make_position)
            for sentence in ("was damaged (incidents: ", "users and people were kept"):
                assert sentence in problems(browser)
            assert "The database is kept in memory" in problems(browser)
            assert [one["name"] for one in browser.call("GET", "/incidents")] == ["Kitchen"]
            assert [one["name"] for one in browser.call("GET", "/people")] == ["Ada"]
            assert (data / "station.sqlite").read_bytes() == damaged
            assert damaged_copies(data) == []
        until(lambda: "kept in memory" not in problems(browser), "the database is written")
        assert damaged_copies(data) == [damaged]
        station.kill()
        with (
            Command(tmp_path / "again.txt", *serve) as again,
            Browser(again.wait_ready(), data) as anew,
        ):
            assert [one["name"] for one in anew.call("GET", "/incidents")] == ["Kitchen"]
            assert [one["name"] for one in anew.call("GET", "/people")] == ["Ada"]
            until(lambda: "was damaged" not in problems(anew), "it is whole, and says so")
