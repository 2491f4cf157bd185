"""Wearers without contact who report their place by voice are shown there."""

from __future__ import annotations

import math

import pytest

from base_station.core.checkpoint import read_checkpoint
from base_station.storage.db.known_people import person_lookup
from base_station.views.station import StationFacts, snapshot
from shared.messages import FusedPosition
from shared.messages.pins import RemovePin, SetMeeting, SetPin
from shared.messages.station import SetPlan, SetStart
from tests.rig.live_station import make_pipeline
from tests.rig.round_walk import PLAN
from tests.rig.station_script import Script

U, OTHER = "FF-01", "FF-02"
WALKED_S = 30
SILENT_S = 120.0
STAIRS_M = (28.0, 35.0)


@pytest.fixture
def script() -> Script:
    """A wearer who walked east along a corridor on the ground floor, and has no contact for
    long.
    """
    script = Script()
    script.register(U, OTHER)
    script.act(SetPlan(PLAN))
    script.act(SetStart(U, 10.0, 2.0, 0.0, 0.0, 0.3, 0.05))
    walk(script, 0, WALKED_S)
    script.now_s += SILENT_S
    script.tick()
    return script


def walk(script: Script, begin: int, end: int) -> None:
    for second in range(begin, end):
        script.now_s += 1.0
        script.position(U, 0.0, 0.9 * second, distance_m=0.9 * second)


def pin(
    script: Script,
    place_m: tuple[float, float] = STAIRS_M,
    ago_s: float = 0.0,
    floor: int | None = 1,
    pin_id: str = "p",
) -> None:
    t_ns = script.t_ns - round(ago_s * 1e9)
    script.act(SetPin(pin_id, U, t_ns, *place_m, 1.0, floor, None, 0.0, "by voice"))


def shown(script: Script) -> FusedPosition:
    fused = script.pipeline.state.units[U].place.fused
    assert fused is not None
    return fused


def far_m(one: FusedPosition, place_m: tuple[float, float]) -> float:
    return math.dist((one.north_m, one.east_m), place_m)


def test_wearer_is_shown_at_the_reported_place_and_floor(script: Script) -> None:
    pin(script)
    reported = shown(script)
    assert script.fused[-1] == reported, "it is in the log"
    assert (reported.north_m, reported.east_m, reported.floor) == (*STAIRS_M, 1)
    assert reported.std_north_m == reported.std_east_m == 1.0
    assert reported.down_m == pytest.approx(-3.2)
    assert reported.floor_probability is not None
    assert reported.floor_probability > 0.9
    assert reported.t_meas_ns == script.t_ns


def test_region_grows_from_there(script: Script) -> None:
    grown = region_m(script)
    pin(script)
    assert region_m(script) < 3.0 < 20.0 < grown
    script.now_s += 60.0
    script.tick()
    assert region_m(script) > 20.0


def region_m(script: Script) -> float:
    seen = snapshot(script.pipeline.state, 1, StationFacts(), person_lookup({}))
    (view,) = (one for one in seen.units if one.unit_id == U)
    assert view.position is not None
    return view.position.ellipse_major_m


def test_place_without_a_floor_is_on_the_known_one(script: Script) -> None:
    before = shown(script)
    pin(script, floor=None)
    assert far_m(shown(script), STAIRS_M) == 0.0
    assert (shown(script).floor, shown(script).down_m) == (before.floor, before.down_m)


def test_newest_report_counts_and_a_removed_one_does_not(script: Script) -> None:
    before = shown(script)
    pin(script, ago_s=5.0)
    pin(script, (20.0, 20.0), ago_s=40.0, pin_id="earlier")
    assert far_m(shown(script), STAIRS_M) == 0.0
    script.act(RemovePin("p"))
    assert far_m(shown(script), (20.0, 20.0)) == 0.0
    script.act(RemovePin("earlier"))
    now = shown(script)
    assert (now.north_m, now.east_m, now.floor, now.t_meas_ns) == (
        before.north_m,
        before.east_m,
        before.floor,
        before.t_meas_ns,
    )


def test_backfilled_earlier_positions_move_no_member_back(script: Script) -> None:
    pin(script)
    walked = script.now_s
    script.now_s = walked - SILENT_S / 2
    script.position(U, 0.0, 0.9 * WALKED_S, distance_m=0.9 * WALKED_S)
    script.now_s = walked
    assert far_m(shown(script), STAIRS_M) == 0.0


def test_regained_contact_continues_from_there(script: Script) -> None:
    pin(script, (10.0, 30.0), floor=0)
    walk(script, WALKED_S, WALKED_S + 5)
    assert script.pipeline.state.site.pin_verdicts["p"].state == "used"
    assert far_m(shown(script), (10.0, 30.0 + 0.9 * 5)) < 2.0
    assert shown(script).t_meas_ns == script.t_ns


def test_trail_holds_walked_places_only(script: Script) -> None:
    pin(script)
    trail = script.pipeline.state.units[U].trails.shown
    assert all(math.dist((step.north_m, step.east_m), STAIRS_M) > 5.0 for step in trail)


def test_encounter_does_not_place_them(script: Script) -> None:
    before = shown(script)
    script.act(SetMeeting("m", U, OTHER, script.t_ns, 1.0, ""))
    assert far_m(shown(script), (before.north_m, before.east_m)) < 0.1


def test_restarted_station_shows_the_same(script: Script) -> None:
    pin(script)
    again = make_pipeline(read_checkpoint(script.pipeline.checkpoint()))
    assert again.state.units[U].place.fused == shown(script)
