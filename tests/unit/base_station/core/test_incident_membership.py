"""Several incidents at once: membership, and separation of their state."""

from __future__ import annotations

import pytest

from base_station.core.checkpoint import read_checkpoint
from base_station.core.events import ClosedIncidentChanged, MembershipChanged, Refused, UnitChanged
from base_station.core.pins.pin_registry import MAX_PINS
from base_station.core.state import OWN_SITE_ID, StationState, UnitState
from shared.messages import CommandKind
from shared.messages.pins import PlaceBeacon, SetMeeting, SetPin
from shared.messages.station import (
    Assign,
    AssignIncident,
    CheckIn,
    CloseIncident,
    OpenIncident,
    SendCommand,
    SetAccountability,
    SetAnchor,
    SetPlan,
    SetStart,
    Unassign,
)
from tests.rig.reported_incident import plan
from tests.rig.station_script import Script, new_pipeline

UNITS = ("FF-01", "FF-02", "FF-03")


@pytest.fixture
def script() -> Script:
    """Two incidents: FF-01 and FF-02 are in the first, FF-03 is in the second."""
    script = Script()
    script.register(*UNITS)
    for number, unit_id in enumerate(UNITS, 1):
        script.act(Assign(unit_id, f"p{number}"))
    script.act(OpenIncident("a", "Mill Lane"))
    script.wait(5)
    script.act(OpenIncident("b", "Harbour", par_interval_s=600.0, beside_others=True))
    script.act(AssignIncident("b", ("FF-03",)))
    return script


def state_of(script: Script) -> StationState:
    return script.pipeline.state


def unit(script: Script, unit_id: str) -> UnitState:
    return state_of(script).units[unit_id]


def incidents(script: Script) -> dict[str, str]:
    return {one.unit_id: one.incident_id for one in state_of(script).units.values()}


def walk(script: Script, unit_id: str, metres: int) -> None:
    for step in range(metres):
        script.now_s += 1.0
        script.position(unit_id, float(step), 0.0)


def refusal(script: Script, *actions: object) -> str:
    outputs = [one for action in actions for one in script.act(action)]  # type: ignore[arg-type]
    (refused,) = [one for one in outputs if isinstance(one, Refused)]
    return refused.reason


def test_all_units_are_in_the_first_incident_and_none_in_the_second() -> None:
    script = Script()
    script.register("FF-01")
    outputs = script.act(OpenIncident("a", "Mill Lane"))
    assert MembershipChanged("FF-01", "a", script.t_ns) in outputs
    assert "close it first" in refusal(script, OpenIncident("b", "Harbour"))
    script.act(OpenIncident("b", "Harbour", beside_others=True))
    assert incidents(script) == {"FF-01": "a"}
    script.register("FF-02")
    assert incidents(script)["FF-02"] == "", "several are open: a commander says where it goes"
    assert "of its own" in refusal(script, OpenIncident("b", "Again", beside_others=True))


def test_unit_that_appears_while_one_is_open_is_in_it() -> None:
    script = Script()
    script.act(OpenIncident("a", "Mill Lane"))
    script.register("FF-01")
    assert incidents(script) == {"FF-01": "a"}


def test_par_and_orders_of_one_incident_do_not_affect_the_other(script: Script) -> None:
    script.wait(30)
    assert "name one of them" in refusal(script, CheckIn("", "", True))
    script.act(CheckIn("", "", True, "k1", (), "a"))
    confirmed = {one: unit(script, one).duty for one in UNITS}
    assert [duty is not None and duty.confirmed for duty in confirmed.values()] == [
        "radio",
        "radio",
        "not_yet",
    ]
    assert "name one of them" in refusal(script, SetAccountability(900.0, 900.0))
    script.act(SetAccountability(1200.0, 900.0, "b"))
    assert state_of(script).incidents["a"].work_limit_s != 900.0
    order = SendCommand("c1", CommandKind.EVACUATE, "", "", True, "", 0.0, 60.0, (), "b")
    script.act(order)
    command = state_of(script).commands["c1"]
    assert (command.incident_id, set(command.deliveries)) == ("b", {"FF-03"})
    script.act(SendCommand("c2", CommandKind.EVACUATE, "", "", True, "", 0.0, 60.0))
    everyone = state_of(script).commands["c2"]
    assert (everyone.incident_id, set(everyone.deliveries)) == ("", set(UNITS))


def test_person_is_in_one_incident_and_moves_with_their_work_and_no_confirmation(
    script: Script,
) -> None:
    script.act(CheckIn("FF-01", "", False))
    duty = unit(script, "FF-01").duty
    assert duty is not None
    duty.work_since_ns = script.t_ns
    script.wait(10)
    outputs = script.act(AssignIncident("b", ("FF-01",)))
    assert MembershipChanged("FF-01", "b", script.t_ns) in outputs
    moved = unit(script, "FF-01").duty
    assert moved is not None
    assert (moved.confirmed, moved.work_since_ns) == ("not_yet", duty.work_since_ns)
    assert moved.since_ns == script.t_ns
    script.act(AssignIncident("", ("FF-01",)))
    assert (incidents(script)["FF-01"], unit(script, "FF-01").duty) == ("", None)


def test_person_with_another_unit_stays_in_the_incident(script: Script) -> None:
    script.register("FF-04")
    script.act(Assign("FF-04", "p3"))
    assert incidents(script)["FF-04"] == "b"
    assert unit(script, "FF-04").site_id == "b"
    script.act(Unassign("FF-04"))
    assert incidents(script)["FF-04"] == "b"


@pytest.mark.parametrize(
    ("action", "reason"),
    [
        (AssignIncident("b", ()), "at least one unit"),
        (AssignIncident("b", ("FF-01", "FF-09")), "no registered unit"),
        (AssignIncident("c", ("FF-01",)), "no open incident c"),
        (SetPlan(plan(), "c"), "no incident c"),
        (SetMeeting("m", "FF-01", "FF-03", 0, 1.0, ""), "different incidents"),
        (CloseIncident("c"), "no open incident c"),
    ],
)
def test_impossible_membership_changes_nothing(script: Script, action: object, reason: str) -> None:
    before = incidents(script)
    assert reason in refusal(script, action)
    assert incidents(script) == before
    assert not any(site.pins for site in state_of(script).sites.values())


def test_each_incident_has_its_own_site(script: Script) -> None:
    script.act(SetAnchor(52.0, 4.0, 0.0, 0.0))
    script.act(SetAnchor(53.0, 5.0, 0.0, 0.0, "b"))
    script.act(SetPlan(plan(), "b"))
    sites = state_of(script).sites
    assert sites[OWN_SITE_ID].plan is None
    assert sites["b"].plan is not None
    anchors = [site.anchor for site in sites.values()]
    assert [one is not None and one.lat_deg for one in anchors] == [52.0, 53.0]
    script.act(PlaceBeacon("door", "", 1.0, 2.0, None, 0.5, 3.0, "b"))
    script.act(SetStart("FF-03", 10.0, 12.0, 0.0, 0.0, 0.5, 0.05))
    walk(script, "FF-01", 5)
    walk(script, "FF-03", 5)
    script.act(SetPin("p", "FF-03", script.t_ns, 14.0, 12.0, 0.5, 0, None, 0.0, ""))
    assert (set(sites["b"].pins), set(sites["b"].beacons)) == ({"p"}, {"door"})
    assert not sites[OWN_SITE_ID].pins
    shown = unit(script, "FF-03").place.fused
    assert shown is not None
    assert shown.north_m == pytest.approx(14.0, abs=1.0)
    assert len(sites["b"].pins) < MAX_PINS


def test_path_begins_anew_on_the_other_site(script: Script) -> None:
    walk(script, "FF-01", 20)
    script.act(SetPin("p", "FF-01", script.t_ns, 5.0, 5.0, 0.5, None, None, 0.0, ""))
    assert unit(script, "FF-01").trails.shown
    outputs = script.act(AssignIncident("b", ("FF-01",)))
    assert UnitChanged("FF-01") in outputs
    moved = unit(script, "FF-01")
    assert (moved.trails.shown, moved.place.fused) == ([], None)
    assert not state_of(script).sites[OWN_SITE_ID].pins, "they are of a path that is over here"
    walk(script, "FF-01", 3)
    assert state_of(script).paths["FF-01"].begin_ns is not None
    assert moved.place.fused is not None


def test_closing_one_leaves_the_other(script: Script) -> None:
    order = SendCommand("c1", CommandKind.EVACUATE, "", "", True, "", 0.0, 600.0)
    script.act(order)
    outputs = script.act(CloseIncident("a"))
    assert MembershipChanged("FF-01", "", script.t_ns) in outputs
    assert [unit(script, one).duty is not None for one in UNITS] == [False, False, True]
    command = state_of(script).commands["c1"]
    states = {one: command.state_of(it) for one, it in command.deliveries.items()}
    assert states == {"FF-01": "expired", "FF-02": "expired", "FF-03": "queued"}
    assert [one.incident_id for one in state_of(script).open_incidents] == ["b"]
    walk(script, "FF-03", 2)
    debriefing = SetPin("p", "FF-01", 1, 5.0, 5.0, 0.5, None, None, 0.0, "")
    assert ClosedIncidentChanged("a") in script.act(debriefing)
    script.act(OpenIncident("c", "Next", beside_others=True))
    assert state_of(script).incidents.keys() == {"b", "c"}
    assert incidents(script) == {"FF-01": "", "FF-02": "", "FF-03": "b"}
    script.act(CloseIncident("b"))
    script.act(CloseIncident("c"))
    script.act(OpenIncident("d", "Later"))
    assert set(incidents(script).values()) == {"d"}
    assert state_of(script).sites.keys() == {OWN_SITE_ID}


def test_checkpoint_restores_all_of_it(script: Script) -> None:
    script.act(SetPlan(plan(), "b"))
    walk(script, "FF-03", 5)
    saved = read_checkpoint(script.pipeline.checkpoint())
    assert saved is not None
    assert saved.state == state_of(script)
    again = Script(new_pipeline())
    for record in script.records:
        again.record(record[1], record[2])
    assert incidents(again) == incidents(script)
