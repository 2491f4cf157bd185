"""The battery of the unit's computer, as drivers of the kernel show it."""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from edge.samples import BatterySample
from edge.sources.power_supply import BatteryReader
from shared.clock import SystemClock
from shared.errors import ConfigError
from shared.messages import BatteryState
from tests.rig.kernel_devices import SysfsTree, break_attribute
from tests.rig.waiting import until

Opened = Callable[[str], BatteryReader]


@pytest.fixture
def tree(tmp_path: Path) -> SysfsTree:
    return SysfsTree(tmp_path / "sys")


@pytest.fixture
def opened(tree: SysfsTree) -> Iterator[Opened]:
    readers: list[BatteryReader] = []

    def opened(name: str) -> BatteryReader:
        reader = BatteryReader(name, SystemClock(), tree.root)
        readers.append(reader)
        reader.start()
        return reader

    yield opened
    for reader in readers:
        reader.close()


def taken(reader: BatteryReader) -> BatterySample:
    found: deque[BatterySample] = deque(maxlen=1)

    def has_come() -> bool:
        found.extend(reader.take())
        return len(found) > 0

    until(has_come, "a reading")
    assert reader.take_faults() == ()
    return found[0]


def fault(reader: BatteryReader) -> str:
    found: list[str] = []

    def has_come() -> bool:
        found.extend(reader.take_faults())
        return len(found) > 0

    until(has_come, "a fault")
    assert reader.take() == ()
    return found[0]


@pytest.mark.parametrize(
    ("attributes", "level", "left_s", "state"),
    [
        ({"capacity": "42", "status": "Full"}, 0.42, None, BatteryState.FULL),
        ({"capacity": "42", "status": "Not charging"}, 0.42, None, BatteryState.FULL),
        ({"capacity": "42"}, 0.42, None, BatteryState.UNKNOWN),
        (
            {"capacity": "42", "status": "Charging", "time_to_empty_now": "60"},
            *(0.42, None, BatteryState.CHARGING),
        ),
        (
            {"capacity": "42", "status": "Discharging", "time_to_empty_avg": "5400"},
            *(0.42, 5400.0, BatteryState.DISCHARGING),
        ),
        (
            {"charge_now": "1500000", "charge_full": "3000000", "current_now": "-500000"}
            | {"status": "Discharging"},
            *(0.5, 3 * 3600.0, BatteryState.DISCHARGING),
        ),
        (
            {"energy_now": "9000000", "energy_full": "12000000", "power_now": "4500000"}
            | {"status": "Discharging"},
            *(0.75, 2 * 3600.0, BatteryState.DISCHARGING),
        ),
        (
            {"capacity": "90", "status": "Discharging", "charge_now": "9", "current_now": "0"},
            *(0.9, None, BatteryState.DISCHARGING),
        ),
    ],
)
def test_level_time_left_and_state(tree, opened, attributes, level, left_s, state) -> None:
    tree.power_supply("BAT0", type="Battery", **attributes)
    found = taken(opened("BAT0"))
    assert found.level == pytest.approx(level)
    assert (found.state, found.battery) == (state, "BAT0")
    assert math.isnan(found.left_s) if left_s is None else found.left_s == pytest.approx(left_s)


def test_the_one_battery_of_the_machine_is_found(tree, opened) -> None:
    tree.power_supply("AC", type="Mains", online="1")
    tree.power_supply("hid-mouse", type="Battery", scope="Device", capacity="3")
    tree.power_supply("max17048", type="Battery", capacity="77")
    assert taken(opened("auto")).level == pytest.approx(0.77)


def test_two_batteries_have_to_be_distinguished(tree, opened) -> None:
    for name in ("BAT0", "BAT1"):
        tree.power_supply(name, type="Battery", capacity="50")
    assert "there are 2 batteries; name one of BAT0, BAT1" in fault(opened("auto"))


@pytest.mark.parametrize(
    ("name", "attributes", "reported"),
    [
        ("BAT1", {"type": "Battery", "capacity": "50"}, "batteries are BAT0"),
        ("BAT0", {"type": "Mains"}, "there is none at all"),
        ("auto", {"type": "Mains"}, "no battery that the kernel shows"),
        ("BAT0", {"type": "Battery", "capacity": "50", "present": "0"}, "no battery is inserted"),
        ("BAT0", {"type": "Battery", "capacity": "250"}, "no charge between 0 and 100 %"),
        ("BAT0", {"type": "Battery", "capacity": "half"}, "no charge between 0 and 100 %"),
        ("BAT0", {"type": "Battery"}, "no charge between 0 and 100 %"),
    ],
)
def test_a_battery_that_cannot_be_read_is_a_fault(tree, opened, name, attributes, reported) -> None:
    tree.power_supply("BAT0", **attributes)
    assert reported in fault(opened(name))


def test_a_fuel_gauge_that_does_not_answer(tree, opened) -> None:
    break_attribute(tree.power_supply("BAT0", type="Battery"), "capacity")
    assert "it does not answer" in fault(opened("BAT0"))


def test_a_name_that_leads_elsewhere_is_refused(tree) -> None:
    with pytest.raises(ConfigError, match="no name of a power supply"):
        BatteryReader("../../etc", SystemClock(), tree.root)
