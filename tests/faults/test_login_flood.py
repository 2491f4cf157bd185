"""Clients that try passwords or hold connections keep no user from evacuating, viewing or logging
in.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from pathlib import Path
from statistics import median

import httpx
import pytest

from tests.rig.login_flood import Flood, LoginFlood, guesses, slow_bodies
from tests.rig.served_station import prepare
from tests.rig.station_command import Browser, CommandOfCostlyLogins
from tests.rig.station_process import free_port
from tests.rig.waiting import PATIENCE_S

# Without limits half of them take ten seconds and more, and all wait for a minute.
MEDIAN_S, MOST_S = 2.0, 10.0
QUIET_MEDIAN_S = 0.1  # without a flood, at most: where it takes longer the machine is busy
ASKED = 12
MOST_GUESSES_PER_S = 10.0  # one worker checks passwords, each for a tenth of a second or more
FLOODS: dict[str, tuple[Flood, int]] = {
    "many names from 8 addresses": (guesses(0.05), 8),
    "many names from 120 addresses": (guesses(1.0), 120),
    "one name from 40 addresses": (guesses(0.5, "admin"), 40),
    "slow bodies from 12 addresses": (slow_bodies(120), 12),
}


def took_s(ask: Callable[[], object]) -> float:
    begun_s = time.monotonic()
    ask()
    return time.monotonic() - begun_s


def asked_times_s(console: Browser) -> list[float]:
    """Response times of evacuations and of requests of the station's health."""
    evacuation = {"kind": "evacuate", "target": {"unit_id": "FF-01"}, "expires_s": 1.0}
    asked = [
        took_s(lambda: console.call("POST", "/commands", json=evacuation)) for _ in range(ASKED)
    ]
    return asked + [took_s(lambda: console.call("GET", "/health")) for _ in range(ASKED)]


def log_in(console: Browser, data: Path) -> None:
    """With a connection of its own, as one more tab of the same person."""
    text = (data / "first-login.txt").read_text()
    credentials = dict(line.split(": ", 1) for line in text.splitlines())
    with httpx.Client(headers={"Origin": console.address}, timeout=PATIENCE_S) as tab:
        answer = tab.post(f"{console.address}/api/v1/login", json=credentials)
        assert answer.status_code == 200, answer.text


@pytest.fixture
def console(tmp_path: Path) -> Iterator[Browser]:
    """A commander's, at a station with an open incident."""
    data = tmp_path / "station"
    flags = ("--data", str(data), "--listen", f"tcp/127.0.0.1:{free_port()}")
    arguments = ("serve", *flags, "--http", "127.0.0.1:0")
    with CommandOfCostlyLogins(tmp_path / "output.txt", *arguments) as station:
        with Browser(station.wait_ready(), data) as browser:
            prepare(browser)
            yield browser
        station.stop()


def test_login_flood_delays_no_user(console: Browser, tmp_path: Path) -> None:
    port = httpx.URL(console.address).port or 0
    times_longer = max(1.0, median(asked_times_s(console)) / QUIET_MEDIAN_S)
    for name, (flood, places) in FLOODS.items():
        begun_s = time.monotonic()
        with LoginFlood(port, flood, places=places) as flooding:
            time.sleep(1.0)  # until it is in full swing
            asked = asked_times_s(console)
            log_in(console, tmp_path / "station")
        assert median(asked) < MEDIAN_S * times_longer, (name, asked)
        assert max(asked) < MOST_S * times_longer, (name, asked)
        most_guessed = MOST_GUESSES_PER_S * (time.monotonic() - begun_s)
        assert flooding.statuses["401"] <= most_guessed, (name, flooding.statuses)
        assert "200" not in flooding.statuses
