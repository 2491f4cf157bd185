"""Steps of a calibration: sufficient data, and requests meanwhile."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from edge.calibration.steps import PosesStep, Step, StillStep, TurningStep, WarmUpStep
from edge.samples import Floats, ImuBatch
from edge.simulation.handled_unit import HandledUnit
from shared.clock import NS_PER_S

RATE_HZ = 20
TREMBLE_RADPS = 1e-6
X, Y, Z = np.eye(3)
FACES = (X, -X, Y, -Y, Z, -Z)
EDGES = (X + Y, X + Z, Y + Z)


class Bench:
    """A unit with hardly any noise, in the hands of somebody."""

    def __init__(self, step: Step) -> None:
        self.step = step
        self.now_s = 0.0

    def lies(
        self,
        up: Floats,
        seconds: float,
        rate_radps: float = 0.0,
        degc: tuple[float, float] | None = None,
    ) -> None:
        """Half a second at its beginning and half a second at its end do not count."""
        count = round(seconds * RATE_HZ)
        t_s = self.now_s + np.arange(count) / RATE_HZ
        self.now_s += seconds
        force = 9.81 * np.asarray(up, float) / np.linalg.norm(up)
        self.step.push(
            ImuBatch(
                np.rint(t_s * NS_PER_S).astype(np.int64),
                np.tile(force, (count, 1)),
                np.array([0.0, 0.0, rate_radps]) + TREMBLE_RADPS * np.sin(7.3 * t_s)[:, None],
                imu_temperature_degc=None if degc is None else np.linspace(*degc, count),
            )
        )

    def lies_on(self, *ups: Floats, seconds: float = 3.0) -> None:
        for up in ups:
            self.lies(up, seconds)


def at_degrees(angle_deg: float) -> Floats:
    """Between +x and +y."""
    return np.asarray(math.cos(math.radians(angle_deg)) * X + math.sin(math.radians(angle_deg)) * Y)


@pytest.mark.parametrize(("lay_s", "lacks"), [(10.5, True), (11.0, False)])
def test_ten_seconds_of_rest_are_needed(lay_s: float, lacks: bool) -> None:
    bench = Bench(StillStep())
    bench.lies(Z, lay_s)
    assert (bench.step.missing() is not None) is lacks
    assert bench.step.wanted() == bench.step.missing()


def test_when_it_moved_is_stated_from_where_the_step_began_not_from_when_the_machine_did() -> None:
    step = StillStep()
    bench = Bench(step)
    bench.now_s = 86_400.2
    bench.lies(Z, 5.0)
    bench.lies(Z, 1.0, rate_radps=1.0)
    bench.lies(X, 5.0)
    assert "(last at 6.5 s)" in str(step.missing())


def test_the_longest_rest_is_taken_whichever_it_is() -> None:
    step = StillStep()
    bench = Bench(step)
    assert step.windows() == []
    assert step.progress() == "0 of 10 s"
    bench.lies(X, 4.0)
    assert step.progress() == "3 of 10 s"
    for up, seconds in ((Y, 12.0), (Z, 3.0)):
        bench.lies(up, seconds)
    assert len(step.windows()) == 22
    assert step.windows()[0].accel_mps2 == pytest.approx(9.81 * Y)
    assert step.missing() is None


@pytest.mark.parametrize(("rate_radps", "turns"), [(0.09, False), (-0.11, True)])
def test_rotating_table_is_reported(rate_radps: float, turns: bool) -> None:
    bench = Bench(StillStep())
    bench.lies(Z, 20.0, rate_radps)
    assert ("turned evenly" in (bench.step.missing() or "")) is turns


@pytest.mark.parametrize("value_radps", [0.0, 0.013])
@pytest.mark.parametrize("axes", ["x", "z", "x, y and z"])
def test_a_gyroscope_that_repeats_one_value_is_refused(value_radps: float, axes: str) -> None:
    batch = HandledUnit(0).rest(15.0)
    gyro_radps = batch.gyro_radps.copy()
    gyro_radps[:, ["xyz".index(axis) for axis in axes if axis in "xyz"]] = value_radps
    step = StillStep()
    step.push(replace(batch, gyro_radps=gyro_radps))
    assert f"the gyroscope repeated one value about {axes} all" in (step.missing() or "")


@pytest.mark.parametrize(("lay_s", "poses"), [(2.0, 0), (2.5, 1)])
def test_a_pose_is_held_for_a_second_and_a_half(lay_s: float, poses: int) -> None:
    step = PosesStep()
    bench = Bench(step)
    bench.lies(Z, 1.0)
    bench.lies(X, lay_s)
    bench.lies(Z, 1.0)
    assert len(step.poses()) == poses


@pytest.mark.parametrize(("apart_deg", "poses"), [(9.0, 1), (11.0, 2)])
def test_poses_that_are_less_than_ten_degrees_apart_are_one(apart_deg: float, poses: int) -> None:
    step = PosesStep()
    Bench(step).lies_on(at_degrees(0.0), at_degrees(apart_deg))
    assert len(step.poses()) == poses


def test_longer_of_two_rests_in_one_direction_counts() -> None:
    step = PosesStep()
    bench = Bench(step)
    bench.lies(at_degrees(0.0), 3.0)
    bench.lies(at_degrees(6.0), 6.0)
    (pose,) = step.poses()
    assert pose.accel_mps2 == pytest.approx(9.81 * at_degrees(6.0))


@pytest.mark.parametrize(("tilt_deg", "is_side"), [(33.0, True), (37.0, False)])
def test_a_side_points_up_to_within_thirty_five_degrees(tilt_deg: float, is_side: bool) -> None:
    bench = Bench(PosesStep())
    bench.lies_on(at_degrees(tilt_deg), *FACES[1:])
    assert (bench.step.missing() is None) is is_side


@pytest.mark.parametrize("number", range(6))
def test_the_side_that_has_not_pointed_up_is_named(number: int) -> None:
    bench = Bench(PosesStep())
    bench.lies_on(*FACES[:number], *FACES[number + 1 :])
    name = ("+x", "-x", "+y", "-y", "+z", "-z")[number]
    assert f"only 5 of 6 poses: turn it until {name} of the" in (bench.step.missing() or "")
    assert bench.step.wanted() == bench.step.missing()
    assert bench.step.progress() == "5 of 6 sides, 5 poses"


def test_before_the_first_pose_every_side_is_missing() -> None:
    assert "only 0 of 6 poses: turn it until +x, -x, +y, -y, +z and -z" in str(
        PosesStep().missing()
    )


def test_six_sides_do_and_edges_and_more_of_them_are_asked_for() -> None:
    bench = Bench(PosesStep())
    bench.lies_on(*FACES)
    asked = [bench.step.wanted()]
    for edge in EDGES:
        bench.lies_on(edge)
        asked.append(bench.step.wanted())
    bench.lies_on(*(-edge for edge in EDGES))
    asked.append(bench.step.wanted())
    assert asked == [
        "lean it half way between x and y, or x and z, or y and z",
        "lean it half way between x and z, or y and z",
        "lean it half way between y and z",
        "3 more poses, leaning differently",
        None,
    ]
    assert bench.step.missing() is None


def test_corners_tell_of_three_angles_at_once_and_each_is_asked_for_by_itself() -> None:
    """Twelve poses, some of which lean between any two axes, and two angles that nobody knows."""
    bench = Bench(PosesStep())
    bench.lies_on(*FACES, X + Y + Z, -X - Y - Z, X + Y, X - Y, Y - X, -X - Y)
    assert bench.step.wanted() == "lean it half way between x and z, or y and z"
    bench.lies_on(X + Z)
    assert bench.step.wanted() is None, "two angles and the sum of three give the third"


def fields(step: TurningStep, readings: Floats) -> None:
    none = np.zeros((len(readings), 3))
    step.push(ImuBatch(np.arange(len(readings)), none, none, mag_ut=readings))


def sphere(count: int, least_z: float = -1.0) -> Floats:
    """Evenly many directions (n, 3) above a height."""
    number = np.arange(count) + 0.5
    z = 1.0 - (1.0 - least_z) * number / count
    angle = math.pi * (1.0 + math.sqrt(5.0)) * number
    around = np.sqrt(1.0 - z**2)
    return np.column_stack((around * np.cos(angle), around * np.sin(angle), z))


IRON_UT = np.array([12.0, -7.0, 20.0])


def test_before_the_first_reading_there_is_no_magnetometer_to_be_seen() -> None:
    step = TurningStep()
    assert "no magnetometer" in (step.missing() or "")
    assert step.progress() == "0 of 110 directions"


def test_turned_all_around_is_enough() -> None:
    step = TurningStep()
    fields(step, 48.0 * sphere(2000) + IRON_UT)
    assert step.wanted() is None
    assert len(step.fields_ut()) >= 110
    assert step.progress() == f"{len(step.fields_ut())} of 110 directions"


def test_half_the_directions_will_do_and_more_are_asked_for() -> None:
    step = TurningStep()
    fields(step, 48.0 * sphere(60) + IRON_UT)
    assert step.missing() is None
    assert step.wanted() == "go on turning"


@pytest.mark.parametrize("count", [24, 38])
def test_too_few_directions_are_refused_though_they_are_all_around(count: int) -> None:
    step = TurningStep()
    fields(step, 48.0 * sphere(count) + IRON_UT)
    assert f"and {len(step.fields_ut())} of 40 directions" in (step.missing() or "")


def test_a_direction_that_was_held_for_long_weighs_as_much_as_another() -> None:
    turned = 48.0 * sphere(500) + IRON_UT
    briefly, long = TurningStep(), TurningStep()
    for step in (briefly, long):
        fields(step, turned)
    for _ in range(10):
        fields(long, np.repeat(turned[:1], 100, axis=0))
    assert len(long.fields_ut()) == len(briefly.fields_ut())
    off_ut = np.abs(long.fields_ut() - briefly.fields_ut()).max(axis=1)
    assert np.count_nonzero(off_ut > 1e-9) <= 1


def test_readings_that_were_missed_are_left_out() -> None:
    turned = 48.0 * sphere(500) + IRON_UT
    spoilt = np.repeat(turned, 2, axis=0)
    spoilt[1::2, 1] = np.nan
    whole, holed = TurningStep(), TurningStep()
    fields(whole, turned)
    fields(holed, spoilt)
    assert holed.fields_ut().tolist() == whole.fields_ut().tolist()


@pytest.mark.parametrize("wrong_ut", [500.0, -4900.0])
def test_some_readings_that_were_misread_spoil_no_turning(wrong_ut: float) -> None:
    """A sensor's answer is lost for a moment; he who turned it all around has done it."""
    turned = 48.0 * sphere(2000) + IRON_UT
    spoilt = turned.copy()
    spoilt[::100, 1] = wrong_ut
    step = TurningStep()
    fields(step, spoilt)
    assert step.wanted() is None
    assert np.abs(step.fields_ut() - IRON_UT).max() < 49.0


@pytest.mark.parametrize("count", [0, 1, 3])
def test_hardly_a_reading_is_hardly_turned(count: int) -> None:
    step = TurningStep()
    fields(step, 48.0 * sphere(500)[:: 500 // max(count, 1)][:count])
    assert "hardly turned" in (step.missing() or "")


def test_some_degrees_to_and_fro_are_hardly_turned() -> None:
    step = TurningStep()
    fields(step, 48.0 * sphere(20_000)[:10] + IRON_UT)
    assert "hardly turned" in (step.missing() or "")


def test_turned_like_a_compass_is_about_one_axis_only() -> None:
    step = TurningStep()
    level = sphere(2000) * [1.0, 1.0, 0.1]
    fields(step, 48.0 * level + IRON_UT)
    assert "about one axis only" in (step.missing() or "")
    assert step.wanted() == step.missing(), "the guide goes on asking"


def test_an_octant_that_was_not_seen_is_asked_for() -> None:
    turned = sphere(2000)
    seen = turned[(turned <= -0.1).any(axis=1)]
    step = TurningStep()
    fields(step, 48.0 * seen)
    assert "only 7 of 8 parts of the sphere" in (step.missing() or "")


@pytest.mark.parametrize(
    ("field_ut", "strange"), [(14.0, True), (16.0, False), (88.0, False), (95.0, True)]
)
def test_a_field_that_is_not_the_earth_s_is_refused(field_ut: float, strange: bool) -> None:
    step = TurningStep()
    fields(step, field_ut * sphere(2000))
    assert ("uT, which is not the earth's" in (step.missing() or "")) is strange


@pytest.mark.parametrize("axis", range(3))
@pytest.mark.parametrize("times", [0.25, 2.2])
def test_one_axis_is_enough_to_make_a_field_strange(axis: int, times: float) -> None:
    scale = np.full(3, 48.0)
    scale[axis] *= times
    step = TurningStep()
    fields(step, scale * sphere(2000))
    assert "not the earth's" in (step.missing() or "")


@pytest.mark.parametrize(("span_degc", "lacks"), [(9.8, True), (10.3, False)])
def test_ten_degrees_are_needed(span_degc: float, lacks: bool) -> None:
    bench = Bench(WarmUpStep())
    bench.lies(Z, 100.0, degc=(12.0, 12.0 + span_degc))
    assert (bench.step.missing() is not None) is lacks
    assert bench.step.wanted() == bench.step.missing()
    if lacks:
        assert "the temperature changed by only 9.7 degC" in (bench.step.missing() or "")
        assert bench.step.progress() == "9.7 of 10 degC"


def test_warm_up_step_accepts_cooling_down() -> None:
    bench = Bench(WarmUpStep())
    bench.lies(Z, 100.0, degc=(35.0, 22.0))
    assert bench.step.missing() is None


@pytest.mark.parametrize(("lay_s", "lacks"), [(80.5, True), (81.5, False)])
def test_eighty_seconds_are_needed(lay_s: float, lacks: bool) -> None:
    bench = Bench(WarmUpStep())
    bench.lies(Z, lay_s, degc=(5.0, 25.0))
    assert ("80 s are needed" in (bench.step.missing() or "")) is lacks


def test_a_unit_that_was_moved_while_it_warmed_is_reported_so() -> None:
    bench = Bench(WarmUpStep())
    bench.lies(Z, 60.0, degc=(8.0, 15.0))
    bench.lies(X, 50.0, degc=(15.0, 20.0))
    assert "it was moved; while it lay still the temperature changed by only 6.8" in (
        bench.step.missing() or ""
    )


def test_samples_without_a_temperature_do_not_count() -> None:
    step = WarmUpStep()
    bench = Bench(step)
    bench.lies(Z, 30.0)
    bench.lies(Z, 100.0, degc=(8.0, 20.0))
    assert len(step.windows()) == 199
    assert step.missing() is None


@pytest.mark.parametrize("wrong", [slice(0, 2), slice(90, 93), slice(-2, None)])
@pytest.mark.parametrize("degc", [-40.0, 85.0])
def test_temperatures_that_were_misread_warm_nothing_up(wrong: slice, degc: float) -> None:
    """A sensor's answer is lost for a moment: all ones, all noughts."""
    step = WarmUpStep()
    bench = Bench(step)
    bench.lies(Z, 100.0, degc=(12.0, 21.0))
    (windows,) = step._finder.rests
    whole = step.windows()
    windows[wrong] = [replace(window, temperature_degc=degc) for window in windows[wrong]]
    assert "changed by only" in (step.missing() or "")
    assert all(12.0 < window.temperature_degc < 21.0 for window in step.windows())
    assert len(step.windows()) == len(whole) - len(range(len(whole))[wrong])


def test_a_coarse_thermometer_is_not_misread() -> None:
    step = WarmUpStep()
    bench = Bench(step)
    for number in range(12):
        bench.lies(Z, 10.0, degc=(10.0 + number, 10.0 + number))
    assert len(step.windows()) == 238
    assert step.missing() is None


@pytest.mark.parametrize(("noise_degc", "refused"), [(0.5, False), (3.0, True), (6.0, True)])
def test_a_thermometer_s_noise_warms_nothing_up(noise_degc: float, refused: bool) -> None:
    step = WarmUpStep()
    bench = Bench(step)
    bench.lies(Z, 300.0, degc=(12.0, 24.0 if not refused else 12.0))
    (windows,) = step._finder.rests
    noise = np.random.default_rng(1).normal(0.0, noise_degc, len(windows))
    windows[:] = [
        replace(window, temperature_degc=window.temperature_degc + off)
        for window, off in zip(windows, noise.tolist(), strict=True)
    ]
    assert ("jumps about" in (step.missing() or "")) is refused
    assert (step.missing() is not None) is refused
