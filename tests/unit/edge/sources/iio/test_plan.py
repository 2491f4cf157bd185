"""Settings of a device: rates and ranges of those that its driver offers."""

from __future__ import annotations

import math
from pathlib import Path

import pytest

from edge.sources.iio.attributes import UnusableDeviceError
from edge.sources.iio.conversion import ACCEL, GYRO
from edge.sources.iio.plan import least_reaching, nearest, plan_capture, plan_polling
from tests.rig.kernel_devices import SysfsTree, write_attributes

LSM6DSO = "12.500 26.000 52.000 104.000 208.000 416.000 833.000"
ICM42688 = "12.500000 25.000000 50.000000 100.000000 200.000000 1000.000000 2000.000000"


@pytest.fixture
def tree(tmp_path: Path) -> SysfsTree:
    return SysfsTree(tmp_path / "sys")


def accelerometer(tree: SysfsTree, **attributes: str) -> Path:
    device = tree.iio(0, name="a", in_accel_x_raw="0", in_accel_scale="0.000598", **attributes)
    write_attributes(device / "scan_elements", {"in_accel_x_type": "le:s16/16>>0"})
    return device


def written(plan) -> dict[str, str]:
    return {path.name: text for path, text in plan.writes}


@pytest.mark.parametrize(
    ("offered", "wanted", "chosen"),
    [
        (LSM6DSO, 400.0, "416.000"),
        (ICM42688, 400.0, "200.000000"),
        ("100", 400.0, "100"),
        ("[25 25 1600]", 410.0, "400"),
        ("[0.5 0 100]", 400.0, "0.5"),
        ("[50 0.5 100]", 20.0, "50"),
    ],
)
def test_the_nearest_rate_is_chosen_by_ratio(offered: str, wanted: float, chosen: str) -> None:
    assert nearest(offered, wanted) == chosen


def test_the_least_that_reaches_and_the_greatest_where_none_does() -> None:
    assert least_reaching("4 1 2", 1.5) == "2"
    assert least_reaching("4 1 2", math.inf) == "4"


@pytest.mark.parametrize("offered", ["", "fast slow", "0 100", "nan", "[1 2]"])
def test_an_offer_that_cannot_be_read_is_refused(offered: str) -> None:
    with pytest.raises(UnusableDeviceError, match="it offers"):
        nearest(offered, 400.0)


def test_a_rate_that_is_not_offered_is_stated_with_those_that_are(tree: SysfsTree) -> None:
    device = accelerometer(tree, sampling_frequency="26.000", sampling_frequency_available=LSM6DSO)
    plan = plan_capture(device, (ACCEL,), 300.0)
    assert plan.rate_hz == 416.0
    assert f"it offers no 300 samples a second but {LSM6DSO}" in plan.remark
    assert "write ?rate=416" in plan.remark


@pytest.mark.parametrize("asked_hz", [None, 416.0, 415.0])
def test_a_rate_that_is_offered_or_not_asked_for_needs_no_remark(tree, asked_hz) -> None:
    device = accelerometer(tree, sampling_frequency="26.000", sampling_frequency_available=LSM6DSO)
    plan = plan_capture(device, (ACCEL,), asked_hz)
    assert (plan.rate_hz, plan.remark) == (416.0, "")
    assert written(plan) == {"sampling_frequency": "416.000"}


def test_a_driver_without_a_choice_gives_the_rate_that_it_has(tree: SysfsTree) -> None:
    plan = plan_capture(accelerometer(tree, sampling_frequency="119"), (ACCEL,), None)
    assert (plan.rate_hz, plan.writes) == (119.0, ())


def test_both_kinds_of_a_device_are_set_where_their_rates_are_apart(tree: SysfsTree) -> None:
    device = accelerometer(
        tree,
        in_accel_sampling_frequency="100",
        in_accel_sampling_frequency_available="100 400",
        in_anglvel_sampling_frequency="100",
        in_anglvel_sampling_frequency_available="100 400 800",
    )
    plan = plan_capture(device, (ACCEL, GYRO), None)
    assert written(plan) == {
        "in_accel_sampling_frequency": "400",
        "in_anglvel_sampling_frequency": "400",
    }


@pytest.mark.parametrize(
    ("offered", "chosen", "full_scale"),
    [
        ("0.000598 0.001197 0.002394 0.004788", "0.004788", 156.9),  # BMI160
        ("0.000598 0.004788 0.009577", "0.004788", 156.9),  # one of 32 g
        ("0.000598 0.001197", "0.001197", 39.2),
    ],
)
def test_the_range_is_the_least_that_holds_steps(tree, offered, chosen, full_scale) -> None:
    device = accelerometer(tree, in_accel_scale_available=offered)
    plan = plan_capture(device, (ACCEL,), None)
    assert written(plan) == {"in_accel_scale": chosen}
    assert plan.full_scales[ACCEL] == pytest.approx(full_scale, rel=1e-3)


def test_range_without_a_known_sample_width_is_the_widest(tree: SysfsTree) -> None:
    device = tree.iio(0, name="a", in_accel_scale="1", in_accel_scale_available="1 4 2")
    plan = plan_polling(device, (ACCEL,), 100.0)
    assert (written(plan), plan.full_scales) == ({"in_accel_scale": "4"}, {})


def test_a_device_that_is_polled_measures_more_often_than_it_is_read(tree: SysfsTree) -> None:
    device = accelerometer(tree, sampling_frequency="26.000", sampling_frequency_available=LSM6DSO)
    plan = plan_polling(device, (ACCEL,), 100.0)
    assert (plan.rate_hz, written(plan)) == (100.0, {"sampling_frequency": "208.000"})
