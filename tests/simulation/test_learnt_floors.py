"""Floors without a plan: learnt from level walks, shared, and learnt again."""

from __future__ import annotations

import pytest

from base_station.core.checkpoint import read_checkpoint
from base_station.core.events import Refused
from base_station.replay.playback import compare
from shared.channels import channel_of
from shared.codec import encode
from shared.messages import STATION_ID, FusedPosition
from shared.messages.pins import RemovePin, SetPin
from shared.messages.station import (
    CloseIncident,
    ForgetWearers,
    OpenIncident,
    SetAnchor,
    SetPlan,
    SetStart,
)
from tests.rig.live_station import make_pipeline
from tests.rig.station_script import Script

STOREY_M = 3.4
PLAN = (
    b'{"type":"FeatureCollection","muster":{"frame":"site-m","floors":[{"floor":5,"down_m":0},'
    b'{"floor":6,"down_m":-3.4},{"floor":7,"down_m":-6.8}]},"features":[]}'
)


class People:
    """Walk about on floors and climb between them; a metre a second, stairs 0.2 m a second."""

    def __init__(self, *unit_ids: str) -> None:
        self.script = Script()
        self.script.register(*unit_ids)
        self.script.act(OpenIncident("i1", "Mill Lane"))
        self.down_m = dict.fromkeys(unit_ids, 0.0)
        self.north_m = dict.fromkeys(unit_ids, 0.0)
        self.walked_m = dict.fromkeys(unit_ids, 0.0)

    def walk(self, unit_id: str, way_m: int) -> None:
        """To and fro."""
        for second in range(way_m):
            ahead_m = 1.0 if (second // 10) % 2 == 0 else -1.0
            self._say(unit_id, ahead_m, 0.0, 1.0)

    def climb(self, unit_id: str, storeys: float, storey_m: float = STOREY_M) -> None:
        """In flights of half a storey, as stairs are built."""
        for _ in range(round(abs(storeys) * 17)):
            self._say(unit_id, 0.0, -storeys / abs(storeys) * storey_m / 17.0, 0.3)

    def floor(self, unit_id: str) -> int | None:
        fused = self.script.pipeline.state.units[unit_id].place.fused
        assert fused is not None
        return fused.floor

    def sure(self, unit_id: str) -> float:
        fused = self.script.pipeline.state.units[unit_id].place.fused
        assert fused is not None
        return fused.floor_probability or 0.0

    def seen(self) -> dict[int, float]:
        """Storeys that somebody walked on, and their heights."""
        storeys = self.script.pipeline.state.site.storeys_at(0.0, 0.0)
        return {one.floor: round(-one.down_m, 1) for one in storeys if one.seen}

    def _say(self, unit_id: str, ahead_m: float, down_m: float, way_m: float) -> None:
        self.script.now_s += 1.0
        self.north_m[unit_id] += ahead_m
        self.down_m[unit_id] += down_m
        self.walked_m[unit_id] += way_m
        self.script.position(
            unit_id,
            self.north_m[unit_id],
            0.0,
            down_m=self.down_m[unit_id],
            distance_m=self.walked_m[unit_id],
        )


@pytest.fixture
def people() -> People:
    """Two; one has been on the ground floor, the first and the third."""
    people = People("FF-01", "FF-02")
    people.script.act(SetStart("FF-01", 0.0, 0.0, 0.0, 0.0, 0.5, 0.1))
    people.walk("FF-01", 20)
    people.climb("FF-01", 1)
    people.walk("FF-01", 20)
    people.climb("FF-01", 2)
    people.walk("FF-01", 20)
    return people


def test_floors_are_numbered_from_the_ground_where_people_walk(people: People) -> None:
    assert people.floor("FF-01") == 3
    assert people.sure("FF-01") > 0.9
    assert people.seen() == pytest.approx({0: 0.0, 1: 3.4, 3: 10.2}, abs=0.3)


def test_learnt_floor_is_shared_with_other_units(people: People) -> None:
    alone = People("FF-02")
    for one in (alone, people):
        one.walk("FF-02", 20)
        one.climb("FF-02", 2)
    assert people.floor("FF-02") == alone.floor("FF-02") == 2
    assert people.sure("FF-02") > alone.sure("FF-02")


def test_learnt_storey_corrects_a_returning_unit(people: People) -> None:
    """Stairs that are seen a tenth too high, over and over, do not lead away from the floors."""
    for _ in range(4):
        people.climb("FF-01", -3, STOREY_M * 1.05)
        people.walk("FF-01", 20)
        people.climb("FF-01", 3, STOREY_M * 1.0)
        people.walk("FF-01", 20)
    assert people.floor("FF-01") == 3
    assert people.seen()[0] == pytest.approx(0.0, abs=0.5)


def test_erased_unit_is_removed_from_the_learnt_floors(people: People) -> None:
    people.walk("FF-02", 20)
    people.script.act(CloseIncident("i1"))
    people.script.act(ForgetWearers("FF-01"))
    assert people.seen() == {0: 0.0}


def test_incident_starts_without_learnt_floors_of_the_previous_one(people: People) -> None:
    people.script.act(CloseIncident("i1"))
    people.script.now_s += 10.0
    people.script.act(OpenIncident("i2", "Elm Street"))
    assert people.seen() == {}


def test_plan_replaces_learnt_floors(people: People) -> None:
    people.script.act(SetPlan(PLAN))
    people.walk("FF-01", 1)
    assert people.floor("FF-01") == 7
    assert people.sure("FF-01") < 1.0


def test_floor_of_a_pin_numbers_the_storeys_until_the_pin_is_removed(
    people: People,
) -> None:
    script = people.script
    script.act(SetPin("p1", "FF-01", script.t_ns, 0.0, 0.0, 5.0, 2, None, 0.0, ""))
    people.walk("FF-01", 1)
    assert people.floor("FF-01") == 2
    assert people.seen() == pytest.approx({0: 0.0, 1: 3.4, 2: 10.2}, abs=0.3)
    script.act(RemovePin("p1"))
    people.walk("FF-01", 1)
    assert people.floor("FF-01") == 3


def test_conflicting_pin_numbers_no_floors(people: People) -> None:
    script = people.script
    script.act(SetPin("p1", "FF-01", script.t_ns, 0.0, 500.0, 1.0, 2, None, 0.0, ""))
    assert script.pipeline.state.site.pin_verdicts["p1"].state == "conflict"
    people.walk("FF-01", 1)
    assert people.floor("FF-01") == 3


def test_impossible_floor_of_a_pin_is_refused(people: People) -> None:
    pin = SetPin("p1", "FF-01", people.script.t_ns, 0.0, 0.0, 1.0, 1000, None, 0.0, "")
    (refused,) = people.script.act(pin)
    assert isinstance(refused, Refused)
    assert "no building has a floor 1000" in refused.reason


def test_start_upstairs_is_no_ground_floor(people: People) -> None:
    people.script.act(SetStart("FF-02", 0.0, 0.0, -10.2, 0.0, 0.5, 3.2))
    people.walk("FF-02", 20)
    assert people.floor("FF-02") == 3
    assert people.seen()[0] == pytest.approx(0.0, abs=0.3)


def test_unit_without_a_reported_start_has_an_assumed_floor(people: People) -> None:
    people.walk("FF-02", 20)
    assert people.floor("FF-02") == 0
    assert people.sure("FF-02") < 0.5
    people.script.act(SetStart("FF-02", 0.0, 0.0, 0.0, 0.0, 0.5, 0.1))
    people.walk("FF-02", 1)
    assert people.sure("FF-02") > 0.9


def test_separate_buildings_have_separate_floors(people: People) -> None:
    people.script.act(SetStart("FF-02", 200.0, 0.0, 0.0, 0.0, 0.5, 0.1))
    people.north_m["FF-02"] = 0.0
    people.walk("FF-02", 20)
    people.climb("FF-02", 1, 5.0)
    people.walk("FF-02", 20)
    assert people.floor("FF-02") == 1
    heights = [
        one.down_m for one in people.script.pipeline.state.site.storeys_at(200.0, 0.0) if one.seen
    ]
    assert heights == pytest.approx([0.0, -5.0], abs=0.3)
    assert people.seen()[1] == pytest.approx(3.4, abs=0.3)


def test_change_of_frame_moves_heights_and_keeps_floors(people: People) -> None:
    people.script.gps("FF-01", 52.0, 4.0)
    people.script.act(SetAnchor(52.0, 4.0001, 20.0, 0.3))
    people.walk("FF-01", 1)
    fused = people.script.pipeline.state.units["FF-01"].place.fused
    assert fused is not None
    assert people.floor("FF-01") == 3


def test_replay_and_restarted_station_show_the_same_floors(people: People) -> None:
    people.walk("FF-02", 20)
    people.climb("FF-02", 1)
    saved = read_checkpoint(people.script.pipeline.checkpoint())
    again = Script(make_pipeline(saved))
    again.now_s, again._seqs = people.script.now_s, dict(people.script._seqs)
    live = people.script
    people.walk("FF-02", 12)
    for t_ns, key, payload in live.records[-12:]:
        again.now_s = (t_ns - live.records[0][0]) / 1e9
        again.record(key, payload)
    assert again.fused[-1] == live.fused[-1]
    assert live.fused[-1].floor == 1
    logged = []
    replayed = Script(make_pipeline())
    for t_ns, key, payload in live.records:
        replayed.now_s = (t_ns - live.records[0][0]) / 1e9
        logged.append((t_ns, key, payload))
        decided = [one for one in replayed.record(key, payload) if isinstance(one, FusedPosition)]
        logged += [(t_ns, channel_of(one).key(STATION_ID), encode(one)) for one in decided]
    assert list(compare(logged, make_pipeline())) == []
