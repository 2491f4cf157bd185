"""Floors of pins: heights that follow from them, and floors that are rejected."""

from __future__ import annotations

import json
from collections.abc import Callable

import pytest

from base_station.core.pins.evidence import encounters_of, evidence_of_site
from base_station.core.state import OWN_SITE_ID
from base_station.core.state.pin import PinVerdict
from base_station.fusion.smoothing import SMOOTHERS
from base_station.fusion.smoothing.interface import Solution
from shared.messages import FusedPosition, Sighting, SightingKind
from shared.messages.pins import PlaceBeacon, RemovePin, SetMeeting, SetPin, StartTogether
from shared.messages.station import SetPlan, SetStart
from tests.rig.round_walk import PLAN
from tests.rig.station_script import Script

STOREY_M = 3.2
STAIRS_S = 20


def tower(storeys: int, storey_m: float = STOREY_M) -> bytes:
    floors = [{"floor": floor, "down_m": -storey_m * floor} for floor in range(storeys)]
    plan = json.loads(PLAN)
    plan["muster"]["floors"] = floors
    return json.dumps(plan).encode()


class Wearer:
    """A wearer who walks on the level at 1 m/s, and climbs on request."""

    def __init__(
        self, storeys: int = 2, unit_id: str = "FF-01", script: Script | None = None
    ) -> None:
        self.script = script or Script()
        self.unit_id = unit_id
        self.script.register(unit_id)
        self.script.act(SetPlan(tower(storeys)))
        self.walked_m = self.down_m = 0.0

    def go(self, seconds: int, climbed_m: float = 0.0) -> None:
        for _ in range(seconds):
            self.script.now_s += 1.0
            self.step(climbed_m / seconds)

    def step(self, climbed_m: float = 0.0) -> None:
        self.walked_m += 1.0
        self.down_m -= climbed_m
        walked = {"down_m": self.down_m, "distance_m": self.walked_m}
        self.script.position(self.unit_id, *self.place, **walked)

    @property
    def place(self) -> tuple[float, float]:
        """To and fro along a corridor."""
        along = self.walked_m % 40.0
        return 5.0 + min(along, 40.0 - along), 10.0

    def start(self, std_m: float = 0.3) -> None:
        self.script.act(SetStart(self.unit_id, 0.0, 0.0, 0.0, 0.0, std_m, 0.05))

    def pin(self, pin_id: str, floor: int | None, note: str = "") -> PinVerdict:
        place = self.place
        self.script.act(
            SetPin(pin_id, self.unit_id, self.script.t_ns, *place, 0.5, floor, None, 0.0, note)
        )
        return self.verdict(pin_id)

    def verdict(self, pin_id: str) -> PinVerdict:
        return self.script.pipeline.state.site.pin_verdicts[pin_id]

    def smoothed(self) -> Solution:
        """The path after smoothing."""
        state = self.script.pipeline.state
        return SMOOTHERS[0].smooth(
            evidence_of_site(state, OWN_SITE_ID, None), encounters_of(state, state.site)
        )

    @property
    def fused(self) -> FusedPosition:
        fused = self.script.pipeline.state.units[self.unit_id].place.fused
        assert fused is not None
        return fused


def test_floor_that_the_path_contradicts_is_kept_and_moves_no_member() -> None:
    """A click while another floor was shown puts nobody between two floors."""
    wearer = Wearer()
    wearer.start()
    wearer.go(60)
    before = wearer.fused
    verdict = wearer.pin("p", 1)
    after = wearer.fused
    assert verdict.state == "conflict"
    assert "3 m above" in verdict.text
    assert (after.floor, after.down_m) == (0, before.down_m)
    assert after.floor_probability == before.floor_probability
    assert (after.north_m, after.east_m) == (before.north_m, before.east_m)


@pytest.mark.parametrize(
    ("stated", "words"),
    [
        (lambda wearer: wearer.pin("p", 0, "lift"), "the pin 'lift'"),
        (lambda wearer: wearer.pin("p", 0), "the pin of 2 minutes before"),
        (
            lambda wearer: wearer.script.act(
                StartTogether("p", ("FF-01",), 0, 5.0, 10.0, 0.5, 0, None, 0.3, "")
            ),
            "the pin at the start",
        ),
    ],
)
def test_two_floors_without_a_climb_are_not_averaged(
    stated: Callable[[Wearer], object], words: str
) -> None:
    """Only these two pins give the height of the start."""
    wearer = Wearer()
    wearer.go(10)
    stated(wearer)
    wearer.go(120)
    verdict = wearer.pin("q", 1)
    assert verdict.state == "conflict"
    assert words in verdict.text
    assert wearer.fused.floor == 0
    assert wearer.fused.down_m == pytest.approx(0.0, abs=0.1)


@pytest.mark.parametrize("storey_m", [2.4, 3.2])
def test_two_floors_at_the_same_time_are_not_averaged_however_low(storey_m: float) -> None:
    wearer = Wearer()
    wearer.script.act(SetPlan(tower(2, storey_m)))
    wearer.go(10)
    wearer.pin("p", 1)
    wearer.go(1)
    assert wearer.pin("q", 0).state == "conflict"
    assert wearer.fused.floor == 1
    assert wearer.fused.down_m == pytest.approx(-storey_m, abs=0.2)


def test_two_floors_that_are_each_possible_are_not_averaged() -> None:
    """The height of the start is known roughly only."""
    wearer = Wearer()
    wearer.start(std_m=1.0)
    wearer.go(4)
    assert wearer.pin("p", 0).state == "used"
    assert wearer.pin("q", 1).state == "conflict"
    assert "the pin of the same time" in wearer.verdict("q").text
    assert wearer.fused.floor == 0
    assert wearer.fused.down_m == pytest.approx(0.0, abs=0.2)


def test_other_of_two_floors_holds_once_one_is_removed() -> None:
    wearer = Wearer()
    wearer.go(10)
    wearer.pin("wrong", 0)
    wearer.go(30)
    assert wearer.pin("right", 1).state == "conflict"
    wearer.script.act(RemovePin("wrong"))
    assert wearer.verdict("right").state == "used"
    assert wearer.fused.floor == 1
    assert wearer.fused.down_m == pytest.approx(-STOREY_M, abs=0.2)


@pytest.mark.parametrize("floor", [1, 3, 9])
def test_unit_switched_on_upstairs_is_on_its_reported_floor(floor: int) -> None:
    """At any height: no reported floor is no evidence of the ground floor."""
    wearer = Wearer(storeys=10)
    wearer.go(60)
    assert wearer.pin("p", floor).state == "used"
    assert wearer.fused.floor == floor
    assert wearer.fused.down_m == pytest.approx(-STOREY_M * floor, abs=0.2)


def test_wearer_who_climbed_may_be_pinned_on_either_floor() -> None:
    wearer = Wearer()
    wearer.start()
    wearer.go(30)
    below = wearer.pin("below", 0)
    wearer.go(STAIRS_S, climbed_m=STOREY_M)
    wearer.go(30)
    above = wearer.pin("above", 1)
    assert (below.state, above.state) == ("used", "used")
    assert (wearer.fused.floor, wearer.verdict("below").state) == (1, "used")


def test_floor_reported_twice_is_accepted() -> None:
    """The path has missed a flight of stairs."""
    wearer = Wearer()
    wearer.start()
    wearer.go(60)
    assert wearer.pin("once", 1).state == "conflict"
    wearer.go(20)
    assert wearer.pin("twice", 1).state == "used"
    assert wearer.verdict("once").state == "used"
    wearer.go(10)
    assert wearer.fused.floor == 1
    assert wearer.fused.down_m == pytest.approx(-STOREY_M, abs=0.5)


def test_one_wrong_floor_is_rejected_also_after_a_long_time() -> None:
    """The certainty of the floor does not fall with the age of the last pin."""
    wearer = Wearer()
    wearer.start()
    wearer.go(1200)
    before = wearer.fused
    assert before.floor_probability is not None
    assert before.floor_probability > 0.99
    assert wearer.pin("p", 1).state == "conflict"
    assert (wearer.fused.floor, wearer.fused.down_m) == (0, before.down_m)


def two(seconds: int) -> tuple[Wearer, Wearer]:
    """Two wearers who walk together up a tower."""
    one = Wearer(storeys=10)
    other = Wearer(storeys=10, unit_id="FF-02", script=one.script)
    go_together(one, other, seconds)
    return one, other


def go_together(one: Wearer, other: Wearer, seconds: int) -> None:
    for _ in range(seconds):
        one.script.now_s += 1.0
        one.step()
        other.step()


def meet(one: Wearer, other: Wearer) -> None:
    t_ns = one.script.t_ns
    one.script.act(SetMeeting("m", one.unit_id, other.unit_id, t_ns, 1.0, ""))


def test_encounter_puts_both_units_on_one_floor() -> None:
    """Nothing else gives the height of its start: no satellites, and no start position."""
    one, other = two(30)
    one.pin("p", 7)
    meet(one, other)
    assert one.verdict("m").state == "used"
    assert (one.fused.floor, other.fused.floor) == (7, 7)
    assert other.fused.down_m == pytest.approx(-7 * STOREY_M, abs=0.5)
    smoothed = one.smoothed().paths
    for unit_id in ("FF-01", "FF-02"):
        assert smoothed[unit_id].down_m[-1] == pytest.approx(-7 * STOREY_M, abs=0.5)


def test_encounter_across_floors_is_rejected() -> None:
    one, other = two(30)
    other.start()
    one.pin("p", 7)
    meet(one, other)
    assert one.verdict("m").state == "conflict"
    assert (one.fused.floor, other.fused.floor) == (7, 0)
    smoothed = one.smoothed().paths
    assert smoothed["FF-01"].down_m[-1] == pytest.approx(-7 * STOREY_M, abs=0.5)
    assert smoothed["FF-02"].down_m[-1] == pytest.approx(0.0, abs=0.5)


def test_rejected_encounter_across_floors_moves_no_smoothed_trail() -> None:
    """An encounter rejected for its floor gives no place on the plan."""
    one, other = two(30)
    other.script.act(SetStart("FF-02", 3.0, 0.0, 0.0, 0.0, 0.3, 0.05))
    one.pin("p", 7)
    meet(one, other)
    met = one.smoothed()
    assert not met.verdicts["m"].used
    assert abs(met.verdicts["m"].above_m) == pytest.approx(7 * STOREY_M, abs=0.5)
    one.script.act(RemovePin("m"))
    apart = one.smoothed()
    for unit_id, path in apart.paths.items():
        assert met.paths[unit_id].places_m == pytest.approx(path.places_m, abs=1e-6)


@pytest.mark.slow
@pytest.mark.parametrize("off_m", [8.0, 20.0])
def test_rejected_encounter_of_distant_units_moves_no_smoothed_trail(off_m: float) -> None:
    """They are as far apart as both are known to have been."""
    one, other = two(60)
    one.start()
    other.script.act(SetStart("FF-02", off_m, 0.0, 0.0, 0.0, 0.3, 0.05))
    meet(one, other)
    met = one.smoothed()
    assert not met.verdicts["m"].used
    assert met.verdicts["m"].residual_m == pytest.approx(off_m, abs=0.3)
    one.script.act(RemovePin("m"))
    for unit_id, path in one.smoothed().paths.items():
        assert met.paths[unit_id].places_m == pytest.approx(path.places_m, abs=0.05)


def test_encounter_on_two_floors_names_the_contradicting_path() -> None:
    one, other = two(30)
    other.start()
    one.pin("p", 7)
    meet(one, other)
    text = one.verdict("m").text
    assert "22 m below where the pin of the same time and the path of FF-01 lead" in text
    assert "22 m above where the path of FF-02 and the satellite fixes lead" in text


def test_waiting_encounter_names_the_path_it_waits_for() -> None:
    one, other = two(30)
    one.go(60)
    meet(one, other)
    assert one.verdict("m").text == "FF-02: the unit's path has not come to that time yet"


def test_encounter_with_an_unknown_floor_gives_no_floor() -> None:
    """The floors of both starts are unknown; the ground floor for one would be a guess."""
    one, other = two(30)
    meet(one, other)
    go_together(one, other, 10)
    assert other.pin("p", 7).state == "used"
    assert (one.fused.floor, other.fused.floor) == (7, 7)
    assert one.verdict("m").state == "used"


@pytest.mark.parametrize(("beacons", "floor"), [(("a", "a", "a"), 0), (("a", "b"), 1)])
def test_beacon_on_a_wrong_floor_is_one_source_however_often_passed(
    beacons: tuple[str, ...], floor: int
) -> None:
    wearer = Wearer()
    wearer.start()
    for beacon_id in sorted(set(beacons)):
        wearer.script.act(PlaceBeacon(beacon_id, "", *wearer.place, 1, 0.5, 3.0))
    for beacon_id in beacons:
        wearer.go(40)
        header = wearer.script.header("FF-01")
        wearer.script.say(Sighting(header, SightingKind.BEACON, beacon_id, range_m=1.0))
    wearer.script.wait(15)
    states = {one.state for one in wearer.script.pipeline.state.site.pin_verdicts.values()}
    assert states == {"used" if floor else "conflict"}
    assert wearer.fused.floor == floor


@pytest.mark.parametrize("away_s", [60.0, 600.0])
def test_unit_without_contact_may_have_climbed_before_its_next_run(away_s: float) -> None:
    """No message covers the time between: the floor is in doubt, and a person's pin counts."""
    wearer = Wearer()
    wearer.start()
    wearer.go(60)
    assert wearer.fused.floor_probability == pytest.approx(1.0, abs=0.01)
    wearer.script.now_s += away_s
    wearer.script.boot_ids["FF-01"] = 8
    wearer.walked_m = 0.0
    wearer.go(2)
    assert wearer.fused.floor_probability is not None
    assert wearer.fused.floor_probability < 0.9
    assert wearer.pin("p", 1).state == "used"
    assert wearer.fused.floor == 1
    assert wearer.fused.down_m == pytest.approx(-STOREY_M, abs=0.5)
