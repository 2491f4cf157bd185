"""A station whose clock is set by a day while it runs, and is wrong when it starts."""

from __future__ import annotations

import time
from collections.abc import Iterator
from contextlib import ExitStack
from itertools import pairwise
from pathlib import Path
from typing import Any

import pytest

from shared.clock import NS_PER_S
from shared.mcap_log import read_log
from shared.messages import Temperature
from tests.rig.settable_clock import MachineClock
from tests.rig.station_command import Browser, Command, Unit
from tests.rig.station_process import free_port
from tests.rig.waiting import until

DAY_S = 86_400.0


class ClockScene:
    """A station, a unit that somebody wears in an open incident, and a console."""

    def __init__(self, folder: Path, closing: ExitStack) -> None:
        self.data, self._folder, self._closing = folder / "data", folder, closing
        self.clock = MachineClock(folder, "station")
        self._port, self._http = free_port(), free_port()
        self.start()
        self.browser = closing.enter_context(Browser(f"http://127.0.0.1:{self._http}", self.data))
        self.unit = Unit(self._port, "anna")
        closing.callback(self.unit.close)

    def start(self) -> None:
        arguments = ["serve", "--data", str(self.data), "--listen", f"tcp/127.0.0.1:{self._port}"]
        arguments += ["--http", f"127.0.0.1:{self._http}"]
        with self.clock.ticks():
            self.station = self._closing.enter_context(
                Command(self._folder / "said.txt", *arguments)
            )
        self.station.wait_ready()

    def dress(self) -> None:
        person = self.browser.call("POST", "/people", json={"name": "Anna", "crew": "A"})
        self.browser.call("POST", "/units", json={"unit_id": "anna", "label": "1"})
        wears = {"unit_id": "anna", "person_id": person["person_id"]}
        self.browser.call("POST", "/assignments", json=wears)
        incident = self.browser.call("POST", "/incidents", json={"name": "Mill Lane"})
        self.incident_id: str = incident["incident_id"]

    def say(self) -> None:
        self.unit.say(Temperature(self.unit.header_factory.header(), 21.0))

    def problem_stated(self, words: str) -> bool:
        self.say()
        problems: list[str] = self.browser.call("GET", "/health")["problems"]
        return any(words in problem for problem in problems)

    def alarms(self) -> list[tuple[str, str]]:
        alarms: list[dict[str, Any]] = self.browser.call("GET", "/alarms")
        return [(alarm["rule"], alarm["text"]) for alarm in alarms]

    def times_ns(self) -> list[int]:
        return [t_ns for t_ns, _, _ in read_log(self.data / "log")]


@pytest.fixture
def ground(tmp_path: Path) -> Iterator[ClockScene]:
    with ExitStack() as closing:
        yield ClockScene(tmp_path, closing)


def test_clock_set_during_an_incident_raises_no_link_alarm_and_ends_no_login(
    ground: ClockScene,
) -> None:
    ground.dress()
    until(lambda: ground.problem_stated("plain TCP"), "the unit is heard")
    ground.clock.set_ahead(DAY_S)
    until(lambda: ground.problem_stated("24 hours ahead"), "a clock set forward is said")
    assert ground.alarms() == []
    ground.clock.set_ahead(-DAY_S)
    until(lambda: ground.problem_stated("24 hours behind"), "a clock set back is said")
    ground.station.kill()
    ground.clock.set_ahead(-time.time())  # no battery: it starts in 1970
    ground.start()
    until(lambda: ground.problem_stated("days behind"), "a clock that is not set is said")
    assert not [rule for rule, _ in ground.alarms() if rule != "link-lost"]
    ground.clock.set_ahead(0.0)
    assert ground.browser.close_incident(ground.incident_id) == 204  # now it may leap
    until(lambda: not ground.problem_stated("This machine"), "a clock set right is no problem")
    ground.station.stop()
    times_ns = ground.times_ns()
    assert all(one <= following for one, following in pairwise(times_ns))
    assert times_ns[-1] - times_ns[0] < DAY_S / 24 * NS_PER_S
