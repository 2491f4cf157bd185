"""A station whose disk hangs shows and commands people all the same, reports it, and loses
nothing.
"""

from __future__ import annotations

import os
import signal
from collections.abc import Iterator
from contextlib import ExitStack
from pathlib import Path

import httpx
import psutil
import pytest

from tests.rig.hanging_disk import disk_that_can_hang, frozen
from tests.rig.served_station import MakePosition, Served, served_station
from tests.rig.station_command import Command
from tests.rig.waiting import PATIENCE_S, until
from tests.rig.watched_walk import Walk, logged, login, post

HANGS = "does not answer"
NOT_KEPT = "records are not safely in the log"
ENDING_S = 10.0  # of the 30 s after which its service kills it
BUSY_S = 5.0  # that a busy machine may take


@pytest.fixture
def disk(tmp_path: Path) -> Iterator[Path]:
    with disk_that_can_hang(tmp_path, size_mb=128) as place:
        yield place


@pytest.fixture
def served(disk: Path, tmp_path: Path, make_position: MakePosition) -> Iterator[Served]:
    with served_station(disk / "station", tmp_path / "output.txt", make_position) as served:
        yield served


def test_station_with_a_hanging_disk_continues_and_loses_nothing(
    disk: Path, served: Served
) -> None:
    station, browser, unit, data, _ = served
    with ExitStack() as walking:
        walk = Walk(browser, unit, walking)
        until(lambda: walk.shown > 5)
        with frozen(disk):
            until(lambda: any(HANGS in one for one in walk.problems), "it is told")
            refused = login(browser, data)
            assert (refused.status_code, HANGS in refused.json()["detail"]) == (503, True)
            assert httpx.get(browser.address, timeout=PATIENCE_S).is_success
            walk.press_mayday()
            until(lambda: walk.alarms.get("mayday") == "raised", "mayday is raised")
            everybody_out = {"kind": "evacuate", "target": {"everyone": True}}
            assert post(browser, "/commands", everybody_out, browser.cookie()).is_success
            mayday = walk.seen["mayday"]
            acknowledge = f"/alarms/{mayday['alarm_id']}/acknowledge"
            as_seen = {"last_raised_ms": mayday["last_raised_ms"]}
            assert post(browser, acknowledge, as_seen, browser.cookie()).is_success
            par = {"target": {"everyone": True}}
            assert post(browser, "/check-ins", par, browser.cookie()).is_success
            until(lambda: walk.alarms.get("mayday") == "acknowledged")
            shown = walk.shown
            until(lambda: walk.shown > shown + 20, "the picture goes on")
        until(lambda: not any(HANGS in one for one in walk.problems), "it is over")
        assert login(browser, data).is_success
    assert station.stop() == 0
    there = logged(data / "log")
    assert len(there) == len(set(there))
    assert walk.stated <= set(there)


def test_station_with_a_hanging_disk_stops_and_reports_the_loss(
    disk: Path, served: Served, tmp_path: Path
) -> None:
    """Its service would kill it in the end, and nobody would hear what the log lacks."""
    station, browser, unit, data, flags = served
    (router,) = psutil.Process(station.pid).children()
    with ExitStack() as walking:
        walk = Walk(browser, unit, walking)
        until(lambda: walk.shown > 5)
        with frozen(disk):
            until(lambda: any(HANGS in one for one in walk.problems), "it is told")
            os.kill(station.pid, signal.SIGTERM)
            until(lambda: NOT_KEPT in station.output(), "what is not kept", ENDING_S)
            until(lambda: not router.is_running(), "the end of the bus", BUSY_S)
            with pytest.raises(httpx.ConnectError):
                httpx.get(browser.address, timeout=PATIENCE_S)
    assert station.wait() == 1  # in the kernel it ends when the disk answers
    with Command(tmp_path / "again.txt", *flags) as again:
        again.wait_ready()
        assert again.stop() == 0
    there = logged(data / "log")
    assert len(there) > 0
    assert len(there) == len(set(there))
