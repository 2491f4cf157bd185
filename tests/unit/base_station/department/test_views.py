"""Views of a department for an officer."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import msgspec
import pytest

from base_station.department.intake import ReportIntake
from base_station.department.live_picture import LivePicture
from base_station.department.standing import StandingReports
from base_station.department.views import DepartmentViews, PeopleQuery
from base_station.department_wire import (
    AlarmEvent,
    Event,
    EventBatch,
    EventReceipt,
    IncidentEvent,
    IncidentSummary,
    PersonEvent,
    PersonSummary,
    PlaceSummary,
    Summary,
    pack,
    unpack,
)
from base_station.storage.db.department_tables import DepartmentTables
from base_station.storage.db.store import Store
from base_station.views.answer import to_ms
from shared.channels import department_events_key, department_summary_key
from shared.clock import ManualClock
from shared.messages import AlarmParameters

HOUR_MS = 3_600_000


class Department:
    def __init__(self, folder: Path) -> None:
        self.store = Store(folder / "station.sqlite")
        self.clock = ManualClock()
        self.start()

    def start(self) -> None:
        self.picture, self.tables = LivePicture(), DepartmentTables(self.store)
        self.standing = StandingReports(self.tables)
        self.intake = ReportIntake(self.tables, self.picture, self.clock, self.standing.read)
        self.views = DepartmentViews(
            self.picture,
            self.tables,
            self.standing,
            self.intake,
            self.clock,
            lambda: ["engine-7"],
            lambda: (),
            has_archive=False,
        )

    def person(self, unit_id: str, **changes: Any) -> PersonSummary:
        place = PlaceSummary(self.now_ms - 2000, 1.0, 2.0, 1, None, None, 3.0, "good")
        shown = PersonSummary(
            unit_id, "One", "p1", "live", "i1", place, "walking", False, (), "self", None
        )
        return msgspec.structs.replace(shown, **changes)

    @property
    def now_ms(self) -> int:
        return to_ms(self.clock.utc_ns())

    def summary(self, *people: PersonSummary, epoch: int = 1, ahead_ms: int = 0) -> bytes:
        host = f"host-{epoch}"
        now_ms = self.now_ms + ahead_ms
        incidents = tuple(
            IncidentSummary(one, f"Incident {one}", now_ms)
            for one in sorted({one.incident_id for one in people} - {""})
        )
        return pack(Summary(epoch, now_ms, host, "", incidents, people, (), 0))

    def show(self, *people: PersonSummary, **changes: int) -> None:
        self.intake.take_summary(
            department_summary_key("engine-7"), self.summary(*people, **changes)
        )

    def send(self, *bodies: object, ahead_ms: int = 0) -> EventReceipt:
        events = tuple(
            Event(seq, f"e{seq}", self.now_ms + ahead_ms, msgspec.Raw(msgspec.msgpack.encode(body)))
            for seq, body in enumerate(bodies, start=1)
        )
        batch = EventBatch(1, self.now_ms + ahead_ms, 0, events)
        (reply,) = self.intake.take_events(department_events_key("engine-7"), "", pack(batch))
        return unpack(reply, EventReceipt)

    def find(self, **wanted: Any) -> list[str]:
        query = PeopleQuery("", "", "", 0, 100)._replace(**wanted)
        return [one.unit_id for one in self.views.people(query).people]


@pytest.fixture
def department(tmp_path: Path) -> Iterator[Department]:
    one = Department(tmp_path)
    yield one
    one.store.close()


def test_department_shows_incidents_alarms_and_people_in_need_first(
    department: Department,
) -> None:
    assert department.views.overview().stations[0].state == "never"
    alarm = AlarmEvent("a1", "fall", "FF-02", 1, "raised", "", "{person p1} fell", "", 1, 2)
    incident = IncidentEvent("i1", "Mill street", department.now_ms, None)
    assert (
        department.send(incident, PersonEvent("p1", "Anna Berg", "E7", ""), alarm).stored_seq == 3
    )
    department.show(
        department.person("FF-01"),
        department.person("FF-02", alarms=("a1",)),
        department.person("FF-03", mayday=True),
        department.person("FF-04", par_due_ms=department.now_ms - 1),
        department.person("FF-05", incident_id=""),
    )
    view = department.views.overview()
    (shown,) = view.incidents
    assert (shown.people, shown.maydays, shown.alarms, shown.overdue) == (4, 1, 1, 1)
    assert [(one.text, one.person) for one in view.alarms] == [("Anna Berg fell", "Anna Berg")]
    assert (view.stations[0].state, view.people, view.problems) == ("live", 5, ())
    assert department.find() == ["FF-03", "FF-02", "FF-04", "FF-01", "FF-05"]
    assert department.find(incident_id="i1", skip=1, limit=2) == ["FF-02", "FF-04"]
    assert department.find(search="anna", station="engine-7", limit=1) == ["FF-03"]
    assert department.find(station="engine-8") == []
    texts = [one.text for one in department.views.events(None, 10)]
    assert texts[0] == "FF-02 fall raised: Anna Berg fell"


def test_alarm_is_shown_with_the_newest_code_and_parameters_of_its_sentence(
    department: Department,
) -> None:
    parameters = AlarmParameters(member="{person p1}", duration_s=30.0)
    alarm = AlarmEvent(
        *("a1", "no-motion", "FF-02", 1, "raised", "pre-alert", "", "", 1, 2),
        code="no-motion",
        parameters=parameters,
    )
    late = AlarmEvent("a1", "no-motion", "FF-02", 1, "raised", "", "", "", 1, 1)
    department.send(PersonEvent("p1", "Anna Berg", "E7", ""), alarm, late)
    (shown,) = department.views.overview().alarms
    assert (shown.code, shown.parameters.duration_s) == ("no-motion", 30.0)
    assert shown.parameters.member == "Anna Berg"


def test_silent_station_is_away_and_shown_as_last_reported_also_after_a_restart(
    department: Department,
) -> None:
    department.show(department.person("FF-01"))
    department.intake.keep_summaries()
    department.clock.advance(600.0)
    for _ in range(2):
        (person,) = department.views.people(PeopleQuery("", "", "", 0, 10)).people
        assert (person.link, person.position_age_s) == ("station_away", 602.0)
        assert department.views.overview().stations[0].state == "away"
        department.start()


def test_clock_offset_of_hours_is_reported_and_ages_and_times_are_right(
    department: Department,
) -> None:
    ahead_ms = 3 * HOUR_MS
    place = PlaceSummary(department.now_ms + ahead_ms - 2000, 1.0, 2.0, 1, None, None, 3.0, "good")
    department.show(department.person("FF-01", place=place), ahead_ms=ahead_ms)
    opened_ms = department.now_ms + ahead_ms
    department.send(IncidentEvent("i1", "Mill street", opened_ms, None), ahead_ms=ahead_ms)
    (person,) = department.views.people(PeopleQuery("", "", "", 0, 10)).people
    assert person.position_age_s == 2.0
    view = department.views.overview()
    assert view.incidents[0].opened_ms == department.now_ms
    assert view.problems[0].startswith("The clock of engine-7 is 3 h 0 min ahead of the department")


def test_two_machines_with_one_name_are_reported_until_one_is_silent(
    department: Department,
) -> None:
    department.show(department.person("FF-01"), epoch=1)
    department.clock.advance(1.0)
    department.show(department.person("FF-02"), epoch=2)
    assert sorted(department.find()) == ["FF-01", "FF-02"]
    (problem,) = department.views.overview().problems
    assert "Several machines report as engine-7: host-1" in problem
    department.clock.advance(6.0)
    department.show(department.person("FF-02"), epoch=2)
    assert department.find() == ["FF-02"]
    assert department.views.overview().problems == ()


def test_unreadable_or_unstored_event_gets_no_receipt_of_storage(department: Department) -> None:
    department.intake.take_summary(department_summary_key("engine-7"), b"rubbish")
    assert list(department.intake.take_events(department_events_key("engine-7"), "", b"no")) == []
    assert "2 reports of stations could not be read" in department.intake.problem
    department.store.hangs = lambda: True
    refused = department.send(PersonEvent("p1", "Anna", "", ""))
    assert (refused.stored_seq, refused.refusal != "") == (0, True)
    department.show(department.person("FF-01", mayday=True))
    view = department.views.overview()  # the content of summaries is shown all the same
    ((name, maydays),) = [(one.name, one.maydays) for one in view.incidents]
    assert (name, maydays, len(view.problems)) == ("Incident i1", 1, 1)
    department.store.hangs = lambda: False
    assert department.send(PersonEvent("p1", "Anna", "", "")).stored_seq == 1
