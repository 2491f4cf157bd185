"""Chips of hwmon: several inputs, several chips, faults, and the machine's own."""

from __future__ import annotations

from pathlib import Path

import pytest

from edge.sources.polled_device import Unreadable
from edge.sources.temperature.hwmon import HwmonSensor
from edge.sources.temperature.interface import SensorRole
from shared.errors import ConfigError
from tests.rig.kernel_devices import SysfsTree


@pytest.fixture
def tree(tmp_path: Path) -> SysfsTree:
    return SysfsTree(tmp_path / "sys")


def read(
    tree: SysfsTree, text: str, role: SensorRole = SensorRole.ENVIRONMENT
) -> float | Unreadable:
    return HwmonSensor(text, role, tree.root).read_degc()


def reason(found: float | Unreadable) -> str:
    assert isinstance(found, Unreadable)
    return found.reason


def test_an_input_is_chosen_by_its_label_or_its_number(tree: SysfsTree) -> None:
    tree.hwmon(
        4,
        name="ltc2983",
        temp1_input="1000",
        temp2_input="2000",
        temp2_label="helmet",
        in1_input="9",
    )
    assert read(tree, "ltc2983/temp1") == pytest.approx(1.0)
    assert read(tree, "ltc2983/helmet") == pytest.approx(2.0)
    assert reason(read(tree, "ltc2983")) == (
        "ltc2983 has 2 temperatures; there are ltc2983/helmet, ltc2983/temp1"
    )
    assert "has no input chest" in reason(read(tree, "ltc2983/chest"))


def test_chips_of_one_name_are_distinguished_by_their_address(tree: SysfsTree) -> None:
    tree.hwmon(0, "1-0048", name="tmp102", temp1_input="1000")
    tree.hwmon(1, "1-0049", name="tmp102", temp1_input="2000")
    assert "tmp102@1-0048, tmp102@1-0049" in reason(read(tree, "tmp102"))
    assert read(tree, "tmp102@1-0049") == pytest.approx(2.0)
    assert "there is no hwmon chip named tmp102@1-0050" in reason(read(tree, "tmp102@1-0050"))


def test_a_fault_that_the_chip_reports_is_no_heat(tree: SysfsTree) -> None:
    tree.hwmon(0, name="lm90", temp1_input="127000", temp1_fault="1")
    assert "open circuit or short" in reason(read(tree, "lm90"))
    tree.hwmon(0, name="lm90", temp1_fault="0")
    assert read(tree, "lm90") == pytest.approx(127.0)


@pytest.mark.parametrize(
    "name", ["coretemp", "k10temp", "cpu_thermal", "soc_thermal", "acpitz", "nvme", "rp1_adc"]
)
def test_the_machine_itself_is_refused_as_the_air_and_read_when_asked_for(
    tree: SysfsTree, name: str
) -> None:
    tree.hwmon(0, name=name, temp1_input="48000")
    with pytest.raises(ConfigError, match="not the air around it"):
        read(tree, name)
    assert read(tree, name, SensorRole.ELECTRONICS) == pytest.approx(48.0)


def test_a_thermal_zone_of_any_name_is_the_machine_itself(tree: SysfsTree) -> None:
    tree.hwmon(0, "thermal_zone3", name="skin", temp1_input="48000")
    assert "not the air around it" in reason(read(tree, "skin"))
    assert read(tree, "skin", SensorRole.ELECTRONICS) == pytest.approx(48.0)


@pytest.mark.parametrize(
    "name", ["tmp102", "sht3x", "max31722", "lm75", "ltc2983", "w1_slave_temp"]
)
def test_sensors_of_the_air_are_not_taken_for_the_machine(tree: SysfsTree, name: str) -> None:
    tree.hwmon(0, name=name, temp1_input="20000")
    assert read(tree, name) == pytest.approx(20.0)
