"""An agent started as by a person, on an emulated machine with devices of the kernel."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from contextlib import closing
from pathlib import Path

import pytest

from tests.rig.kernel_devices import EmulatedAgent, SysfsTree, has_umockdev, write_attributes
from tests.rig.shown_unit import ShownUnit
from tests.rig.station_command import Browser, Command
from tests.rig.waiting import until

pytestmark = pytest.mark.skipif(
    not has_umockdev(), reason="no umockdev on this machine: install the package umockdev"
)
STEP_TO_CONSOLE_S = 2.0
MAX31856 = {"name": "max31856", "in_temp_scale": "7.812500", "fault_oc": "0", "fault_ovuv": "0"}


@pytest.fixture
def tree(tmp_path: Path) -> SysfsTree:
    return SysfsTree(tmp_path / "machine" / "sys")


@pytest.fixture
def shown(serve: Callable[..., Command], data: Path) -> Iterator[ShownUnit]:
    with Browser(serve().wait_ready(), data) as browser:
        browser.call("POST", "/units", json={"unit_id": "u1", "label": "u1"})
        with closing(ShownUnit(browser, "u1")) as shown:
            yield shown


@pytest.fixture
def started(tree: SysfsTree, port: int, tmp_path: Path) -> Callable[..., EmulatedAgent]:
    def started(*flags: str) -> EmulatedAgent:
        where = ("--data", str(tmp_path / "edge"), "--connect", f"tcp/127.0.0.1:{port}")
        of = ("--unit", "u1", "--source", "bench:5")
        return EmulatedAgent(tree.root.parent, tmp_path / "agent.txt", *of, *flags, *where)

    return started


def flags_of(*sensors: str) -> list[str]:
    return [flag for text in sensors for flag in ("--temperature", text)]


def test_temperatures_reach_the_console(tree, shown, started) -> None:
    front = tree.iio(0, **MAX31856, in_temp_raw="3200")
    tree.hwmon(0, name="tmp102", temp1_input="31250")
    tree.power_supply(
        "BAT0", type="Battery", capacity="42", status="Discharging", time_to_empty_now="5400"
    )
    sensors = ("iio:max31856?name=front", "hwmon:tmp102?name=case&role=electronics")
    with started(*flags_of(*sensors, "w1:28-000000000001"), "--battery", "auto") as agent:
        until(lambda: shown.card.get("ambient_degc") == 25.0, "the thermocouple")
        assert shown.card["ambient_sensors"] == [{"name": "front", "temperature_degc": 25.0}]
        electronics = [{"name": "case", "temperature_degc": 31.25}]
        until(lambda: shown.card["status"]["electronics"] == electronics, "the electronics")
        status = shown.card["status"]
        assert (status["battery"], status["battery_left_s"]) == (0.42, 5400)
        assert status["battery_state"] == "discharging"
        assert "there is no 1-wire sensor 28-000000000001" in agent.output()

        latencies_s = []
        for degc in (120.0, 1250.0, -40.0):
            begun_s = time.monotonic()
            write_attributes(front, {"in_temp_raw": f"{degc / 0.0078125:.0f}"})
            until(lambda degc=degc: shown.card["ambient_degc"] == degc, "a step")  # type: ignore[misc]
            latencies_s.append(time.monotonic() - begun_s)
        assert min(latencies_s) < STEP_TO_CONSOLE_S, latencies_s

        write_attributes(front, {"fault_oc": "1", "in_temp_raw": "200000"})
        until(lambda: "open circuit" in str(shown.alarms), "the alarm of the broken thermocouple")
        assert shown.card["ambient_degc"] == -40.0
        assert agent.stop() == 0
