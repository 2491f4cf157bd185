"""Thermocouple converters of IIO: scale and offset, channels, open circuits and shorts."""

from __future__ import annotations

import errno
from pathlib import Path

import pytest

from edge.sources.polled_device import Unreadable
from edge.sources.temperature import iio
from edge.sources.temperature.iio import IioSensor
from edge.sources.temperature.interface import SensorRole
from tests.rig.kernel_devices import SysfsTree

MAX31856 = {
    "name": "max31856",
    "in_temp_raw": "3200",
    "in_temp_scale": "7.812500",
    "in_temp_ambient_raw": "1600",
    "in_temp_ambient_scale": "15.625000",
    "fault_oc": "0",
    "fault_ovuv": "0",
}


@pytest.fixture
def tree(tmp_path: Path) -> SysfsTree:
    return SysfsTree(tmp_path / "sys")


def read(
    tree: SysfsTree, text: str, role: SensorRole = SensorRole.ENVIRONMENT
) -> float | Unreadable:
    return IioSensor(text, role, tree.root).read_degc()


def reason(found: float | Unreadable) -> str:
    assert isinstance(found, Unreadable)
    return found.reason


def test_the_thermocouple_is_meant_and_not_its_cold_junction(tree: SysfsTree) -> None:
    tree.iio(0, **MAX31856)
    assert read(tree, "max31856") == pytest.approx(25.0)
    assert read(tree, "max31856/ambient", SensorRole.ELECTRONICS) == pytest.approx(25.0)


def test_the_hottest_that_it_measures(tree: SysfsTree) -> None:
    tree.iio(0, **MAX31856 | {"in_temp_raw": f"{round(1250 / 0.0078125)}"})
    assert read(tree, "max31856") == pytest.approx(1250.0)


@pytest.mark.parametrize(
    ("attribute", "reported"), [("fault_oc", "open circuit"), ("fault_ovuv", "short circuit")]
)
def test_an_open_circuit_and_a_short_are_distinguished_from_heat(tree, attribute, reported) -> None:
    tree.iio(0, **MAX31856 | {attribute: "1", "in_temp_raw": "200000"})
    assert reason(read(tree, "max31856")).startswith(reported)


def test_a_max31855_that_refuses_its_reading_is_open_or_shorted(tree, monkeypatch) -> None:
    tree.iio(0, name="maxim_thermocouple", in_temp_raw="4", in_temp_scale="250")

    def refused(device: Path, *_: object, **__: object) -> float:
        raise OSError(errno.EINVAL, "Invalid argument", str(device))

    monkeypatch.setattr(iio, "read_scaled", refused)
    assert "open circuit or short" in reason(read(tree, "maxim_thermocouple"))


def test_an_offset_is_added_before_the_scale(tree: SysfsTree) -> None:
    tree.iio(0, name="lm35", in_temp_raw="100", in_temp_offset="-50", in_temp_scale="10")
    assert read(tree, "lm35") == pytest.approx(0.5)


def test_processed_value_is_in_thousandths_of_a_degree(tree: SysfsTree) -> None:
    tree.iio(0, name="tmp006", in_temp_input="26500")
    assert read(tree, "tmp006") == pytest.approx(26.5)


def test_frost_on_an_mcp9600(tree: SysfsTree) -> None:
    """Its driver hands over the register of 16 bits without its sign."""
    tree.iio(0, name="mcp9600", in_temp_raw=f"{2**16 - 80}", in_temp_scale="62.500000")
    assert read(tree, "mcp9600") == pytest.approx(-5.0)


def test_one_of_several_channels_is_chosen_by_its_name(tree: SysfsTree) -> None:
    device = {"name": "ltc2983", "in_temp_scale": "1"}
    tree.iio(0, **device, in_temp0_raw="1000", in_temp1_raw="2000")
    assert read(tree, "ltc2983/1") == pytest.approx(2.0)
    assert "ltc2983/0, ltc2983/1" in reason(read(tree, "ltc2983"))
    assert "has no temperature 2" in reason(read(tree, "ltc2983/2"))


def test_converters_of_one_name_are_distinguished_by_their_address(tree: SysfsTree) -> None:
    tree.iio(0, "spi0.0", **MAX31856)
    tree.iio(1, "spi0.1", **MAX31856 | {"in_temp_raw": "6400"})
    assert "max31856@spi0.0, max31856@spi0.1" in reason(read(tree, "max31856"))
    assert read(tree, "max31856@spi0.1") == pytest.approx(50.0)
