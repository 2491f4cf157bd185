"""A whole unit for ``muster bench sensor``: every kind of sensor that the kernel shows, a button
and an output, beside a station with a console.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from contextlib import ExitStack, closing, contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from threading import Event, Thread

import numpy as np

from deploy.demo.panel_button import PanelButton
from tests.rig.device_requests import DeviceRequests
from tests.rig.iio_device import BMI160, EmulatedIio, Raw
from tests.rig.kernel_devices import EmulatedAgent, SysfsTree, write_attributes
from tests.rig.shown_unit import ShownUnit
from tests.rig.station_command import Browser, Command
from tests.rig.station_process import free_port
from tests.rig.waiting import PATIENCE_S, until

UNIT = "FF-01"
RATE_HZ = 400.0
_CHANGES_S = 0.05  # between two values of the slow sensors
_POLL_S = 0.002
_STEPS_DEGC = (20.0, 80.0)  # back and forth
_APART_S = 1.7  # between two steps: not in time with anything that has a period of its own

Walk = Callable[[int], Raw]


@dataclass(frozen=True, slots=True)
class WholeUnitFigures:
    cores: float = float("nan")  # share of one that the agent takes
    temperature_s: list[float] = field(default_factory=list)  # from a step to the console


def measure_whole_unit(seconds: float, steps: int, machine: Path, walk: Walk) -> WholeUnitFigures:
    """Measure the agent's processor time for some seconds, then temperature steps."""
    with _whole_unit(machine, walk) as (agent, shown, thermocouple):
        until(lambda: shown.card.get("ambient_sensors"), "the temperatures on the console")
        until(lambda: "check at the start" in agent.output(), "the end of the check at the start")
        begun_s, spent_s = time.monotonic(), agent.cpu_s()
        time.sleep(seconds)
        cores = (agent.cpu_s() - spent_s) / (time.monotonic() - begun_s)
        took_s = [_step(shown, thermocouple, _STEPS_DEGC[k % 2]) for k in range(steps)]
    return WholeUnitFigures(cores, took_s)


def _step(shown: ShownUnit, thermocouple: Path, degc: float) -> float:
    """Return the time until the console shows a step of the temperature."""
    begun_s = time.monotonic()
    write_attributes(thermocouple, {"in_temp_raw": f"{degc * 128:.0f}"})
    while shown.card["ambient_degc"] != degc:
        if time.monotonic() - begun_s > PATIENCE_S:
            raise TimeoutError("a temperature was not shown")
        time.sleep(_POLL_S)
    took_s = time.monotonic() - begun_s
    time.sleep(_APART_S)
    return took_s


@contextmanager
def _whole_unit(machine: Path, walk: Walk) -> Iterator[tuple[EmulatedAgent, ShownUnit, Path]]:
    port = free_port()
    with ExitStack() as stack:
        listen = ("--listen", f"tcp/127.0.0.1:{port}", "--http", "127.0.0.1:0")
        data = machine / "station"
        station = stack.enter_context(
            Command(machine / "station.txt", "serve", "--data", str(data), *listen)
        )
        browser = stack.enter_context(Browser(station.wait_ready(), data))
        browser.call("POST", "/units", json={"unit_id": UNIT, "label": UNIT})
        shown = stack.enter_context(closing(ShownUnit(browser, UNIT)))
        tree = SysfsTree(machine / "sys")
        stack.enter_context(closing(DeviceRequests(machine, "iio:device0")))
        stack.enter_context(closing(EmulatedIio(tree, machine / "dev", BMI160, values=walk)))
        thermocouple = stack.enter_context(_slow_sensors(tree))
        button = PanelButton(machine / "button")
        stack.callback(button.unplug)
        agent = stack.enter_context(
            EmulatedAgent(machine, machine / "agent.txt", *_flags(machine, port))
        )
        yield agent, shown, thermocouple


def _flags(machine: Path, port: int) -> tuple[str, ...]:
    return (
        *("--unit", UNIT, "--source", "iio:bmi160?mag=lis3mdl&pressure=lps22hb"),
        *("--temperature", "iio:max31856?name=front", "--temperature", "w1:28-000000000001"),
        *("--temperature", "hwmon:tmp102?name=case&role=electronics", "--battery", "BAT0"),
        *("--button", f"socket:{machine / 'button'}", "--output", "led:helmet"),
        *("--output", f"terminal:{UNIT}", "--data", f"{machine}/edge"),
        *("--connect", f"tcp/127.0.0.1:{port}"),
    )


@contextmanager
def _slow_sensors(tree: SysfsTree) -> Iterator[Path]:
    """Emulate what is read more rarely, with values that change; give the thermocouple's folder."""
    mag = tree.iio(3, "1-001e", name="lis3mdl", in_magn_scale="0.000146")
    air = tree.iio(4, "1-005d", name="lps22hb", in_pressure_scale="0.000024414")
    thermocouple = tree.iio(
        5, "spi0.1", name="max31856", in_temp_raw="2560", in_temp_scale="7.8125"
    )
    case = tree.hwmon(0, name="tmp102", temp1_input="31250")
    helmet = tree.w1("28-000000000001", temperature="19500")
    tree.power_supply("BAT0", type="Battery", capacity="84", status="Discharging")
    tree.led("helmet", trigger="none", brightness="0", max_brightness="255")
    stop = Event()

    def change() -> None:
        k = 0
        while not stop.wait(_CHANGES_S):
            k += 1
            x, y = np.rint(3000 * np.array([np.cos(k / 40), np.sin(k / 40)])).astype(int)
            field = {"in_magn_x_raw": x, "in_magn_y_raw": y, "in_magn_z_raw": -2740 + k % 3}
            write_attributes(mag, {name: str(value) for name, value in field.items()})
            write_attributes(air, {"in_pressure_raw": str(4_150_272 + 40 * (k % 7))})
            write_attributes(case, {"temp1_input": str(31_000 + k % 500)})
            write_attributes(helmet, {"temperature": str(19_000 + k % 500)})

    thread = Thread(target=change, daemon=True)
    thread.start()
    try:
        yield thermocouple
    finally:
        stop.set()
        thread.join()
