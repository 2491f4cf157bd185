"""Magnetometer, barometer and GPS of a simulated wearer, outdoors and indoors."""

from __future__ import annotations

import numpy as np
import pytest

from edge.samples import Floats, GpsSample
from edge.simulation.building import load_building
from edge.simulation.environment import (
    CONSUMER_MAG,
    IDEAL_BARO,
    IDEAL_MAG,
    BaroErrors,
    Barometer,
    MagErrors,
    MagneticField,
    SimulatedMagnetometer,
)
from edge.simulation.gps import Gps
from shared.geo import pressure_altitude_m, pressure_pa_at

HOUSE = load_building()
OUTSIDE = (-10.0, 12.0, 0.0)
INSIDE = (7.0, 7.0, 0.0)


def rng() -> np.random.Generator:
    return np.random.default_rng(4)


def at(place: tuple[float, float, float], count: int) -> Floats:
    return np.tile(place, (count, 1))


def test_steel_bends_the_field_inside_only() -> None:
    field = MagneticField(HOUSE, rng())
    along = np.column_stack((np.full(50, 7.0), np.linspace(2.0, 22.0, 50), np.zeros(50)))
    assert np.ptp(field.at(along), axis=0).max() > 3.0
    outside = along - [20.0, 0.0, 0.0]
    assert np.ptp(field.at(outside), axis=0).max() == 0.0
    assert np.ptp(MagneticField(None, rng()).at(along), axis=0).max() == 0.0


def test_an_ideal_magnetometer_sees_the_field_in_its_own_axes() -> None:
    field = MagneticField(None, rng())
    quarter_turn = np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])
    mag = SimulatedMagnetometer(IDEAL_MAG, field, rng())
    reported = mag.measure(0, at(OUTSIDE, 1), quarter_turn[None])[0]
    north, east, down = field.at(at(OUTSIDE, 1))[0]
    assert reported == pytest.approx([east, -north, down])


def test_missed_magnetometer_samples_are_nan_across_calls() -> None:
    mag = SimulatedMagnetometer(MagErrors(every=3), MagneticField(None, rng()), rng())
    turns = np.tile(np.eye(3), (7, 1, 1))
    first = mag.measure(0, at(OUTSIDE, 7), turns)
    second = mag.measure(7, at(OUTSIDE, 7), turns)
    given = np.isfinite(np.concatenate((first, second))).all(axis=1)
    assert np.flatnonzero(given).tolist() == [0, 3, 6, 9, 12]


def test_hard_iron_moves_the_centre() -> None:
    mag = SimulatedMagnetometer(CONSUMER_MAG, MagneticField(None, rng()), rng())
    turns = np.array([np.diag(signs) for signs in ([1, 1, 1], [1, -1, -1], [-1, 1, -1])])
    reported = np.array(
        [mag.measure(0, at(OUTSIDE, 1), turn[None].astype(float))[0] for turn in turns]
    )
    norms_ut = np.linalg.norm(reported, axis=1)
    assert np.ptp(norms_ut) > 1.0


@pytest.mark.parametrize("height_m", [0.0, 3.2, 20.0])
def test_pressure_stands_for_height(height_m: float) -> None:
    baro = Barometer(IDEAL_BARO, None, 400.0, 200.0, rng())
    stated_pa = baro.measure(0, np.zeros(1), at((0.0, 0.0, -height_m), 1))[0]
    assert pressure_altitude_m(stated_pa) == pytest.approx(
        400.0 + height_m, abs=1e-6 + 0.01 * height_m
    )


def test_doors_slam_indoors_only() -> None:
    errors = BaroErrors(slam_std_pa=25.0, slam_interval_s=20.0)
    t_s = np.arange(0.0, 300.0, 0.04)
    indoors = Barometer(errors, HOUSE, 400.0, 25.0, rng()).measure(0, t_s, at(INSIDE, len(t_s)))
    outdoors = Barometer(errors, HOUSE, 400.0, 25.0, rng()).measure(0, t_s, at(OUTSIDE, len(t_s)))
    assert np.abs(indoors - pressure_pa_at(400.0)).max() > 5.0
    assert np.median(np.abs(indoors - pressure_pa_at(400.0))) < 0.5, "a slam is short"
    assert np.ptp(outdoors) == 0.0


def test_a_barometer_drifts_as_its_walk_says() -> None:
    ends_pa = []
    for seed in range(200):
        baro = Barometer(BaroErrors(drift_pa=0.2), None, 0.0, 25.0, np.random.default_rng(seed))
        t_s = np.arange(0.0, 100.0, 0.04)
        ends_pa.append(baro.measure(0, t_s, at(OUTSIDE, len(t_s)))[-1])
    assert np.std(ends_pa) == pytest.approx(0.2 * np.sqrt(100.0), rel=0.15)


def fixes(place: tuple[float, float, float], start_s: int, count: int, gps: Gps) -> list[GpsSample]:
    return [gps.fix(float(start_s + k), place, (0.5, 0.0)) for k in range(count)]


def test_gps_outside_is_as_good_as_it_says() -> None:
    errors_m, stds_m = [], []
    for seed in range(40):
        gps = Gps(HOUSE.anchor, HOUSE, np.random.default_rng(seed))
        for fix in fixes(OUTSIDE, 0, 10, gps):
            north_m, east_m, _ = HOUSE.anchor.to_incident_m(fix.lat_deg, fix.lon_deg, fix.height_m)
            errors_m += [north_m - OUTSIDE[0], east_m - OUTSIDE[1]]
            stds_m.append(fix.horizontal_std_m)
            assert fix.fix_type == 3
    assert np.std(errors_m) == pytest.approx(np.mean(stds_m), rel=0.2)


def test_gps_is_worse_near_walls_lost_inside_and_slow_to_return() -> None:
    gps = Gps(HOUSE.anchor, HOUSE, rng())
    open_sky = fixes(OUTSIDE, 0, 1, gps)[0]
    near_wall = fixes((-2.0, 12.0, 0.0), 1, 1, gps)[0]
    assert near_wall.horizontal_std_m > 2.0 * open_sky.horizontal_std_m
    inside = fixes(INSIDE, 2, 3, gps)
    assert {fix.fix_type for fix in inside} == {0}
    assert all(np.isnan([fix.lat_deg, fix.lon_deg, fix.horizontal_std_m]).all() for fix in inside)
    again = fixes(OUTSIDE, 5, 6, gps)
    assert [fix.fix_type for fix in again] == [0, 0, 0, 3, 3, 3]


def test_gps_says_speed_and_course() -> None:
    fix = Gps(HOUSE.anchor, None, rng()).fix(0.0, OUTSIDE, (0.0, 5.0))
    assert fix.speed_mps == pytest.approx(5.0, abs=0.5)
    assert fix.course_rad == pytest.approx(np.pi / 2, abs=0.1)
