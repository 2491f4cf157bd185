"""Compass of a unit at the station: it turns a path without other heading, and harms no other."""

from __future__ import annotations

import math
from datetime import UTC, datetime

import numpy as np
import pytest

from base_station.fusion import FUSERS
from base_station.fusion.horizontal.compass import compass_heading, fused_turn
from base_station.fusion.interface import CompassHeading, Fuser, Start
from shared.clock import NS_PER_S
from shared.earth_field import EarthField, earth_field
from shared.geo import Anchor, wrap_pi
from shared.messages import MagneticNorth
from shared.messages.station import SetAnchor, SetStart
from shared.quality import Quality
from tests.bench.fusion.simulated_walks import Receiver, Walk
from tests.rig.station_script import Script

SEEDS = range(8)
STD_RAD = math.radians(6.0)
SYDNEY = Anchor(-33.8688, 151.2093, 0.0)
DAY_NS = round(datetime(2026, 7, 4, tzinfo=UTC).timestamp()) * NS_PER_S


def wandered(seed: int, duration_s: float = 120.0) -> Walk:
    return Walk.wander(np.random.default_rng(seed), duration_s)


def compass_of(walk: Walk, seed: int, off_rad: float | None = None) -> CompassHeading:
    """A compass whose error is drawn once and lasts."""
    if off_rad is None:
        off_rad = float(np.random.default_rng(100 + seed).normal(0.0, STD_RAD))
    return CompassHeading(wrap_pi(walk.turn_rad + off_rad), STD_RAD)


def started(walk: Walk, heading_rad: float = 0.0, heading_std_rad: float = math.pi) -> Fuser:
    """A fuser started at the begin of the walk; without a heading unless one is given."""
    fuser = FUSERS[0].new()
    north_m, east_m = walk.truth_m[0] - walk.own_m[0]
    fuser.start(Start(float(north_m), float(east_m), 0.0, heading_rad, 1.0, heading_std_rad))
    return fuser


def off_m(fuser: Fuser, walk: Walk, index: int) -> float:
    estimate = fuser.estimate()
    assert estimate is not None
    return math.dist((estimate.north_m, estimate.east_m), walk.truth_m[index])


def normalised2(fuser: Fuser, walk: Walk, index: int) -> float:
    estimate = fuser.estimate()
    assert estimate is not None
    error = np.array([estimate.north_m, estimate.east_m]) - walk.truth_m[index]
    product = estimate.correlation_ne * estimate.std_north_m * estimate.std_east_m
    spread = np.array([[estimate.std_north_m**2, product], [product, estimate.std_east_m**2]])
    return float(error @ np.linalg.solve(spread, error))


@pytest.mark.slow
def test_compass_turns_the_path_to_the_plan_without_a_receiver() -> None:
    inside = []
    for seed in SEEDS:
        walk = wandered(seed)
        received, deaf = started(walk), started(walk)
        for index in range(len(walk)):
            for fuser in (received, deaf):
                fuser.predict(walk.position(index))
            received.update_heading(compass_of(walk, seed))
            if index % 50 == 49:
                inside.append(normalised2(received, walk, index) < 5.991)
        estimate = received.estimate()
        assert estimate is not None
        assert estimate.heading_std_rad < 1.5 * STD_RAD
        assert estimate.quality_reason != "heading not known yet"
        away_m = float(np.linalg.norm(walk.truth_m[-1] - walk.truth_m[0]))
        assert off_m(received, walk, -1) < 3.0 + 0.4 * away_m
    assert np.mean(inside) > 0.85


def test_repetition_makes_the_heading_no_surer() -> None:
    walk = wandered(0)
    fuser = started(walk)
    for index in range(300):
        fuser.predict(walk.position(index))
        for _ in range(5):
            fuser.update_heading(compass_of(walk, 0))
        estimate = fuser.estimate()
        assert estimate is not None
        assert estimate.heading_std_rad > 0.9 * STD_RAD


def test_better_known_heading_stays() -> None:
    walk = wandered(1)
    one, other = (started(walk, walk.turn_rad, 0.03) for _ in range(2))
    for index in range(300):
        one.predict(walk.position(index))
        other.predict(walk.position(index))
        other.update_heading(compass_of(walk, 1, off_rad=0.2))
    assert one.estimate() == other.estimate()


@pytest.mark.slow
@pytest.mark.parametrize("off_rad", [0.7, 1.5, 3.0])
def test_fixes_refute_the_compass_for_good(off_rad: float) -> None:
    for seed in SEEDS:
        walk = wandered(seed)
        fuser, receiver = started(walk), Receiver(np.random.default_rng(seed))
        wrong = compass_of(walk, seed, off_rad=off_rad)
        for index in range(len(walk)):
            fuser.predict(walk.position(index))
            fuser.update_heading(wrong)
            if index % 5 == 0:
                fuser.update_gnss(receiver.fix(float(walk.t_s[index]), walk.truth_m[index]))
        assert off_m(fuser, walk, -1) < 8.0
        before = fuser.estimate()
        fuser.update_heading(wrong)
        assert fuser.estimate() == before


@pytest.mark.slow
def test_compass_does_no_harm_beside_fixes() -> None:
    with_compass_m: list[float] = []
    deaf_m: list[float] = []
    for seed in SEEDS:
        walk = wandered(seed)
        for errors_m, receives in ((with_compass_m, True), (deaf_m, False)):
            fuser, receiver = started(walk), Receiver(np.random.default_rng(seed))
            for index in range(len(walk)):
                fuser.predict(walk.position(index))
                if receives:
                    fuser.update_heading(compass_of(walk, seed))
                if index % 5 == 0:
                    fuser.update_gnss(receiver.fix(float(walk.t_s[index]), walk.truth_m[index]))
                if index > 50:
                    errors_m.append(off_m(fuser, walk, index))
    assert np.mean(with_compass_m) < 1.02 * np.mean(deaf_m)


def test_unplaced_unit_is_shown_turned_about_its_start() -> None:
    walk = wandered(2)
    fuser = FUSERS[0].new()
    for index in range(300):
        fuser.predict(walk.position(index))
        if index >= 100:
            fuser.update_heading(CompassHeading(walk.turn_rad, STD_RAD))
    estimate = fuser.estimate()
    assert estimate is not None
    c, s = math.cos(walk.turn_rad), math.sin(walk.turn_rad)
    north_m, east_m = walk.own_m[299]
    assert estimate.north_m == pytest.approx(c * north_m - s * east_m, abs=0.5)
    assert estimate.east_m == pytest.approx(s * north_m + c * east_m, abs=0.5)
    away_m = math.hypot(north_m, east_m)
    assert math.hypot(estimate.std_north_m, estimate.std_east_m) > 0.5 * STD_RAD * away_m
    assert "start not known" in estimate.quality_reason


def test_restored_compass_state_is_the_same() -> None:
    walk = wandered(3)
    fuser = started(walk)
    for index in range(100):
        fuser.predict(walk.position(index))
        fuser.update_heading(compass_of(walk, 3))
    again = FUSERS[0].restore(fuser.save())
    for one in (fuser, again):
        one.predict(walk.position(100))
        one.update_heading(compass_of(walk, 3))
    assert fuser.estimate() == again.estimate()


def test_magnetic_north_becomes_plan_north_by_declination_and_rotation() -> None:
    north = MagneticNorth(math.radians(30.0), math.radians(4.0))
    bearing = compass_heading(north, SYDNEY, DAY_NS + 12345)
    assert bearing is not None
    assert math.degrees(bearing.turn_rad) == pytest.approx(12.82 - 30.0, abs=0.02)
    assert math.radians(4.0) < bearing.std_rad < math.radians(5.0)
    rotated = Anchor(SYDNEY.lat_deg, SYDNEY.lon_deg, 0.0, math.radians(50.0))
    bearing = compass_heading(north, rotated, DAY_NS)
    assert bearing is not None
    assert math.degrees(bearing.turn_rad) == pytest.approx(12.82 - 30.0 - 50.0, abs=0.02)


def test_without_a_magnetic_model_of_the_date_the_compass_is_not_used() -> None:
    assert compass_heading(MagneticNorth(0.0, 0.1), SYDNEY, 0) is None


def test_compass_that_contradicts_the_estimate_is_not_used() -> None:
    assert fused_turn((0.0, 0.15), CompassHeading(0.7, 0.1)) is None
    known = fused_turn((0.0, 0.15), CompassHeading(0.3, 0.1))
    assert known is not None
    assert 0.0 < known[0] < 0.3
    assert known[1] == pytest.approx(0.01)


def test_unit_without_a_receiver_is_turned_to_the_plan_through_the_station() -> None:
    """It walks along magnetic north by its own compass, in a frame of its own."""
    script = Script()
    script.register("u1")
    script.act(SetAnchor(SYDNEY.lat_deg, SYDNEY.lon_deg, 0.0, math.radians(40.0)))
    script.act(SetStart("u1", 10.0, 20.0, 0.0, 0.0, 0.5, math.pi))
    own_north = MagneticNorth(math.radians(70.0), math.radians(5.0))
    for step in range(60):
        script.now_s += 0.2
        north_m, east_m = (
            0.25 * step * part(own_north.heading_rad) for part in (math.cos, math.sin)
        )
        script.position("u1", north_m, east_m, distance_m=0.25 * step, magnetic_north=own_north)
    script.tick()
    field = earth_field(-33.87, 151.21, 0.0, script.t_ns)
    assert isinstance(field, EarthField)
    course_rad = field.declination_rad - math.radians(40.0)
    way_m = 0.25 * 59
    fused = script.fused[-1]
    assert fused.north_m == pytest.approx(10.0 + way_m * math.cos(course_rad), abs=0.7)
    assert fused.east_m == pytest.approx(20.0 + way_m * math.sin(course_rad), abs=0.7)
    assert fused.quality is Quality.GOOD
