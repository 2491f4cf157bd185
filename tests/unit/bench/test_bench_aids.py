"""The bench of aids: its errors are those of the track, and its table has every walk."""

from __future__ import annotations

import json
from dataclasses import replace

import numpy as np
import pytest

from edge.simulation.factory import find_scenario
from edge.simulation.imu import TriadErrors
from edge.simulation.simulation import CONSUMER_SENSORS, UNCALIBRATED_SENSORS, Simulation
from tests.bench.tracker import aiding_sensors
from tests.bench.tracker.aiding_sensors import bench_aids
from tests.bench.tracker.simulated_calibration import calibration_of
from tests.bench.tracker.walk_errors import rotations_of, track, walk_errors
from tests.rig.inertial_walk import inertial_walk, samples

SQUARE = find_scenario("square-60m")


@pytest.fixture(scope="module")
def walked():
    found = inertial_walk("square-60m")
    return found.simulation, found.imu, found.truth


def test_true_track_has_no_error_whatever_its_north(walked):
    simulation, imu, truth = walked
    rows = track(simulation.description, imu, "eskf")
    c, s = np.cos(1.1), np.sin(1.1)
    turn = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
    way_m = truth.position_n_m - truth.position_n_m[0]
    exact = replace(rows, position_n_m=way_m)
    turned = replace(truth, position_n_m=way_m @ turn.T, rotation_nb=turn @ truth.rotation_nb)
    errors = walk_errors(rows, replace(truth, rotation_nb=rotations_of(rows.quaternion_nb)))
    assert errors.heading_deg == pytest.approx(0.0, abs=1e-9)
    same = replace(truth, rotation_nb=rotations_of(rows.quaternion_nb))
    assert walk_errors(exact, same).horizontal_m == pytest.approx(0.0, abs=1e-9)
    found, again = walk_errors(rows, truth), walk_errors(rows, turned)
    assert again.horizontal_m == pytest.approx(found.horizontal_m)
    assert again.heading_deg == pytest.approx(found.heading_deg)


def test_track_that_is_too_high_has_that_error(walked):
    simulation, imu, truth = walked
    rows = track(simulation.description, imu, "eskf")
    raised_m = rows.position_n_m - [0.0, 0.0, 2.0]
    errors = walk_errors(replace(rows, position_n_m=raised_m), truth)
    assert errors.height_m == pytest.approx(2.0, abs=0.1)
    assert errors.height_stated > 10.0


@pytest.mark.slow
def test_calibration_is_that_of_the_walking_unit():
    """Its bias is found, and another seed's is another."""
    for seed in (0, 1):
        simulation = Simulation(SQUARE, seed, UNCALIBRATED_SENSORS)
        calibration = calibration_of(simulation)
        still = samples(simulation).part(slice(0, 600))
        rate_radps = calibration.apply(still, simulation.description).gyro_radps.mean(axis=0)
        assert np.abs(still.gyro_radps.mean(axis=0)).max() > np.radians(0.3)
        assert np.abs(rate_radps).max() < np.radians(0.1)


def test_unit_without_errors_needs_no_calibration():
    gyro = replace(CONSUMER_SENSORS.imu.gyro, bias_std=0.0, g_sensitivity_std=0.0)
    imu = replace(CONSUMER_SENSORS.imu, gyro=gyro, accel=TriadErrors(noise_density=1.5e-3))
    calibration = calibration_of(Simulation(SQUARE, 0, replace(CONSUMER_SENSORS, imu=imu)))
    assert calibration.accelerometer is not None
    np.testing.assert_allclose(calibration.accelerometer.bias_mps2, 0.0, atol=0.01)


@pytest.mark.slow
def test_every_aid_has_its_walks(monkeypatch, capsys, tmp_path, walks):
    monkeypatch.setattr(aiding_sensors, "SEEDS", (0,))
    monkeypatch.setattr(aiding_sensors, "_SEARCH_S", 40.0)
    monkeypatch.setattr(aiding_sensors, "_LIFT_S", 60.0)
    file = tmp_path / "aids.json"
    bench_aids(walks / "loops" / "31", file)
    report = json.loads(file.read_text())
    of_aids = [entry["aid"] for entry in report["comparisons"]]
    assert {aid: of_aids.count(aid) for aid in of_aids} == {
        "magnetometer": 4, "barometer": 3, "calibration": 3,
    }  # fmt: skip
    open_ground, *_, steel = report["norths"]
    assert open_ground["reported"] > 0.3
    assert open_ground["off_deg"] < 5.0
    assert steel["reported"] < open_ground["reported"]
    (closure,) = report["closures"]
    assert closure["with_m"] == pytest.approx(closure["without_m"], abs=0.05)
    lift = next(e for e in report["comparisons"] if e["walks"].startswith("lift"))
    assert lift["with_"]["height_m"] < 0.3 < lift["without"]["height_m"]
    assert "calibration" in capsys.readouterr().out
