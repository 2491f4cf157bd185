"""Contract of every kind of temperature sensor, whatever its driver."""

from __future__ import annotations

import os
import shutil
from collections import deque
from collections.abc import Callable
from pathlib import Path

import pytest

from edge.samples import AmbientSample, ElectronicsSample
from edge.sources.temperature.reader import TemperatureReader
from edge.sources.temperature.registry import TEMPERATURE_SENSORS, open_temperature_reader
from shared.clock import NS_PER_S, ManualClock, SystemClock
from shared.errors import ConfigError
from tests.rig.kernel_devices import SysfsTree, break_attribute, write_attributes
from tests.rig.waiting import until

ID = "28-0316a2794faa"


class Emulated:
    """One sensor of a kind, as its driver shows it."""

    def __init__(self, text: str, make: Callable[[SysfsTree], Path], attribute: str, scale: float):
        self.text = text
        self.make = make
        self.attribute = attribute
        self.scale = scale  # thousandths of a degree in one unit of the driver

    def set(self, device: Path, degc: float) -> None:
        write_attributes(device, {self.attribute: f"{degc * 1e3 / self.scale:.0f}"})


EMULATED = {
    "hwmon": Emulated(
        "hwmon:tmp102",
        lambda tree: tree.hwmon(0, name="tmp102", temp1_input="21500"),
        "temp1_input",
        1.0,
    ),
    "iio": Emulated(
        "iio:maxim_thermocouple",
        lambda tree: tree.iio(
            *(0, "spi0.0"),
            name="maxim_thermocouple",
            in_temp_raw="86",
            in_temp_scale="250.000000",
            in_temp_ambient_raw="400",
            in_temp_ambient_scale="62.500000",
        ),
        "in_temp_raw",
        250.0,
    ),
    "w1": Emulated(f"w1:{ID}", lambda tree: tree.w1(ID, temperature="21500"), "temperature", 1.0),
}


@pytest.fixture
def tree(tmp_path: Path) -> SysfsTree:
    return SysfsTree(tmp_path / "sys")


@pytest.fixture(params=EMULATED)
def sensor(request: pytest.FixtureRequest) -> Emulated:
    return EMULATED[request.param]


@pytest.fixture
def opened(tree: SysfsTree):
    readers: list[TemperatureReader] = []

    def opened(*texts: str) -> TemperatureReader:
        reader = open_temperature_reader(texts, SystemClock(), tree.root)
        readers.append(reader)
        reader.start()
        return reader

    yield opened
    for reader in readers:
        reader.close()


def taken(reader: TemperatureReader) -> AmbientSample | ElectronicsSample:
    """The newest reading, when there is one."""
    found: deque[AmbientSample | ElectronicsSample] = deque(maxlen=1)

    def has_come() -> bool:
        found.extend(reader.take())
        return len(found) > 0

    until(has_come, "a reading")
    return found[0]


def fault(reader: TemperatureReader) -> str:
    found: list[str] = []

    def has_come() -> bool:
        found.extend(reader.take_faults())
        return len(found) > 0

    until(has_come, "a fault")
    (only,) = found
    return only


def test_every_kind_is_emulated() -> None:
    assert set(EMULATED) == {kind.scheme for kind in TEMPERATURE_SENSORS}


def test_reading_has_its_name_and_the_time_of_this_machine(sensor, tree, opened) -> None:
    sensor.make(tree)
    clock = SystemClock()
    before_ns = clock.monotonic_ns()
    reader = opened(f"{sensor.text}?name=front")
    found = taken(reader)
    assert isinstance(found, AmbientSample)
    assert found.temperature_degc == pytest.approx(21.5)
    assert found.sensor == "front"
    assert before_ns <= found.t_ns <= clock.monotonic_ns()
    assert reader.take_faults() == ()


def test_sensor_inside_the_unit_does_not_measure_the_air(sensor, tree, opened) -> None:
    sensor.make(tree)
    found = taken(opened(f"{sensor.text}?role=electronics"))
    assert isinstance(found, ElectronicsSample)
    assert found.sensor == sensor.text.partition(":")[2]


@pytest.mark.parametrize("degc", [-40.0, 0.0, 84.5])
def test_cold_and_warm_are_read(sensor, tree, opened, degc: float) -> None:
    sensor.set(sensor.make(tree), degc)
    assert taken(opened(sensor.text)).temperature_degc == pytest.approx(degc)


@pytest.mark.parametrize("degc", [-200.0, 1300.0, 1e6])
def test_implausible_value_is_a_fault_and_no_heat(sensor, tree, opened, degc) -> None:
    sensor.set(sensor.make(tree), degc)
    reader = opened(sensor.text)
    assert "no reading" in fault(reader)
    assert reader.take() == ()


def test_text_that_is_no_number_is_a_fault(sensor, tree, opened) -> None:
    write_attributes(sensor.make(tree), {sensor.attribute: "nonsense"})
    reader = opened(sensor.text)
    assert "no reading" in fault(reader)
    assert reader.take() == ()


def test_sensor_without_answer_is_a_fault_reported_once(sensor, tree, opened) -> None:
    break_attribute(sensor.make(tree), sensor.attribute)
    reader = opened(sensor.text)
    assert "not answer" in fault(reader)
    assert reader.take() == ()
    assert reader.take_faults() == ()


def test_missing_sensor_is_reported_with_the_present_ones(sensor, tree, opened) -> None:
    tree.hwmon(3, "1-0050", name="sht3x", temp1_input="20000")
    tree.iio(3, "spi0.3", name="max31856", in_temp_raw="1", in_temp_scale="7.8125")
    tree.w1("28-00000000cafe", temperature="20000")
    reported = fault(opened(sensor.text))
    assert sensor.text.partition(":")[2] in reported
    assert any(there in reported for there in ("sht3x", "max31856", "28-00000000cafe")), reported


def test_missing_sensor_is_reported_where_there_is_none_at_all(sensor, opened) -> None:
    assert "there is none at all" in fault(opened(sensor.text))


@pytest.mark.slow
def test_sensor_that_appears_later_is_read(sensor, tree, opened) -> None:
    reader = opened(sensor.text)
    assert "there is no" in fault(reader)
    sensor.make(tree)
    assert taken(reader).temperature_degc == pytest.approx(21.5)


@pytest.mark.slow
def test_removed_sensor_has_no_reading_until_it_is_back(sensor, tree, opened) -> None:
    device = sensor.make(tree)
    reader = opened(sensor.text)
    taken(reader)
    shutil.rmtree(device)
    assert "no" in fault(reader)
    reader.take()
    assert reader.take() == ()
    sensor.make(tree)
    taken(reader)


def test_missing_permission_is_reported_with_the_udev_rule(sensor, tree, opened, monkeypatch):
    """The tests may run as root, who may read everything."""
    device = sensor.make(tree)
    allowed = Path.read_text

    def refused(path: Path, *arguments: object, **options: object) -> str:
        if path == tree.root / path.relative_to(tree.root) and path.name == sensor.attribute:
            raise PermissionError(13, "Permission denied", str(path))
        return allowed(path, *arguments, **options)  # type: ignore[arg-type]

    monkeypatch.setattr(Path, "read_text", refused)
    reported = fault(opened(sensor.text))
    assert "60-muster.rules" in reported
    assert device.exists()


@pytest.mark.parametrize(
    ("texts", "reported"),
    [
        (["tmp102"], "Known are hwmon:"),
        (["hwmom:tmp102"], "did you mean hwmon:?"),
        (["hwmon:"], "Known are hwmon:"),
        (["hwmon:/temp1"], "names no device"),
        (["iio:max31856@"], "names no device"),
        (["w1:28-xyz"], "w1:28-0316a2794faa"),
        (["hwmon:tmp102?nome=x"], "unknown option 'nome'"),
        (["hwmon:tmp102?name="], "cannot be used"),
        (["hwmon:tmp102?role=air"], "known are environment, electronics"),
        (["hwmon:tmp102?name=a", "iio:max31856?name=a"], "two temperature sensors are named a"),
        (["hwmon:coretemp"], "role=electronics"),
        (["hwmon:cpu_thermal/temp1?role=environment"], "role=electronics"),
        (["iio:max31856/ambient"], "cold junction"),
    ],
)
def test_impossible_settings_are_explained(texts, reported, tree) -> None:
    with pytest.raises(ConfigError) as caught:
        open_temperature_reader(texts, SystemClock(), tree.root)
    assert reported in str(caught.value)


def test_hanging_sensor_is_reported_while_the_others_are_read(tree) -> None:
    """A named pipe without a writer stands for a driver that never returns."""
    clock = ManualClock()
    device = tree.hwmon(0, name="tmp102")
    os.mkfifo(device / "temp1_input")
    tree.w1(ID, temperature="30000")
    reader = open_temperature_reader(["hwmon:tmp102?name=front", f"w1:{ID}"], clock, tree.root)
    reader.start()
    taken(reader)
    clock.advance(6.0)
    until(reader.take, "the other one is still read")
    reported = [one for one in reader.take_faults() if "front" in one]
    assert "no reading for 6 s: it hangs" in reported[0]
    assert not any("front" in one for one in reader.take_faults())
    (device / "temp1_input").write_text("25000\n")  # so that its thread can end
    reader.close()
    assert clock.monotonic_ns() < 60 * NS_PER_S
