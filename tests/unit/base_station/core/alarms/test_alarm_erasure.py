"""Erasure of a person from tables: alarms, the audit, separate actions."""

from __future__ import annotations

from pathlib import Path

import msgspec
import pytest
from msgspec.structs import replace

from base_station.core.erasure.erasure import Erasure, Wearing
from base_station.core.state import ERASED_TEXT
from base_station.storage.db.erasure import forget_in
from base_station.storage.db.models import AlarmRow, AlarmTransition, AuditEntry
from base_station.storage.db.store import Store
from shared.messages.station import Action, Assign, DoneApart, ResolveAlarm

FALL = {"alarm_id": "fall:FF-01:1", "state": "raised", "level": "fall", "by": ""}


def test_alarm_raised_again_by_another_wearer_keeps_nothing_of_the_erased_one(
    tmp_path: Path,
) -> None:
    """Three people wore the unit one after the other, and nobody resolved the alarm."""
    texts = {10: "Ana may have fallen", 20: "Bo may have fallen", 30: "Cem may have fallen"}
    bo = Erasure((Wearing("FF-01", 15, 25),), ("Bo",), person_id="p-bo")
    with Store(tmp_path / "station.sqlite") as store:
        with store.write() as session:
            session.add(
                AlarmRow(
                    **FALL, rule="fall", unit_id="FF-01", priority=1, text=texts[30],
                    raised_ns=10, changed_ns=30,
                )
            )  # fmt: skip
            session.add_all(
                AlarmTransition(**FALL, t_ns=t_ns, text=text) for t_ns, text in texts.items()
            )
        with store.write() as session:
            forget_in(session, bo)
        with store.read() as session:
            reported = {one.t_ns: one.text for one in session.query(AlarmTransition)}
    assert reported == texts | {20: "(forgotten) may have fallen"}


def test_alarms_and_notes_after_the_end_of_an_incident_contain_no_name(
    tmp_path: Path,
) -> None:
    ana = Erasure(
        (Wearing("FF-01", 15, 25),), ("Ana",), incident_id="i1", from_ns=15, until_ns=25,
        about_until_ns=50,
    )  # fmt: skip
    ids = ["mayday:FF-01:30", "mayday:FF-02:30", "mayday:FF-01:60"]
    fields = {"rule": "mayday", "priority": 1, "state": "resolved", "level": "mayday"}
    with Store(tmp_path / "station.sqlite") as store:
        with store.write() as session:
            for alarm_id in ids:
                _, unit_id, raised_ns = alarm_id.split(":")
                session.add(
                    AlarmRow(
                        **fields, alarm_id=alarm_id, unit_id=unit_id, text="Mayday from Ana",
                        by="eve: spoke to Ana", raised_ns=int(raised_ns), changed_ns=70,
                    )
                )  # fmt: skip
                noted = ResolveAlarm(alarm_id, "spoke to Ana")
                session.add(
                    AuditEntry(
                        entry_id=alarm_id, t_ns=70, by="eve", action="ResolveAlarm",
                        detail=msgspec.json.encode(noted).decode(),
                    )
                )  # fmt: skip
        for _ in range(2):  # every statement may run again
            with store.write() as session:
                forget_in(session, ana)
        with store.read() as session:
            reported = {one.alarm_id: (one.text, one.by) for one in session.query(AlarmRow)}
            noted_of = {one.entry_id: "Ana" in one.detail for one in session.query(AuditEntry)}
    kept = "Mayday from Ana", "eve: spoke to Ana"
    gone = f"Mayday from {ERASED_TEXT}", f"eve: spoke to {ERASED_TEXT}"
    assert reported == dict(zip(ids, (gone, kept, kept), strict=True))
    assert noted_of == dict(zip(ids, (False, True, True), strict=True))


@pytest.mark.parametrize("of_incident", [False, True])
def test_audit_has_no_places_of_separate_actions(tmp_path: Path, of_incident: bool) -> None:
    """A person called Station was erased before."""
    details = {
        "pin of ana": DoneApart("b", 20, "eve", "SetPin p, FF-01, 3.0, 4.0"),
        "pin of bo": DoneApart("b", 20, "eve", "SetPin p, FF-02, 3.0, 4.0"),
        "evacuation": DoneApart("b", 20, "eve", "SendCommand c1, evacuate, Ana"),
    }
    stated = {name: msgspec.json.encode(one).decode() for name, one in details.items()}
    stated["broken"] = stated["pin of ana"].replace("station", ERASED_TEXT)
    wearing = (Wearing("FF-01", 15, 25),)
    if of_incident:  # over before the stations were together again
        ana = Erasure(wearing, ("Ana",), incident_id="i1", from_ns=15, until_ns=25)
    else:
        ana = Erasure(wearing, ("Ana",), person_id="p-ana")
    with Store(tmp_path / "station.sqlite") as store:
        with store.write() as session:
            session.add_all(
                AuditEntry(entry_id=name, t_ns=30, by="station", action="DoneApart", detail=detail)
                for name, detail in stated.items()
            )
        for _ in range(2):
            with store.write() as session:
                forget_in(session, ana)
        with store.read() as session:
            left = {one.entry_id: one.detail for one in session.query(AuditEntry)}
    nothing = DoneApart("b", 20, "eve", ERASED_TEXT)
    assert left == {
        "pin of ana": msgspec.json.encode(nothing).decode(),
        "pin of bo": stated["pin of bo"],
        "evacuation": stated["evacuation"].replace("Ana", ERASED_TEXT),
        "broken": ERASED_TEXT,
    }


OF_JO = Assign("FF-01", "p", 'Jo "Mac" Neil', "E 1", "Nozzle")
OF_MAX = Assign("Max", "p", "Max", "E 1", "")
OF_EVE = Assign("FF-02", "p-eve", "Eve", "E 1", "Nozzle")
ERASED_PERSON = {"person_name": ERASED_TEXT, "crew": "", "role": ""}


@pytest.mark.parametrize(
    ("name", "done", "left"),
    [
        ('Jo "Mac" Neil', OF_JO, replace(OF_JO, **ERASED_PERSON)),
        ("Neil\\Jo", ResolveAlarm("a", "met neil\\jo"), ResolveAlarm("a", f"met {ERASED_TEXT}")),
        ("Note", ResolveAlarm("a", "Note is well"), ResolveAlarm("a", f"{ERASED_TEXT} is well")),
        ("Max", OF_MAX, replace(OF_MAX, **ERASED_PERSON)),
        ("Max", OF_EVE, OF_EVE),
    ],
)
def test_name_is_erased_from_the_audit_in_every_spelling_and_nothing_else(
    tmp_path: Path, name: str, done: Action, left: Action
) -> None:
    """An entry is JSON, which escapes quotation marks, and has names of fields."""
    detail = msgspec.json.encode(done).decode()
    with Store(tmp_path / "station.sqlite") as store:
        with store.write() as session:
            kind = type(done).__name__
            session.add(AuditEntry(entry_id="a", t_ns=30, by="eve", action=kind, detail=detail))
        for _ in range(2):
            with store.write() as session:
                forget_in(session, Erasure((), (name,), person_id="p"))
        with store.read() as session:
            stated = session.query(AuditEntry).one().detail
    assert msgspec.json.decode(stated, type=type(left)) == left


def test_audit_of_an_erased_incident_keeps_no_crew_and_role_of_wearers(
    tmp_path: Path,
) -> None:
    wearing = (Wearing("FF-01", 15, 25),)
    ana = Erasure(wearing, ("Ana",), incident_id="i1", from_ns=15, until_ns=25)
    worn = Assign("FF-01", "p-ana", "Ana", "E 1", "Nozzle")
    detail = msgspec.json.encode(worn).decode()
    with Store(tmp_path / "station.sqlite") as store:
        with store.write() as session:
            session.add_all(
                AuditEntry(entry_id=str(t), t_ns=t, by="eve", action="Assign", detail=detail)
                for t in (10, 20, 30)
            )
        with store.write() as session:
            forget_in(session, ana)
        with store.read() as session:
            stated = {one.t_ns: one.detail for one in session.query(AuditEntry)}
    erased = replace(worn, person_id=ERASED_TEXT, **ERASED_PERSON)
    gone = msgspec.json.encode(erased).decode()
    assert stated == {10: detail, 20: gone, 30: detail}
