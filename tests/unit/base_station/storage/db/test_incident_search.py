"""Search of incidents by place, person, alarm and date, while they are open and afterwards."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import msgspec
import pytest

from base_station.core.erasure.erasure import Erasure, Wearing
from base_station.core.person_references import reference_to
from base_station.storage.db.erasure import forget_in
from base_station.storage.db.incident_search import IncidentQuery, IncidentSearch
from base_station.storage.db.models import (
    AlarmRow,
    Assignment,
    Base,
    DispatchRow,
    IncidentMember,
    IncidentRow,
)
from base_station.storage.db.roster import Roster
from base_station.storage.db.store import Store
from base_station.storage.db.window import Window
from shared.clock import NS_PER_S, ManualClock
from shared.messages.station import NoteDispatch


@pytest.fixture
def store(tmp_path: Path) -> Iterator[Store]:
    with Store(tmp_path / "station.sqlite") as store:
        yield store


def add(store: Store, *rows: Base) -> None:
    with store.write() as session:
        session.add_all(rows)


def change(store: Store, incident_id: str, **values: object) -> None:
    with store.write() as session:
        for name, value in values.items():
            setattr(session.get(IncidentRow, incident_id), name, value)


def incident(
    incident_id: str, begin_s: int, end_s: int | None, name: str, **more: Any
) -> IncidentRow:
    closed_ns = None if end_s is None else end_s * NS_PER_S
    return IncidentRow(
        incident_id=incident_id,
        name=name,
        opened_ns=begin_s * NS_PER_S,
        opened_by="",
        closed_ns=closed_ns,
        closed_by="",
        **more,
    )


def worn(unit_id: str, person_id: str, begin_s: int, end_s: int | None) -> Base:
    return Assignment(
        action_id=f"{unit_id}-{person_id}-{begin_s}",
        unit_id=unit_id,
        person_id=person_id,
        person_name="",
        crew="",
        role="",
        from_ns=begin_s * NS_PER_S,
        until_ns=None if end_s is None else end_s * NS_PER_S,
    )


def alarm(rule: str, unit_id: str, t_s: int) -> Base:
    return AlarmRow(
        alarm_id=f"{rule}-{unit_id}-{t_s}",
        rule=rule,
        unit_id=unit_id,
        priority=1,
        state="resolved",
        level="",
        text="",
        by="",
        raised_ns=t_s * NS_PER_S,
        changed_ns=t_s * NS_PER_S,
    )


def member(incident_id: str, unit_id: str, begin_s: int, end_s: int | None) -> Base:
    return IncidentMember(
        incident_id=incident_id,
        unit_id=unit_id,
        from_ns=begin_s * NS_PER_S,
        until_ns=None if end_s is None else end_s * NS_PER_S,
    )


def found(store: Store, text: str = "", **more: Any) -> list[str]:
    query = IncidentQuery(text, **more)
    return [one.incident_id for one in IncidentSearch(store).find(query)]


def test_place_is_found_by_the_beginnings_of_its_words(store: Store) -> None:
    report = NoteDispatch("2026-17", "json", type="Dachstuhlbrand", address="Große Straße 7, Ütz")
    encoded = msgspec.json.encode(report).decode()
    add(
        store,
        DispatchRow(number="2026-17", updated_ns=0, report=encoded),
        incident("mill", 100, 200, "Mill Lane"),
        incident("hall", 300, 400, "Town hall, Lane 3", dispatch_number="2026-17"),
        incident("open", 500, None, "100 % smoke_test"),
    )
    assert found(store, "lane") == ["hall", "mill"]
    assert found(store, "LAN mil") == ["mill"]
    assert found(store, "grosse strasse") == found(store, "utz dach") == ["hall"]
    assert found(store, "2026") == ["hall"]
    assert found(store, "ane") == found(store, "lane harbour") == []
    assert found(store, "%") == found(store) == ["open", "hall", "mill"], "no word is no condition"
    assert found(store, "lane", opened=Window(0, 300 * NS_PER_S)) == ["mill"]
    change(store, "open", name="Harbour")
    assert found(store, "harbour") == ["open"], "what is open changes still"


def test_person_is_found_as_a_member_or_where_mentioned(store: Store) -> None:
    roster = Roster(store, ManualClock())
    ada = roster.add_person("Ada Öst", "", "").person_id
    bo = roster.add_person("Bo Adams", "", "").person_id
    add(
        store,
        worn("FF-01", ada, 0, 250),
        worn("FF-01", bo, 250, None),
        worn("FF-02", bo, 0, 50),
        incident("old-1", 10, 40, "of an earlier version, in which everybody was"),
        incident("old-2", 60, 90, "the same, later"),
        incident("one", 100, 200, "", has_members=True),
        incident("two", 120, 300, f"with {reference_to(bo)}", has_members=True),
        incident("three", 260, 300, "", has_members=True),
        member("one", "FF-01", 100, 200),
        member("three", "FF-01", 260, 300),
    )
    assert found(store, person="ada ost") == ["one", "old-2", "old-1"]
    assert found(store, person=bo) == ["three", "two", "old-1"]
    assert found(store, "ada") == ["three", "two", "one", "old-2", "old-1"], "Adams, too"
    assert found(store, person="nobody") == found(store, person="-") == []
    late = Erasure(
        person_id=ada,
        wearings=(Wearing("FF-01", 0, 250 * NS_PER_S),),
        names=("Ada Öst",),
    )
    with store.write() as session:
        forget_in(session, late)
    assert found(store, person="ada ost") == []
    assert found(store, person="bo") == ["three", "two", "old-1"]


def test_alarm_of_members_and_of_the_station_is_found(store: Store) -> None:
    add(
        store,
        incident("one", 100, 200, "", has_members=True),
        incident("two", 100, 300, "", has_members=True),
        member("one", "FF-01", 100, 200),
        alarm("no-motion", "FF-01", 150),
        alarm("log-disk", "", 160),
        alarm("mayday", "FF-01", 250),
    )
    assert found(store, alarm="no-motion") == found(store, "motion") == ["one"]
    assert found(store, alarm="log") == ["two", "one"]
    assert found(store, alarm="mayday") == []
    add(store, alarm("heat", "FF-01", 190))
    assert found(store, alarm="heat") == []
    change(store, "one", late_data_ns=400 * NS_PER_S)
    assert found(store, alarm="heat") == ["one"], "a journal brought it later"
