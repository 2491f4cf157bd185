"""The bench of telephones in the hand: its plans, and a recording that is made up."""

from __future__ import annotations

import json
from typing import Any

import numpy as np
import pytest

from shared.errors import UserError
from tests.bench.phones.command import WAYS, measure
from tests.bench.phones.floor_plans import floor_plan
from tests.bench.phones.walks import LIVE, fuse_walk, publish_walk

_RATE_HZ, _STEP_S, _STEP_M = 50.0, 0.5, 0.65
_WALKED_S, _STANDS_S = 40.0, 3.0
_LOW, _DEGREES = np.array([120.0, 30.0]), np.array([1e-3, 5e-4])  # of 100 by 50 m


def _square(category: str, *corners_m: tuple[float, float]) -> dict[str, Any]:
    ring = [(_LOW + np.array(corner) / (100.0, 50.0) * _DEGREES).tolist() for corner in corners_m]
    return {
        "type": "Feature",
        "properties": {
            "category": category if category == "floor" else [category],
            "floor_num": 2,
        },
        "geometry": {"type": "Polygon", "coordinates": [[*ring, ring[0]]]},
    }


@pytest.fixture
def floor(tmp_path):
    """A floor of 100 by 50 m with one shop and one parking space."""
    folder = tmp_path / "phones" / "floor"
    folder.mkdir(parents=True)
    features = [
        _square("floor", (0, 0), (100, 0), (100, 50), (0, 50)),
        _square("shop", (10, 30), (30, 30), (30, 40), (10, 40)),
        _square("5d357bc00d3c1514c7107b6a", (50, 30), (55, 30), (55, 35)),
    ]
    plan = {"type": "FeatureCollection", "features": features}
    (folder / "plan.geojson").write_text(json.dumps(plan), encoding="utf-8")
    size = {"width_m": 100.0, "height_m": 50.0, "licence": "made up"}
    (folder / "floor.json").write_text(json.dumps(size), encoding="utf-8")
    return folder


@pytest.fixture
def trial(floor):
    """A hand that is thrown up and tips forward at each step, straight to the east."""
    folder = floor / "walk"
    folder.mkdir()
    t_s = np.arange(0.0, _STANDS_S + _WALKED_S, 1.0 / _RATE_HZ)
    phase = 2.0 * np.pi * (t_s - _STANDS_S) / _STEP_S
    size = np.where(t_s > _STANDS_S, 3.4, 0.0)
    accel = np.column_stack((0.2 * size * np.cos(phase), 0.0 * t_s, 9.81 + size * np.cos(phase)))
    rows = np.column_stack((t_s, accel, np.zeros((len(t_s), 3))))
    head = "t_s,accel_x_mps2,accel_y_mps2,accel_z_mps2,gyro_x_radps,gyro_y_radps,gyro_z_radps"
    np.savetxt(folder / "imu.csv.gz", rows, "%.5f", delimiter=",", header=head, comments="")
    meta = {"rate_hz": _RATE_HZ, "sensor": "made up"}
    (folder / "trial.json").write_text(json.dumps(meta), encoding="utf-8")
    at_s = np.arange(_STANDS_S, _STANDS_S + _WALKED_S, 8.0)
    x_m = 10.0 + (at_s - _STANDS_S) / _STEP_S * _STEP_M
    truth = np.column_stack((at_s, x_m, np.full(len(at_s), 20.0)))
    np.savetxt(folder / "truth.csv", truth, delimiter=",", header="t_s,x_m,y_m", comments="")
    return folder


def test_a_floor_s_plan_has_the_walls_of_its_shops_and_none_about_parking_spaces(floor):
    plan = floor_plan(floor)
    assert [storey.floor for storey in plan.storeys] == [1]  # the second from the ground
    assert len(plan.outlines) == 1
    assert len(plan.walls) == 2  # the floor's and the shop's
    np.testing.assert_allclose(plan.walls[1].line[0], (10.0, 30.0), atol=1e-6)
    np.testing.assert_allclose(plan.outlines[0][2], (100.0, 50.0), atol=1e-6)


def test_errors_are_those_of_the_path_from_the_first_waypoint_in_the_first_direction(floor, trial):
    walk = publish_walk(trial, "body")
    assert walk.start.north_m == pytest.approx(20.0)
    assert walk.start.east_m == pytest.approx(10.0)
    own_m = np.array([(one.north_m, one.east_m) for one in walk.positions])
    walked_m = float(np.hypot(*own_m[-1]))
    for known in (None, floor):
        errors = fuse_walk(walk, known)[LIVE]
        assert len(errors.error_m) == len(walk.waypoint_s) - 1
        # Straight ahead only the length of the path can be wrong.
        true_m = _WALKED_S / _STEP_S * _STEP_M
        assert errors.error_m[-1] < abs(walked_m - true_m) + 1.0


@pytest.mark.slow
def test_the_bench_has_figures_of_each_floor_and_of_all(trial, tmp_path):
    figures = measure(tmp_path, "body")
    assert [(one.floor, one.way) for one in figures] == [
        (floor, way) for floor in ("floor", "all") for way in WAYS
    ]
    assert all(one.walks == 1 and 0.0 < one.median_m < 10.0 for one in figures)


def test_a_folder_without_recordings_is_refused(tmp_path):
    with pytest.raises(UserError, match="no phones/FLOOR/TRIAL"):
        measure(tmp_path, "body")
