"""The file of a calibration: written, read, damaged, old and poor."""

from __future__ import annotations

import re
from contextlib import closing
from datetime import timedelta

import msgspec
import pytest

from edge.app.calibration_session import calibrate_guided, calibrate_recorded
from edge.calibration.file import identity, read_calibration, write_calibration
from edge.calibration.model import Accelerometer, Calibration, Gyroscope, Magnetometer, Warmth
from edge.calibration.steps import StillStep
from edge.simulation.handled_unit import HandledUnit
from edge.sources.registry import open_source
from shared.errors import ConfigError, UserError
from tests.rig.calibration_steps import MADE, gathered, known, solved


@pytest.fixture
def calibration() -> Calibration:
    return solved(gathered(StillStep(), [HandledUnit(2).rest(14.0)]))


def whole_calibration(
    of_force: float = 0.0, of_rate: float = 0.0, of_field: float = 0.0
) -> Calibration:
    """All parts, of sensors that err by nothing but these residuals."""
    zero, gain = (0.0, 0.0, 0.0), ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))
    none = (zero, zero, zero)
    return Calibration(
        "u1",
        "s",
        MADE,
        Accelerometer(
            gain=gain,
            gain_std=gain,
            bias_mps2=zero,
            bias_std_mps2=zero,
            poses=12,
            residual_mps2=of_force,
        ),
        Gyroscope(
            bias_radps=zero,
            bias_std_radps=zero,
            per_force=none,
            per_force_std=none,
            residual_radps=of_rate,
        ),
        Magnetometer(gain, gain, zero, zero, 50.0, of_field),
        Warmth(zero, zero, zero, zero, 10.0, 30.0, 0.0, 0.0),
    )


def test_a_file_gives_back_the_calibration_and_its_identity(calibration, tmp_path):
    write_calibration(calibration, tmp_path / "c.toml")
    again = read_calibration(tmp_path / "c.toml")
    assert again == calibration
    assert identity(again) == identity(calibration)
    assert identity(calibration).startswith("20260501T120000Z-")
    other = msgspec.structs.replace(calibration, unit="u2")
    assert identity(other) != identity(calibration)


@pytest.mark.parametrize(
    ("text", "reported"),
    [
        ("unit = 1", "is damaged"),
        ("made = ", "is damaged"),
        ('unit = "u"\nsensor = "s"\nmade = 2026-01-01T00:00:00', "no time zone"),
        ('unit = "u"\nsensor = "s"\nmade = 2026-01-01T00:00:00Z\nbias = 1', "bias"),
    ],
)
def test_a_damaged_file_is_one_sentence(text, reported, tmp_path):
    (tmp_path / "c.toml").write_text(text)
    with pytest.raises(ConfigError, match=reported):
        read_calibration(tmp_path / "c.toml")


@pytest.mark.parametrize("number", ["nan", "inf", "-inf"])
def test_file_with_a_value_that_is_no_number_is_damaged(calibration, number, tmp_path):
    """With it every sample would be lost, and the unit without a place, with a healthy sensor."""
    write_calibration(calibration, tmp_path / "c.toml")
    text = (tmp_path / "c.toml").read_text()
    for first in ("bias_radps = [", "residual_radps = "):
        before, after = text.split(first)
        rest = after[after.index("," if first.endswith("[") else "\n") :]
        (tmp_path / "spoilt.toml").write_text(f"{before}{first}{number}{rest}")
        with pytest.raises(ConfigError, match=r"is damaged \(a value that is no number\)"):
            read_calibration(tmp_path / "spoilt.toml")


def test_a_file_that_is_not_there_is_one_sentence(tmp_path):
    with pytest.raises(ConfigError, match="check the path"):
        read_calibration(tmp_path / "none.toml")


@pytest.mark.parametrize(
    ("line", "reported"),
    [
        ("bias_radps = [0.01, -0.3, 0.0]", "gyroscope.bias_radps is off by more than 0.2"),
        ("per_force = [[0, 0, 0], [0, 0.03, 0], [0, 0, 0]]", "gyroscope.per_force is off by"),
        ("gain = [[9.98, 0, 0], [0, 1, 0], [0, 0, 1]]", "accelerometer.gain is off by more than"),
        ("gain = [[1, 0, 0], [0, 0, 0], [0, 0, 1]]", "accelerometer.gain is off by more than 0.3"),
        ("bias_mps2 = [0.1, 0.0, -9.8]", "accelerometer.bias_mps2 is off by more than 3"),
        ("gain = [[4.5, 0, 0], [0, 1, 0], [0, 0, 1]]", "magnetometer.gain is off by more than 3"),
        ("hard_iron_ut = [0, 0, 1e12]", "magnetometer.hard_iron_ut is off by more than 5000"),
        ("accel_bias_per_degc_mps2 = [0, 1.5, 0]", "warmth.accel_bias_per_degc_mps2 is off by"),
        ("gyro_bias_per_degc_radps = [0, -1.5, 0]", "warmth.gyro_bias_per_degc_radps is off by"),
    ],
)
def test_impossible_sensor_errors_are_damage(line, reported, tmp_path):
    """A flipped digit would bend every path of a unit whose sensors are healthy."""
    part = reported.partition(".")[0]
    file = tmp_path / "c.toml"
    write_calibration(whole_calibration(), file)
    assert read_calibration(file) == whole_calibration()
    before, head, rest = file.read_text().partition(f"[{part}]")
    name = line.partition(" =")[0]
    lines = [line if one.startswith(f"{name} =") else one for one in rest.split("\n")]
    assert lines != rest.split("\n")
    first = next(number for number, one in enumerate(lines) if one == line)
    spoilt = [*lines[: first + 1], *rest.split("\n")[first + 1 :]]
    file.write_text(before + head + "\n".join(spoilt))
    with pytest.raises(ConfigError, match=re.escape(f"is damaged ({reported}")):
        read_calibration(file)


@pytest.mark.parametrize(
    ("part", "line", "reported"),
    [
        ("accelerometer", "at_degc = 1e9", "accelerometer.at_degc is not from -60 to 150"),
        ("gyroscope", "at_degc = -240.0", "gyroscope.at_degc is not from -60 to 150"),
        ("magnetometer", "field_ut = 0.0", "magnetometer.field_ut is not from 10 to 120"),
        ("magnetometer", "field_ut = 500.0", "magnetometer.field_ut is not from 10 to 120"),
        ("warmth", "from_degc = -1e9", "warmth.from_degc is not from -60 to 150"),
        ("warmth", "to_degc = 300.0", "warmth.to_degc is not from -60 to 150"),
    ],
)
def test_impossible_table_is_damage(part, line, reported, tmp_path):
    """A warmth that never was would be taken out of every sample."""
    file = tmp_path / "c.toml"
    write_calibration(whole_calibration(), file)
    name = line.partition(" =")[0]
    before, head, rest = file.read_text().partition(f"[{part}]\n")
    kept, *others = rest.partition("\n[")
    lines = [one for one in kept.split("\n") if not one.startswith(f"{name} =")]
    file.write_text(before + head + "\n".join([line, *lines]) + "".join(others))
    with pytest.raises(ConfigError, match=re.escape(f"is damaged ({reported}")):
        read_calibration(file)


@pytest.mark.parametrize(
    ("made", "reported"),
    [
        ("1026-05-01T12:00:00Z", "made in 1026"),
        ("0001-01-01T00:00:00+14:00", "made in 1"),
        ("9999-12-31T23:00:00-14:00", "made in 9999"),
        ("1970-01-01T00:00:00Z", None),
    ],
)
def test_a_time_that_no_description_can_say_is_damage(made, reported, tmp_path):
    file = tmp_path / "c.toml"
    write_calibration(whole_calibration(), file)
    text = file.read_text()
    first = text.index("made = ")
    file.write_text(text[:first] + f"made = {made}\n" + text[text.index("\n", first) :])
    if reported is None:
        assert identity(read_calibration(file)).startswith("19700101T000000Z-")
        return
    with pytest.raises(ConfigError, match=re.escape(f"is damaged ({reported})")):
        read_calibration(file)


def test_six_poses_fit_whatever_they_show():
    """As many equations as unknowns: a pose on a table that was pushed would not be noticed."""
    accelerometer = known(whole_calibration().accelerometer)
    for poses, reported in ((7, ()), (6, ("accelerometer of 6 poses only: nothing checks it",))):
        few = msgspec.structs.replace(accelerometer, poses=poses)
        assert msgspec.structs.replace(whole_calibration(), accelerometer=few).faults() == reported


def test_half_a_year_makes_it_old_and_residuals_make_it_poor(calibration):
    assert not calibration.is_old(MADE + timedelta(days=180))
    assert calibration.is_old(MADE + timedelta(days=181))
    gyroscope = msgspec.structs.replace(known(calibration.gyroscope), residual_radps=0.01)
    poor = msgspec.structs.replace(calibration, gyroscope=gyroscope)
    assert poor.faults() == ("gyroscope off by 0.573 deg/s",)


@pytest.mark.parametrize(
    ("residuals", "reported"),
    [
        ((0.04, 4e-4, 1.4), ()),
        ((0.06, 4e-4, 1.4), ("accelerometer off by 0.060 m/s2",)),
        ((0.04, 6e-4, 1.4), ("gyroscope off by 0.034 deg/s",)),
        ((0.04, 4e-4, 1.6), ("magnetometer off by 1.6 uT",)),
    ],
)
def test_each_sensor_alone_makes_it_poor(residuals, reported):
    of_force, of_rate, of_field = residuals
    calibration = whole_calibration(of_force, of_rate, of_field)
    assert calibration.faults() == reported


@pytest.mark.slow
def test_a_whole_calibration_from_a_source_and_from_recordings(tmp_path, capsys):
    with closing(open_source("bench:7")) as unit:
        calibrate_guided(unit, tmp_path / "guided.toml", "u1", None, with_warm_up=True)
    guided = read_calibration(tmp_path / "guided.toml")
    assert guided.sensor == "simulated on a table"
    assert None not in (guided.accelerometer, guided.gyroscope, guided.magnetometer, guided.warmth)
    calibrate_recorded({"still": "bench:7"}, tmp_path / "recorded.toml", "u1", None)
    assert read_calibration(tmp_path / "recorded.toml").accelerometer is None
    reported = capsys.readouterr().err
    assert "gyroscope bias" in reported
    with pytest.raises(UserError, match="simulated:straight: the poses step cannot be used"):
        calibrate_recorded({"poses": "simulated:straight"}, tmp_path / "x.toml", "u1", None)
    assert not (tmp_path / "x.toml").exists()
