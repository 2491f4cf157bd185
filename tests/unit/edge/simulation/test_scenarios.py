"""The built-in scenarios and the content of a scenario file."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise
from pathlib import Path
from typing import get_args

import numpy as np
import pytest

from edge.samples import AmbientSample, BatterySample, Floats, GpsSample, OtherSample
from edge.simulation.building import load_building
from edge.simulation.factory import open_simulation
from edge.simulation.gait import WALK
from edge.simulation.kinematics import Motion
from edge.simulation.legs import (
    Kneel,
    Leg,
    Pace,
    Point,
    Sit,
    Spiral,
    StairsLeg,
    Stand,
    Turn,
    Wait,
    Walk,
)
from edge.simulation.scenario import Scenario
from edge.simulation.scenarios import SCENARIOS
from edge.simulation.simulation import IDEAL_SENSORS, Simulation
from edge.sources.simulated import SimulatedSource
from shared.errors import ConfigError
from shared.geo import Anchor
from shared.messages.status import Activity
from tests.conftest import PROJECT_ROOT

HOUSE = load_building()
NAMES = [scenario.name for scenario in SCENARIOS]
WORKERS = ["search-ground-floor", "climbs-stairs", "goes-down", "gets-hot", "loses-radio"]


def others(simulation: Simulation, until_s: float) -> Iterator[OtherSample]:
    for batch in simulation.batches(1.0):
        yield from (other for other in batch.others if other.t_ns <= until_s * 1e9)
        if batch.imu.t_ns[-1] > until_s * 1e9:
            return


def start_of(simulation: Simulation, activity: Activity) -> float:
    plan = simulation.plan
    return plan.activity_start_s[plan.activities.index(activity)]


def crosses(a: Floats, b: Floats, c: Point, d: Point) -> bool:
    """True if the segments a-b and c-d properly cross."""

    def side(p: Floats | Point, q: Floats | Point, r: Floats | Point) -> float:
        return float((q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0]))

    return side(a, b, c) * side(a, b, d) < 0 and side(c, d, a) * side(c, d, b) < 0


@pytest.mark.slow
@pytest.mark.parametrize("name", NAMES)
def test_every_scenario_starts_still_and_tells_what_it_is(name: str) -> None:
    simulation = open_simulation(name)
    assert simulation.scenario.summary
    assert simulation.activity(1.0) is Activity.STILL
    speed = np.linalg.norm(simulation.truth(np.linspace(0.0, 2.5, 50)).velocity_n_mps, axis=1)
    assert speed.max() < 0.01


@pytest.mark.slow
@pytest.mark.parametrize("name", WORKERS)
def test_workers_go_in_after_gps_outside_and_last_ten_minutes(name: str) -> None:
    simulation = open_simulation(name)
    assert simulation.duration_s > 600.0
    assert simulation.scenario.building
    modes = [s.fix_type for s in others(simulation, 20.0) if isinstance(s, GpsSample)]
    assert modes[0] == 3
    assert modes[-1] == 0, "inside there is no fix"


@pytest.mark.slow
@pytest.mark.parametrize("name", [s.name for s in SCENARIOS if s.building])
def test_simulated_paths_cross_no_wall(name: str) -> None:
    simulation = open_simulation(name)
    t_s = np.arange(0.0, min(300.0, simulation.duration_s), 0.2)
    path = simulation.truth(t_s).position_n_m
    for before, after in pairwise(path):
        floor = int(np.argmin([abs(before[2] - down_m) for down_m in HOUSE.floors_down_m]))
        for wall_floor, one_end, other_end in HOUSE.walls:
            if wall_floor == floor:
                assert not crosses(before[:2], after[:2], one_end, other_end), before


def test_the_stairs_lead_to_the_upper_floor_and_back() -> None:
    simulation = open_simulation("climbs-stairs")
    down_s, up_s = (
        start_of(simulation, Activity.STAIRS_DOWN),
        start_of(simulation, Activity.STAIRS_UP),
    )
    assert 10.0 < up_s < 25.0
    heights = simulation.truth(np.array([up_s, down_s, down_s + 30.0])).position_n_m[:, 2]
    assert heights - heights[0] == pytest.approx([0.0, -3.2, 0.0], abs=0.15)


def test_fallen_wearer_does_not_move_again() -> None:
    simulation = open_simulation("goes-down?seed=3")
    lying_s = start_of(simulation, Activity.LYING)
    assert 15.0 < lying_s < 25.0
    motion = simulation.truth(np.linspace(lying_s + 0.1, 600.0, 500))
    assert np.abs(motion.velocity_n_mps).max() == 0.0
    assert np.abs(motion.rate_b_radps).max() == 0.0


@pytest.mark.slow
def test_the_heat_passes_every_threshold_and_falls_again() -> None:
    simulation = open_simulation("gets-hot")
    heat = {
        s.t_ns // 1_000_000_000: s.temperature_degc
        for s in others(simulation, 200.0)
        if isinstance(s, AmbientSample)
    }
    assert heat[1] < 30.0
    passed_s = [min(t for t, value in heat.items() if value > level) for level in (100, 160, 260)]
    assert passed_s == sorted(passed_s)
    assert passed_s[0] >= 20
    assert passed_s[2] <= 45
    assert heat[190] < 60.0


def test_longer_approach_delays_all_events() -> None:
    near, far = open_simulation("goes-down"), open_simulation("goes-down?from=-38,11")
    began = far.truth(np.array([0.0])).position_n_m[0]
    assert began[:2] == pytest.approx([-38.0, 11.0], abs=0.5)
    later_s = start_of(far, Activity.LYING) - start_of(near, Activity.LYING)
    assert later_s == pytest.approx(3.0 + 30.0 / 1.35, abs=3.0)
    names = ("loses-radio", "loses-radio?from=-38,12")
    first, later = (SimulatedSource(name).radio_outages[0].start_s for name in names)
    assert later - first == pytest.approx(later_s, abs=4.0)


@pytest.mark.parametrize("place", ["", "here", "1", "1,2,3", "nan,0", "0,inf", "1e9,0"])
def test_a_place_that_is_none_is_refused(place: str) -> None:
    with pytest.raises(ConfigError, match="NORTH,EAST"):
        open_simulation(f"goes-down?from={place}")


SYDNEY = Anchor(-33.87, 151.21, 20.0)


@pytest.mark.parametrize(
    ("anchor", "field_ut"),
    [
        (None, (16.1, 1.5, 48.5)),
        (SYDNEY, (24.0, 5.5, -51.4)),
        (Anchor(-33.87, 151.21, 20.0, np.pi / 2.0), (5.5, -24.0, -51.4)),
    ],
    ids=["the house", "Sydney", "turned to the east"],
)
def test_the_magnetic_field_is_that_of_the_site(
    anchor: Anchor | None, field_ut: tuple[float, float, float]
) -> None:
    """World Magnetic Model 2025, in the axes of the site."""
    scenario = Scenario("test", "", (Stand(1.0),), anchor=anchor)
    simulation = Simulation(scenario, sensors=IDEAL_SENSORS)
    (batch, *_) = simulation.batches()
    assert batch.imu.mag_ut is not None
    rotation_nb = simulation.truth(np.zeros(1)).rotation_nb[0]
    assert rotation_nb @ batch.imu.mag_ut[0] == pytest.approx(field_ut, abs=0.2)


def test_the_radio_is_lost_and_comes_back() -> None:
    outages = SimulatedSource("loses-radio").radio_outages
    assert 20.0 <= outages[0].start_s <= 30.0
    assert outages[0].duration_s > 30.0, "long enough for a link to count as lost"
    assert SimulatedSource("climbs-stairs").radio_outages == ()


def test_the_battery_drains_slowly() -> None:
    levels = [
        s.level
        for s in others(open_simulation("climbs-stairs"), 120.0)
        if isinstance(s, BatterySample)
    ]
    assert levels == sorted(levels, reverse=True)
    assert 0.0 < levels[0] - levels[-1] < 0.02


@pytest.mark.parametrize(
    ("name", "length_m"),
    [("straight", 50.0), ("square-60m", 60.0), ("rectangle", 63.0), ("track-400m", 400.0)],
)
def test_measured_paths_have_their_length(name: str, length_m: float) -> None:
    simulation = open_simulation(name)
    stances = np.array([0.0, *simulation.plan.footfall_s])
    path = simulation.truth(stances).position_n_m[:, :2]
    assert np.hypot(*np.diff(path, axis=0).T).sum() == pytest.approx(length_m, rel=0.02)
    if name != "straight":
        assert path[-1] == pytest.approx(path[0], abs=0.05), "a closed path"


def test_a_foot_stands_flat_between_strides_and_never_below_the_floor() -> None:
    simulation = Simulation(Scenario("test", "", (Walk(((20.0, 0.0), (20.0, 10.0))),)))
    t_s = np.arange(0.0, simulation.duration_s, 0.005)
    motion = simulation.truth(t_s)
    speed = np.linalg.norm(motion.velocity_n_mps, axis=1)
    assert 0.15 < (speed < 0.02).mean() < 0.4
    assert 3.0 < speed.max() < 7.0
    assert -0.35 < motion.position_n_m[:, 2].min() < -0.12
    assert motion.position_n_m[:, 2].max() < -0.07


def test_no_foot_stands_stiller_than_recorded_ones() -> None:
    """In the middle of recorded stances: 1.7 cm/s along the floor, 0.8 up or down, 5.6 deg/s."""
    simulation = Simulation(Scenario("test", "", (Walk(((100.0, 0.0),)),)))
    middle_s = np.array(simulation.plan.footfall_s[:-1]) + 0.5 * WALK.flat * WALK.stride_s
    motion = simulation.truth(middle_s)
    along_mps = np.hypot(motion.velocity_n_mps[:, 0], motion.velocity_n_mps[:, 1])
    assert 0.01 < np.median(along_mps) < 0.025
    assert 0.005 < np.median(np.abs(motion.velocity_n_mps[:, 2])) < 0.012
    assert 4.0 < np.degrees(np.median(np.linalg.norm(motion.rate_b_radps, axis=1))) < 8.0


def test_no_foot_on_the_ground_goes_faster_than_recorded_ones() -> None:
    """In 511 stances of motion capture no foot rose or sank faster than 9.3 cm/s."""
    simulation = Simulation(Scenario("test", "", (Walk(((3000.0, 0.0),)),)))
    middle_s = np.array(simulation.plan.footfall_s[:-1]) + 0.5 * WALK.flat * WALK.stride_s
    up_or_down_mps = np.abs(simulation.truth(middle_s).velocity_n_mps[:, 2])
    assert len(up_or_down_mps) > 2000
    assert 0.05 < up_or_down_mps.max() < 0.1


def test_turning_on_the_spot_faces_the_heading_and_stays() -> None:
    simulation = Simulation(Scenario("test", "", (Stand(1.0), Turn(200.0), Stand(1.0))))
    ends = simulation.truth(np.array([0.0, simulation.duration_s]))
    turned = ends.rotation_nb[1] @ ends.rotation_nb[0].T
    turned_deg = np.degrees(np.arctan2(turned[1, 0], turned[0, 0])) % 360.0
    assert turned_deg == pytest.approx(200.0, abs=8.0)
    assert np.linalg.norm(ends.position_n_m[1] - ends.position_n_m[0]) < 0.25


def ends_of(*legs: Leg) -> tuple[Simulation, Motion]:
    simulation = Simulation(Scenario("test", "", legs))
    return simulation, simulation.truth(np.array([0.0, simulation.duration_s]))


def turned_deg(ends: Motion) -> float:
    turned = ends.rotation_nb[1] @ ends.rotation_nb[0].T
    return float(np.degrees(np.arctan2(turned[1, 0], turned[0, 0])))


@pytest.mark.parametrize("rise_m", [3.0, -3.0])
def test_winding_stairs_end_above_or_below_their_start_turned(rise_m: float) -> None:
    # From the south of the middle one and a quarter turns clockwise to its west, going north.
    _, ends = ends_of(Stand(1.0), Spiral((1.0, 0.0), 450.0, rise_m, 17), Stand(1.0))
    moved_m = ends.position_n_m[1] - ends.position_n_m[0]
    assert moved_m == pytest.approx([1.0, -1.0, -rise_m], abs=0.25)
    # The last foot looks along the chord of the last tread, which is a dozen degrees short.
    assert turned_deg(ends) == pytest.approx(-12.0, abs=8.0)


def test_two_risers_at_once_take_half_the_strides() -> None:
    strides = [
        len(ends_of(StairsLeg((4.5, 0.0), 2.88, 16, at_once))[0].plan.footfall_s)
        for at_once in (1, 2)
    ]
    assert strides == [8, 4]


@pytest.mark.parametrize(("pace", "facing_deg"), [("backwards", 180.0), ("sideways", -90.0)])
def test_a_wearer_may_face_elsewhere_than_he_goes(pace: Pace, facing_deg: float) -> None:
    _, ends = ends_of(Stand(1.0), Turn(facing_deg), Walk(((6.0, 0.0),), pace), Stand(1.0))
    assert ends.position_n_m[1, 0] - ends.position_n_m[0, 0] == pytest.approx(6.0, abs=0.3)
    off_deg = (turned_deg(ends) - facing_deg + 180.0) % 360.0 - 180.0
    assert abs(off_deg) < 10.0


@pytest.mark.parametrize("pace", get_args(Pace))
def test_no_gait_goes_through_the_floor(pace: Pace) -> None:
    simulation = Simulation(Scenario("test", "", (Walk(((9.0, 0.0),), pace),)))
    height_m = -simulation.truth(np.arange(0.0, simulation.duration_s, 0.005)).position_n_m[:, 2]
    # A heel on a slope in the rubble has the instep low.
    assert height_m.min() > (0.02 if pace == "rubble" else 0.055)
    assert (height_m.max() > 0.1) == (pace != "drag")


@pytest.mark.parametrize("leg", [Wait(60.0), Kneel(30.0), Sit(90.0)], ids=["wait", "kneel", "sit"])
def test_lingering_wearer_moves_the_foot_and_gets_up_at_the_same_place(
    leg: Wait | Kneel | Sit,
) -> None:
    simulation, ends = ends_of(Stand(1.0), leg, Stand(2.0))
    t_s = np.arange(0.0, simulation.duration_s, 0.01)
    motion = simulation.truth(t_s)
    moving = np.linalg.norm(motion.velocity_n_mps, axis=1) > 0.02
    assert 0.01 < moving.mean() < 0.5
    assert ends.position_n_m[1, 2] == pytest.approx(ends.position_n_m[0, 2], abs=0.01)
    assert np.linalg.norm(ends.position_n_m[1] - ends.position_n_m[0]) < 0.4
    lifted_m = ends.position_n_m[0, 2] - motion.position_n_m[:, 2].min()
    assert (lifted_m > 0.3) == isinstance(leg, Sit), "only crossed legs take it off the ground"
    assert simulation.duration_s >= leg.duration_s


def test_a_foothold_in_rubble_is_high_and_slopes_and_a_pulled_shoe_slips() -> None:
    rubble = Simulation(Scenario("test", "", (Stand(1.0), Walk(((9.0, 0.0),), "rubble"))))
    footfalls = rubble.truth(np.array(rubble.plan.footfall_s))
    slope_deg = np.degrees(np.arccos(footfalls.rotation_nb[:, 2] @ footfalls.rotation_nb[-1, 2]))
    assert np.ptp(footfalls.position_n_m[:, 2]) > 0.05
    assert slope_deg.max() > 5.0
    hose = Simulation(Scenario("test", "", (Stand(1.0), Walk(((9.0, 0.0),), "hose"))))
    begun_s = np.array(hose.plan.footfall_s[:-1])
    held_m = [hose.plan.north.jet(begun_s + of_stance_s).value for of_stance_s in (0.35, 0.62)]
    assert np.mean(held_m[1] - held_m[0]) < -0.003


TOML = """
summary = "a short round"
building = true
start = [-5.0, 12.0]
ambient_degc = [[0.0, 20.0], [60.0, 80.0]]
radio_outages_s = [[10.0, 5.0]]
[[legs]]
type = "stand"
duration_s = 2.0
[[legs]]
type = "walk"
to = [[-1.5, 12.0], [3.0, 12.0]]
pace = "hurry"
"""


def test_a_scenario_file_is_played(tmp_path: Path) -> None:
    path = tmp_path / "round.toml"
    path.write_text(TOML, encoding="utf-8")
    source = SimulatedSource(f"{path}?seed=2")
    assert source.simulation.scenario.name == "round"
    assert source.radio_outages[0].start_s == 10.0
    assert 5.0 < source.simulation.duration_s < 15.0
    assert sum(len(batch.imu) for batch in source.batches()) == int(
        source.simulation.duration_s * 200.0
    )


@pytest.mark.parametrize(
    ("change", "reported"),
    [
        (("summary", "sumary"), "did you mean summary?"),
        (("duration_s = 2.0", "seconds = 2.0"), "legs[0] (stand)"),
        (('"walk"', '"fly"'), "legs[1] must have a type: one of walk, stairs"),
        (('"hurry"', '"crawl"'), "pace"),
        (("duration_s = 2.0", 'duration_s = "long"'), "duration_s"),
        (("duration_s = 2.0", "duration_s = -2.0"), "duration_s"),
        (("[[0.0, 20.0], [60.0, 80.0]]", "[[60.0, 20.0], [0.0, 80.0]]"), "order of time"),
        (("start =", "rate_hz = 1.0\nstart ="), "rate_hz"),
        (("building = true", "building ="), "is not TOML"),
        (("[[legs]]", "[[loop]]"), "legs"),
        (("[3.0, 12.0]", "[nan, 12.0]"), "legs[1].to[1][0]"),
        (("[3.0, 12.0]", "[3.0, 1e7]"), "legs[1].to[1][1]"),
        (('pace = "hurry"', "rise_m = inf"), "legs[1].rise_m"),
        (("start = [-5.0", "start = [nan"), "start[0]"),
        (("start =", "heading_deg = nan\nstart ="), "heading_deg"),
        (("start =", "anchor = {lat_deg = nan, lon_deg = 0, height_m = 0}\nstart ="), "anchor"),
        (("[60.0, 80.0]", "[60.0, nan]"), "ambient_degc[1][1]"),
        (("[[10.0, 5.0]]", "[[10.0, -5.0]]"), "radio_outages_s[0][1]"),
        (("duration_s = 2.0", "duration_s = 1e-17"), "duration_s"),
    ],
)
def test_a_bad_scenario_file_is_explained(
    tmp_path: Path, change: tuple[str, str], reported: str
) -> None:
    path = tmp_path / "round.toml"
    path.write_text(TOML.replace(*change), encoding="utf-8")
    with pytest.raises(ConfigError) as caught:
        open_simulation(str(path))
    assert reported in str(caught.value)
    assert "round.toml" in str(caught.value)


def test_a_scenario_file_that_is_not_there(tmp_path: Path) -> None:
    with pytest.raises(ConfigError, match="cannot be read"):
        open_simulation(str(tmp_path / "none.toml"))


def test_the_example_of_the_how_to_page_plays(tmp_path: Path) -> None:
    page = (PROJECT_ROOT / "docs" / "howto" / "write-a-scenario.md").read_text(encoding="utf-8")
    path = tmp_path / "page.toml"
    path.write_text(page.split("```toml\n")[1].split("```")[0], encoding="utf-8")
    simulation = open_simulation(str(path))
    assert simulation.activity(30.0) is Activity.LYING
    end = simulation.truth(np.array([simulation.duration_s]))
    assert end.position_n_m[0, :2] == pytest.approx([-8.0, 12.0], abs=0.2)


def test_a_loop_that_takes_no_time_is_one_sentence(tmp_path: Path) -> None:
    """It would be gone round for ever."""
    path = tmp_path / "round.toml"
    turn = 'type = "turn"\nheading_deg = 0.0\n'
    path.write_text(f"duration_s = 60.0\n[[legs]]\n{turn}[[loop]]\n{turn}")
    with pytest.raises(ConfigError, match="the loop of scenario 'round' takes no time"):
        open_simulation(str(path))
