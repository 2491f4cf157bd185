"""Quantities of each kind of source: declared, delivered, and listed in docs/concepts.md."""

from __future__ import annotations

import re
from collections.abc import Iterable
from contextlib import closing
from itertools import islice
from pathlib import Path

import pytest

from edge.samples import (
    ACKNOWLEDGE,
    AmbientSample,
    BatterySample,
    ButtonPress,
    ElectronicsSample,
    GpsSample,
    SensorBatch,
    SightingSample,
)
from edge.sources.iio.source import IioSource
from edge.sources.interface import Quantity
from edge.sources.registry import SOURCES, open_source
from tests.conftest import PROJECT_ROOT
from tests.rig.iio_device import ICM_ACCEL, ICM_GYRO, EmulatedIio
from tests.rig.kernel_devices import SysfsTree
from tests.rig.ximu3_device import TcpDevice, at_rest, text_message

CONCEPTS = PROJECT_ROOT / "docs" / "concepts.md"
DECLARED = {kind.scheme: kind.gives for kind in SOURCES}
PASSES_ON = {"mcap", "bus"}  # quantities of another unit
COLUMNS = (
    *("t_s", "accel_x_mps2", "accel_y_mps2", "accel_z_mps2"),
    *("gyro_x_radps", "gyro_y_radps", "gyro_z_radps"),
    *("mag_x_ut", "mag_y_ut", "mag_z_ut", "pressure_pa", "imu_temperature_degc"),
)
OTHERS = {
    AmbientSample: Quantity.AMBIENT_TEMPERATURE,
    BatterySample: Quantity.BATTERY,
    ElectronicsSample: Quantity.SENSOR_TEMPERATURE,
    GpsSample: Quantity.FIX,
    SightingSample: Quantity.SIGHTING,
}


def given(batches: Iterable[SensorBatch]) -> set[Quantity]:
    found: set[Quantity] = set()
    for batch in batches:
        imu = batch.imu
        found |= {Quantity.MAGNETIC_FIELD} if imu.mag_ut is not None else set()
        found |= {Quantity.PRESSURE} if imu.pressure_pa is not None else set()
        found |= {Quantity.SENSOR_TEMPERATURE} if imu.imu_temperature_degc is not None else set()
        for other in batch.others:
            if isinstance(other, ButtonPress):
                acknowledges = other.button == ACKNOWLEDGE
                found.add(Quantity.ACKNOWLEDGE_BUTTON if acknowledges else Quantity.MAYDAY_BUTTON)
            else:
                found.add(OTHERS[type(other)])
    return found


def of_a_file(folder: Path) -> set[Quantity]:
    """Quantities of a file with every column that a recording may have."""
    path = folder / "imu.csv"
    rows = (f"{k * 0.005:.3f},0,0,-9.8,0,0,0,20,0,40,101325,25" for k in range(500))
    path.write_text("\n".join((",".join(COLUMNS), *rows)), encoding="utf-8")
    return given(open_source(f"recording:{path}").batches())


def of_simulations(_: Path) -> set[Quantity]:
    """Quantities of simulations: one scenario has beacons, another one a wearer who
    acknowledges.
    """
    return {
        one
        for scenario in ("passes-beacons", "search-ground-floor")
        for one in given(islice(open_source(f"simulated:{scenario}").batches(), 20 * 40))
    }


def of_a_bench(_: Path) -> set[Quantity]:
    return given(islice(open_source("bench:5").batches(), 20))


def of_an_ximu3(_: Path) -> set[Quantity]:
    press = text_message("O", 60_000, 1.0), text_message("O", 70_000, 0.0)
    with closing(TcpDevice([*at_rest(30), *press, *at_rest(330, first=30)])) as device:
        source = open_source(f"ximu3:{device.source}?field=50")
        with closing(source):
            return given(islice(source.batches(), 3))


def of_iio_devices(folder: Path) -> set[Quantity]:
    """Quantities of IIO devices with every channel that they may have."""
    tree, devices = SysfsTree(folder / "sys"), folder / "dev"
    field = {f"in_magn_{axis}_raw": "100" for axis in "xyz"}
    tree.iio(7, "1-001e", name="lis3mdl", in_magn_scale="0.001", **field)
    tree.iio(8, "1-005d", name="lps22hb", in_pressure_input="101.325")
    text = "icm42688-accel+icm42688-gyro?mag=lis3mdl&pressure=lps22hb"
    source = IioSource(text, sysfs=tree.root, devices=devices)
    with (
        closing(EmulatedIio(tree, devices, ICM_ACCEL, 0)),
        closing(EmulatedIio(tree, devices, ICM_GYRO, 1)),
        closing(source),
    ):
        return given(islice(source.batches(), 20))


@pytest.mark.slow
@pytest.mark.parametrize(
    ("scheme", "take"),
    [
        ("recording", of_a_file),
        ("simulated", of_simulations),
        ("bench", of_a_bench),
        ("ximu3", of_an_ximu3),
        ("iio", of_iio_devices),
    ],
)
def test_source_delivers_exactly_its_declared_quantities(scheme, take, tmp_path: Path) -> None:
    assert take(tmp_path) == DECLARED[scheme]


def test_every_kind_with_own_quantities_is_checked() -> None:
    assert {"recording", "simulated", "bench", "ximu3", "iio"} | PASSES_ON == set(DECLARED)
    assert all(DECLARED[scheme] == frozenset(Quantity) for scheme in PASSES_ON)


def test_concepts_list_the_quantities_of_each_source() -> None:
    """A row for each quantity, a column for each kind with own quantities."""
    lines = CONCEPTS.read_text(encoding="utf-8").splitlines()
    (head,) = (one for one in lines if one.startswith("| beside acceleration and rotation |"))
    schemes = re.findall(r"`(\w+):`", head)
    assert set(schemes) == set(DECLARED) - PASSES_ON
    table = lines[lines.index(head) + 2 :]
    assert len(Quantity) == next(k for k, line in enumerate(table) if not line)
    for quantity in Quantity:
        row = next(one for one in table if one.startswith(f"| {quantity} |"))
        cells = [cell.strip() for cell in row.strip("|").split("|")][1 : 1 + len(schemes)]
        reported = {scheme for scheme, cell in zip(schemes, cells, strict=True) if cell == "yes"}
        assert set(cells) <= {"yes", "no"}, row
        assert reported == {one for one in schemes if quantity in DECLARED[one]}, row
