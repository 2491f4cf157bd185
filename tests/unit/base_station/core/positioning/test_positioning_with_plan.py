"""The station's pipeline with a plan: floors, the pressure reference, units without contact, and
backfilled fixes.
"""

from __future__ import annotations

import math

import pytest

from base_station.core.checkpoint import read_checkpoint
from base_station.core.events import Refused
from base_station.core.positioning.building_entry import is_outside
from base_station.site.reachability import SECTORS
from base_station.storage.db.known_people import person_lookup
from base_station.views.station import StationFacts, snapshot
from edge.simulation.building import plan_path
from shared.channels import GPS, backfilled_key
from shared.codec import encode
from shared.geo import Anchor, pressure_pa_at
from shared.messages import FusedPosition
from shared.messages.pins import SetPin
from shared.messages.station import SetAnchor, SetPlan, SetReference, SetStart
from tests.rig import message_factory
from tests.rig.live_station import make_pipeline
from tests.rig.station_script import Script

U = "FF-01"
CORRIDOR_NORTH_M, CORRIDOR_EAST_M = 7.0, 12.0
SITE_M = 50.0


@pytest.fixture
def script() -> Script:
    script = Script()
    script.register(U)
    script.act(SetPlan(plan_path().read_bytes()))
    script.act(SetStart(U, CORRIDOR_NORTH_M, CORRIDOR_EAST_M, 0.0, 0.0, 0.2, 0.05))
    return script


def reference(script: Script) -> str | None:
    return script.pipeline.state.site.barometers.reference_id


def test_floor_has_a_probability(script: Script) -> None:
    script.position(U, 0.0, 0.0)
    on_floor = script.fused[-1]
    assert on_floor.floor == 0
    assert on_floor.floor_probability is not None
    assert on_floor.floor_probability > 0.95
    script.position(U, 0.0, 0.0, down_m=-1.6)
    between = script.fused[-1].floor_probability
    assert between is not None
    assert between < 0.7


def test_only_a_registered_unit_can_be_the_reference(script: Script) -> None:
    outputs = script.act(SetReference("FF-99", 0.0))
    assert isinstance(outputs[0], Refused)
    assert script.act(SetReference(U, math.nan)) != []
    assert reference(script) is None
    script.act(SetReference(U, -1.0))
    assert reference(script) == U
    script.act(SetReference("", 0.0))
    assert reference(script) is None


def test_weather_moves_no_wearer_at_rest(script: Script) -> None:
    """350 Pa in an hour, here in ten minutes of it; the reference stands at the station."""
    script.register("REF")
    script.act(SetReference("REF", 0.0))

    def each_second() -> None:
        pressure_pa = pressure_pa_at(SITE_M) + 350.0 * script.now_s / 3600.0
        script.position("REF", 0.0, 0.0, pressure_pa=pressure_pa)
        script.position(U, 0.0, 0.0, pressure_pa=pressure_pa - 40.0)

    script.wait(600, each_second)
    ours = [fused for fused in script.fused if fused.unit_id == U]
    assert {fused.floor for fused in ours} == {0}
    assert abs(ours[-1].down_m) < 0.5


@pytest.mark.parametrize(
    ("north_m", "east_m", "feels_it"),
    [(-20.0, 12.0, True), (-2.0, 12.0, False), (7.0, 20.0, False)],
    ids=["outside", "at the wall", "inside"],
)
def test_weather_is_measured_by_units_outside_and_not_by_doors_and_fans(
    script: Script, north_m: float, east_m: float, feels_it: bool
) -> None:
    """Units inside keep the height that agrees with the air outside."""
    script.register("FF-02")
    script.act(SetStart("FF-02", north_m, east_m, 0.0, 0.0, 0.2, 0.05))

    def each_second() -> None:
        pressure_pa = pressure_pa_at(SITE_M) + 60.0 * script.now_s / 60.0
        script.position("FF-02", 0.0, 0.0, pressure_pa=pressure_pa)

    script.wait(60, each_second)
    weather = script.pipeline.state.site.barometers.weather
    assert weather.is_known(script.t_ns) is feels_it
    assert weather.rise_m == pytest.approx(-5.0 if feels_it else 0.0, abs=1.0)


@pytest.mark.parametrize(
    ("since_gps_s", "outside"), [(None, False), (0.5, True), (4.5, True), (5.5, False)]
)
def test_unit_with_a_recent_fix_is_outside_without_a_plan(
    script: Script, since_gps_s: float | None, outside: bool
) -> None:
    script.position(U, 0.0, 0.0)
    history = script.pipeline.state.paths[U]
    history.latest.since_gps_s = since_gps_s
    assert is_outside(None, history) is outside


def test_pin_that_rejects_fixes_changes_no_weather() -> None:
    """Two units walk alike in the same air; the fixes of one contradict its pin."""
    anchor, rises_m = Anchor(52.0, 4.0, 0.0, 0.0), {}
    for is_pinned in (False, True):
        script = Script()
        script.register(U)
        script.act(SetAnchor(52.0, 4.0, 0.0, 0.0))
        script.act(SetStart(U, 0.0, 0.0, 0.0, 0.0, 30.0, 0.05))
        for second in range(25):
            script.now_s += 1.0
            pressure_pa = pressure_pa_at(SITE_M) + 1.0 * second
            script.position(U, 1.0 * second, 0.0, distance_m=1.0 * second, pressure_pa=pressure_pa)
            if second == 5 and is_pinned:
                script.act(SetPin("p", U, script.t_ns, 5.0, 50.0, 0.3, None, None, 0.0, ""))
                assert script.pipeline.state.site.pin_verdicts["p"].state == "used"
            if second > 5:
                script.gps(U, *anchor.to_geodetic(1.0 * second, 0.0, 0.0)[:2])
        assert (script.fused[-1].since_gps_s is None) is is_pinned
        rises_m[is_pinned] = script.pipeline.state.site.barometers.weather.rise_m
    assert rises_m[True] == rises_m[False] != 0.0


def test_unit_without_contact_stays_within_walls(script: Script) -> None:
    script.wait(3, lambda: script.position(U, 0.0, 0.0))
    assert script.pipeline.state.units[U].place.reach == ()
    script.wait(20)
    state = script.pipeline.state
    view = snapshot(state, 1, StationFacts(), person_lookup({})).units[0].position
    assert view is not None
    widths = [math.dist(point, (CORRIDOR_EAST_M, CORRIDOR_NORTH_M)) for point in view.reach]
    assert max(widths) > 9.0, "along the corridor"
    assert min(widths) < view.ellipse_minor_m / 2.0, "the walls"
    script.wait(1, lambda: script.position(U, 0.0, 0.0))
    assert state.units[U].place.reach == ()


@pytest.mark.parametrize(("away_s", "most_m"), [(5, 8.0), (20, 11.0), (60, 27.0), (3600, 110.0)])
def test_restarted_unit_is_known_no_better_than_without_contact(
    script: Script, away_s: int, most_m: float
) -> None:
    """A battery is changed: the wearer may walk meanwhile."""
    script.act(SetStart("FF-01", 0.0, 0.0, 0.0, 0.0, 0.5, 0.05))
    script.position("FF-01", 0.0, 0.0)
    script.boot_ids["FF-01"] = 8
    script.now_s += away_s
    script.position("FF-01", 0.0, 0.0)
    std_m = script.fused[-1].std_north_m
    assert max(5.0, 0.4 * min(away_s, 250)) < std_m < most_m


def test_backfilled_fixes_correct_the_present_place(script: Script) -> None:
    """The unit begins 6 m from its assumed start; its fixes of the silent minute come late."""
    script.act(SetAnchor(52.0, 4.0, 10.0, 0.0))
    script.act(SetStart(U, -60.0, 0.0, 0.0, 0.0, 10.0, 0.05))
    anchor = script.pipeline.state.site.anchor
    assert anchor is not None
    late = []
    for second in range(60):
        script.now_s += 1.0
        script.position(U, float(second), 0.0)
        lat_deg, lon_deg, height_m = anchor.to_geodetic(-60.0 + second, 6.0, 0.0)
        stds = {"horizontal_std_m": 2.0, "vertical_std_m": 4.0}
        late.append(
            message_factory.gps_fix(script.header(U), lat_deg, lon_deg, height_m=height_m, **stds)
        )
    assert script.fused[-1].east_m == pytest.approx(0.0, abs=0.5)
    for fix in late:
        outputs = script.record(backfilled_key(U, GPS.suffix), encode(fix))
        assert any(isinstance(output, FusedPosition) for output in outputs)
    assert script.fused[-1].east_m == pytest.approx(6.0, abs=2.0)
    assert script.record(backfilled_key(U, GPS.suffix), encode(late[0])) == [], "a second copy"


def test_restarted_station_shows_the_same_as_a_running_one(script: Script) -> None:
    """The steps of the last second are in no checkpoint."""
    script.wait(3, lambda: script.position(U, 0.0, 0.0))
    script.wait(40)
    anew = Script(make_pipeline(read_checkpoint(script.pipeline.checkpoint())))
    anew.now_s = script.now_s
    reaches = []
    for station in (script, anew):
        station.wait(1)
        reaches.append(station.pipeline.state.units[U].place.reach)
    assert len(reaches[0]) == SECTORS
    assert reaches[0] == reaches[1]
