"""Reports of a station: transitions of alarms, and changes of people and incidents."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable
from pathlib import Path
from typing import Any

import msgspec
import pytest

from base_station.department_wire import (
    AlarmEvent,
    EventBody,
    IncidentEvent,
    ParEvent,
    PersonEvent,
    unpack_body,
)
from base_station.forwarders.department.collector import ReportCollector
from base_station.forwarders.department.outbox import DepartmentOutbox
from base_station.storage.db.known_people import FORGOTTEN, KnownPerson
from base_station.storage.projection import Projection
from base_station.views.wire import DutyView, PersonView
from shared.channels import ALARM
from shared.clock import NS_PER_S
from shared.codec import encode
from shared.messages import STATION_ID, AlarmChange, AlarmState, Header
from shared.messages.station import CloseIncident
from tests.rig.tak_scene import T_MS, Scene, delta

ANNA = PersonView("p1", "Anna Berg", "Engine 7", "firefighter", None)
NOT_CONFIRMED = DutyView(
    checked_in_ms=None,
    checked_in_by="",
    due_ms=T_MS + 1000,
    asked_ms=None,
    work_since_ms=None,
    rest_since_ms=None,
    rest_due_ms=None,
    confirmed="not_yet",
    on_duty_ms=T_MS,
    located=True,
    entry_id="",
)
T_NS = T_MS * 1_000_000


def change(t_ns: int, state: AlarmState) -> AlarmChange:
    return AlarmChange(
        header=Header(STATION_ID, 1, 1, 0, t_ns, 0.0),
        alarm_id="fall|FF-01|1",
        rule="fall",
        unit_id="FF-01",
        priority=1,
        state=state,
        level="",
        text="{person p1} fell",
        by="",
        raised_ns=T_NS,
        last_raised_ns=T_NS,
    )


class Station:
    """A collector with its inputs, and the outbox."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.names = {"p1": KnownPerson("Anna Berg")}
        self.log: list[tuple[int, str, bytes]] = []
        self.since_ns: list[int] = []
        self.scene = Scene("FF-01")
        self.start()

    def start(self) -> None:
        self.outbox = DepartmentOutbox(self.folder / "outbox.sqlite")
        self.collector = ReportCollector(
            self.outbox, lambda one: self.names.get(one, KnownPerson(one)), self._read_log
        )

    def _read_log(self, since_ns: int) -> Iterable[tuple[int, str, bytes]]:
        self.since_ns.append(since_ns)
        return [record for record in self.log if record[0] >= since_ns]

    def decide(self, t_ns: int, state: AlarmState) -> None:
        self.log.append((t_ns, ALARM.key(STATION_ID), encode(change(t_ns, state))))
        self.collector.project(Projection(t_ns, alarms=(change(t_ns, state),)))

    def show(self, person: PersonView | None = ANNA, **changes: Any) -> None:
        self.collector.reset(self.scene.picture(units=(self.scene.unit(person=person, **changes),)))

    def events(self) -> list[EventBody | None]:
        batch = self.outbox.next_batch(1000, 10**6)
        return [unpack_body(msgspec.Raw(one.body)) for one in batch]

    def kinds(self) -> Counter[str]:
        return Counter(type(one).__name__ for one in self.events())


@pytest.fixture
def station(tmp_path: Path) -> Station:
    return Station(tmp_path)


def test_station_reports_its_incident_its_people_and_every_transition_once(
    station: Station,
) -> None:
    station.decide(T_NS, AlarmState.RAISED)
    assert not station.collector.collect(T_MS)  # the department has nothing of the station yet
    station.show()
    assert station.collector.collect(T_MS)
    station.decide(T_NS + 1, AlarmState.ACKNOWLEDGED)
    station.decide(T_NS + 2, AlarmState.RESOLVED)
    assert station.collector.collect(T_MS + 1)
    assert not station.collector.collect(T_MS + 2)
    alarms = [one for one in station.events() if isinstance(one, AlarmEvent)]
    assert [one.state for one in alarms] == ["raised", "acknowledged", "resolved"]
    assert alarms[0].text == "{person p1} fell"  # the name is in an event of its own
    assert PersonEvent("p1", "Anna Berg", "Engine 7", "firefighter") in station.events()
    (incident,) = [one for one in station.events() if isinstance(one, IncidentEvent)]
    assert (incident.name, incident.closed_ms) == ("Kitchen", None)

    summary = station.collector.summary(T_MS + 2, "https://engine-7")
    assert summary is not None
    (person,) = summary.people
    assert (person.unit_id, person.person_id, person.place is not None) == ("FF-01", "p1", True)
    assert (summary.waiting, summary.epoch) == (len(station.events()), station.outbox.epoch)


def test_undone_confirmation_is_reported_as_another_change(station: Station) -> None:
    mine: dict[str, Any] = {"person": ANNA, "incident_id": "i2"}  # one of several
    station.show(duty=NOT_CONFIRMED, incident_id="i2")
    station.collector.collect(T_MS)
    confirmed = msgspec.structs.replace(NOT_CONFIRMED, confirmed="radio", checked_in_ms=T_MS)
    for shown in (confirmed, NOT_CONFIRMED, confirmed):
        station.collector.delta(delta(station.scene.unit(**mine, duty=shown)))
        station.collector.collect(T_MS)
    par = [one for one in station.events() if isinstance(one, ParEvent)]
    assert [one.confirmed for one in par] == ["not_yet", "radio", "not_yet", "radio"]
    assert {one.incident_id for one in par} == {"i2"}


def test_decisions_before_a_kill_are_read_from_the_log(station: Station) -> None:
    station.show()
    station.collector.collect(T_MS)
    station.decide(T_NS, AlarmState.RAISED)
    station.collector.collect(T_MS)
    station.decide(T_NS + 10 * NS_PER_S, AlarmState.ACKNOWLEDGED)  # killed before it is collected
    station.outbox.close()

    station.start()
    station.show()
    station.collector.collect(T_MS)
    states = [one.state for one in station.events() if isinstance(one, AlarmEvent)]
    assert states == ["raised", "acknowledged"]
    assert station.kinds() == {"AlarmEvent": 2, "IncidentEvent": 1, "PersonEvent": 1}
    assert station.since_ns[-1] == T_NS - 5 * NS_PER_S  # not all of the log


def test_incident_ended_while_the_station_was_off_is_reported_as_closed(
    station: Station,
) -> None:
    station.show()
    station.collector.collect(T_MS)
    station.outbox.close()
    station.scene.script.act(CloseIncident("i1"))
    station.start()
    station.show()
    station.collector.collect(T_MS + 5)
    opened, closed = (one for one in station.events() if isinstance(one, IncidentEvent))
    shown = station.scene.picture().incident
    assert shown is not None
    assert (opened.closed_ms, closed.closed_ms) == (None, shown.closed_ms)


def test_erased_person_is_erased_at_the_department_and_in_the_outbox(
    station: Station,
) -> None:
    station.show()
    station.collector.collect(T_MS)
    station.names["p1"] = FORGOTTEN
    station.show(person=None)
    station.collector.collect(T_MS)
    people = [one for one in station.events() if isinstance(one, PersonEvent)]
    assert people == [PersonEvent("p1", "", "", "")] * 2
    assert not station.collector.collect(T_MS)
