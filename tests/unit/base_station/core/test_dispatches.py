"""Reports of the dispatch centre: offered, updated, dismissed, and those of their incident."""

from __future__ import annotations

import msgspec
import pytest

from base_station.core.checkpoint import read_checkpoint
from base_station.core.dispatches import KEPT
from base_station.core.events import Refused
from base_station.core.state import StationState
from base_station.storage.db.known_people import KnownPerson, person_lookup
from base_station.views.station import StationFacts, incident_view, snapshot
from shared.messages.station import CloseIncident, DismissDispatch, NoteDispatch, OpenIncident
from tests.rig.station_script import Script

FIRE = NoteDispatch("2024-7", "json", "Structure fire", units=("E12",), updated_ns=5)


@pytest.fixture
def script() -> Script:
    return Script()


def state(script: Script) -> StationState:
    return script.pipeline.state


def offered(script: Script) -> list[str]:
    return [one.report.number for one in state(script).dispatches]


def test_report_is_offered_and_opens_nothing_by_itself(script: Script) -> None:
    script.act(FIRE)
    assert state(script).shown_incident is None
    (view,) = snapshot(state(script), 1, StationFacts(), person_lookup({})).dispatches
    assert (view.number, view.type, view.units) == ("2024-7", "Structure fire", ("E12",))
    assert view.received_ms is not None


def test_later_report_replaces_the_earlier_one_and_an_older_one_changes_nothing(
    script: Script,
) -> None:
    script.act(FIRE)
    received_ns = state(script).dispatches[0].received_ns
    script.now_s += 5.0
    newer = msgspec.structs.replace(FIRE, units=("E12", "L4"), updated_ns=6)
    script.act(newer)
    script.act(FIRE)  # came late
    (known,) = state(script).dispatches
    assert known.report == newer
    assert known.received_ns == received_ns


def test_incident_is_opened_from_a_dispatch_and_takes_its_later_reports(script: Script) -> None:
    script.act(FIRE)
    script.act(OpenIncident("i1", "Mill Lane", dispatch_number="2024-7"))
    incident = state(script).shown_incident
    assert incident is not None
    assert incident.dispatch == FIRE
    assert offered(script) == []
    script.act(msgspec.structs.replace(FIRE, address="Mill Lane 4", updated_ns=9, has_ended=True))
    incident = state(script).shown_incident
    assert incident is not None
    assert (incident.name, incident.closed_ns) == ("Mill Lane", None)  # entered by the officer
    assert incident.dispatch is not None
    assert incident.dispatch.address == "Mill Lane 4"
    assert offered(script) == []
    script.act(CloseIncident("i1"))
    script.act(msgspec.structs.replace(FIRE, remarks="out", updated_ns=11))
    assert offered(script) == []  # it is over, not new
    last = state(script).closed_incidents[-1].dispatch
    assert last is not None
    assert last.remarks == "out"


def test_dispatch_during_an_incident_is_only_offered(script: Script) -> None:
    script.act(OpenIncident("i1", "Mill Lane"))
    script.act(FIRE)
    assert offered(script) == ["2024-7"]
    incident = state(script).shown_incident
    assert incident is not None
    assert (incident.name, incident.dispatch) == ("Mill Lane", None)
    (refused,) = script.act(OpenIncident("i2", "Fire", dispatch_number="2024-7"))
    assert isinstance(refused, Refused)
    assert offered(script) == ["2024-7"]  # nothing is lost by it


def test_dismissed_dispatch_stays_dismissed_and_can_still_be_opened(script: Script) -> None:
    script.act(FIRE)
    script.act(DismissDispatch("2024-7"))
    script.act(msgspec.structs.replace(FIRE, updated_ns=6))
    assert state(script).dispatches[0].is_dismissed
    script.act(OpenIncident("i1", "Mill Lane", dispatch_number="2024-7"))
    assert offered(script) == []


def test_missing_or_opened_dispatch_is_refused(script: Script) -> None:
    for action in (
        DismissDispatch("2024-7"),
        OpenIncident("i1", "Mill Lane", dispatch_number="2024-7"),
    ):
        (refused,) = script.act(action)
        assert isinstance(refused, Refused)
        assert "2024-7" in refused.reason
    script.act(FIRE)
    script.act(OpenIncident("i1", "Mill Lane", dispatch_number="2024-7"))
    script.act(CloseIncident("i1"))
    (refused,) = script.act(OpenIncident("i2", "Mill Lane", dispatch_number="2024-7"))
    assert isinstance(refused, Refused)
    assert "Mill Lane" in refused.reason


def test_flood_keeps_the_newest_dispatches(script: Script) -> None:
    for number in range(KEPT + 5):
        script.act(NoteDispatch(str(number), "json"))
    assert offered(script) == [str(number) for number in range(5, KEPT + 5)]


def test_dispatches_survive_a_checkpoint(script: Script) -> None:
    script.act(msgspec.structs.replace(FIRE, lat_deg=52.0, lon_deg=4.0, warnings=("late",)))
    script.act(NoteDispatch("2024-8", "eido"))
    script.act(OpenIncident("i1", "Mill Lane", dispatch_number="2024-8"))
    saved = read_checkpoint(script.pipeline.checkpoint())
    assert saved is not None
    again = saved.state
    assert again.dispatches == state(script).dispatches
    assert again.shown_incident == state(script).shown_incident


def test_remarks_show_names_in_place_of_references(script: Script) -> None:
    script.act(msgspec.structs.replace(FIRE, remarks="call {person p1}"))
    script.act(OpenIncident("i1", "Mill Lane", dispatch_number="2024-7"))
    incident = state(script).shown_incident
    assert incident is not None
    view = incident_view(incident, person_lookup({"p1": KnownPerson("Ada")}))
    assert view.dispatch is not None
    assert view.dispatch.remarks == "call Ada"
