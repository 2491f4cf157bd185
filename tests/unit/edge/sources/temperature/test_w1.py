"""1-wire sensors: values that are no temperature, and kernels without ``temperature``."""

from __future__ import annotations

from pathlib import Path

import pytest

from edge.sources.polled_device import Unreadable
from edge.sources.temperature.interface import SensorRole
from edge.sources.temperature.w1 import W1Sensor
from tests.rig.kernel_devices import SysfsTree

ID = "28-0316a2794faa"


@pytest.fixture
def tree(tmp_path: Path) -> SysfsTree:
    return SysfsTree(tmp_path / "sys")


def read_each(tree: SysfsTree, *milli_degc: str) -> list[float | Unreadable]:
    sensor = W1Sensor(ID, SensorRole.ENVIRONMENT, tree.root)
    found = []
    for text in milli_degc:
        tree.w1(ID, temperature=text)
        found.append(sensor.read_degc())
    return found


def test_the_value_before_it_has_measured_is_no_heat(tree: SysfsTree) -> None:
    (found,) = read_each(tree, "85000")
    assert isinstance(found, Unreadable)
    assert "85 °C" in found.reason


def test_eighty_five_degrees_are_believed_where_they_are_reached(tree: SysfsTree) -> None:
    assert read_each(tree, "82000", "85000", "85062") == pytest.approx([82.0, 85.0, 85.062])


def test_a_supply_that_fails_in_the_cold_is_no_heat(tree: SysfsTree) -> None:
    _, found, again = read_each(tree, "21000", "85000", "85000")
    assert isinstance(found, Unreadable)
    assert isinstance(again, Unreadable)


def test_the_value_of_a_supply_that_is_too_weak_is_no_heat(tree: SysfsTree) -> None:
    (found,) = read_each(tree, "127937")
    assert isinstance(found, Unreadable)
    assert "supply" in found.reason


@pytest.mark.parametrize(("checksum", "expected"), [("YES", 23.187), ("NO", None)])
def test_an_older_kernel_shows_a_checksum(tree: SysfsTree, checksum, expected) -> None:
    tree.w1(
        ID,
        w1_slave=f"73 01 4b 46 7f ff 0d 10 41 : crc=41 {checksum}\n"
        "73 01 4b 46 7f ff 0d 10 41 t=23187",
    )
    found = W1Sensor(ID, SensorRole.ENVIRONMENT, tree.root).read_degc()
    if expected is None:
        assert isinstance(found, Unreadable)
        assert "garbled" in found.reason
    else:
        assert found == pytest.approx(expected)


def test_unfinished_conversion_gives_no_temperature(tree: SysfsTree) -> None:
    (found,) = read_each(tree, "")
    assert isinstance(found, Unreadable)
