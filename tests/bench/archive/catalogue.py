"""Years of incidents in a database, and how long searches of them take."""

from __future__ import annotations

import random
import time
from dataclasses import dataclass
from pathlib import Path

import msgspec
from sqlalchemy import insert

from base_station.core.alarms import ALARMS
from base_station.storage.db.incident_search import IncidentQuery, IncidentSearch
from base_station.storage.db.models import (
    AlarmRow,
    Assignment,
    Base,
    DispatchRow,
    IncidentMember,
    IncidentRow,
    PersonRow,
)
from base_station.storage.db.store import Store
from base_station.storage.db.window import EVER, Window
from shared.clock import NS_PER_S
from shared.messages.station import NoteDispatch

_PEOPLE, _CREW = 200, 8
_DAY_NS = 86_400 * NS_PER_S
_LONG_NS = 3600 * NS_PER_S
_STREETS = tuple(f"{one}{two}" for one in ("Mill", "Harbour", "Oak", "Church", "North", "Quarry")
                 for two in (" Lane", " Street", " Road", "straße", " Square"))  # fmt: skip
_FIRST = ("Ada", "Bo", "Cy", "Dora", "Emil", "Frieda", "Gus", "Hana", "Ida", "Jon")
_LAST = ("Abel", "Berg", "Conti", "Dietz", "Ek", "Falk", "Grün", "Holm", "Iversen", "Jansen")
_PAGE = 100
_REPEATED = 5


@dataclass(frozen=True, slots=True)
class SearchFigures:
    asked: str
    found: int  # of the first page
    took_s: float  # the slowest of some


def fill(store: Store, incidents: int) -> None:
    """Incidents of some years, each with a crew, a dispatch and alarms."""
    dice = random.Random(1)
    rows: dict[type[Base], list[dict[str, object]]] = {}

    def add(table: type[Base], **row: object) -> None:
        rows.setdefault(table, []).append(row)

    for number in range(_PEOPLE):
        name = f"{dice.choice(_FIRST)} {dice.choice(_LAST)} {number}"
        add(PersonRow, person_id=f"p{number:04}", name=name, crew="", role="", created_ns=0)
    for number in range(incidents):
        opened_ns, incident_id = (number + 1) * _DAY_NS // 8, f"i{number:06}"
        closed_ns = opened_ns + _LONG_NS
        address = f"{dice.choice(_STREETS)} {dice.randrange(1, 200)}"
        report = NoteDispatch(f"D{number}", "json", type="Structure fire", address=address)
        encoded = msgspec.json.encode(report).decode()
        add(DispatchRow, number=report.number, updated_ns=0, report=encoded)
        add(
            IncidentRow, incident_id=incident_id, name=f"Alarm {number}", opened_ns=opened_ns,
            opened_by="", closed_ns=closed_ns, closed_by="", dispatch_number=report.number,
            has_members=True,
        )  # fmt: skip
        for place, person in enumerate(dice.sample(range(_PEOPLE), _CREW)):
            unit_id = f"FF-{place:02}"
            add(IncidentMember, unit_id=unit_id, from_ns=opened_ns, incident_id=incident_id,
                until_ns=closed_ns)  # fmt: skip
            add(
                Assignment, action_id=f"{incident_id}-{place}", unit_id=unit_id,
                person_id=f"p{person:04}", person_name="", crew="", role="",
                from_ns=opened_ns - NS_PER_S, until_ns=closed_ns + NS_PER_S,
            )  # fmt: skip
        for one in range(dice.randrange(6)):
            raised_ns = opened_ns + (one + 1) * 60 * NS_PER_S
            add(
                AlarmRow, alarm_id=f"{incident_id}-{one}", rule=dice.choice(ALARMS).name,
                unit_id="FF-00", priority=1, state="resolved", level="", text="", by="",
                raised_ns=raised_ns, changed_ns=raised_ns,
            )  # fmt: skip
    with store.write() as session:
        for table, of_table in rows.items():
            session.execute(insert(table), of_table)


def search_figures(folder: Path, incidents: int) -> list[SearchFigures]:
    """The first search, which makes the index, and others."""
    with Store(folder / "station.sqlite") as store:
        fill(store, incidents)
        search = IncidentSearch(store)
        begun_s = time.perf_counter()
        count = search.index_changes()
        figures = [SearchFigures("once: make the index", count, time.perf_counter() - begun_s)]
        last_years = Window(incidents * _DAY_NS // 16, EVER.until_ns)
        queries = {
            "place: mill lane": IncidentQuery("mill lane"),
            "place, of every incident: fire": IncidentQuery("fire"),
            "person: ada": IncidentQuery(person="ada"),
            "alarm: mayday": IncidentQuery(alarm=ALARMS[0].name),
            "date: the newer half": IncidentQuery("alarm", opened=last_years),
            "all four": IncidentQuery("oak", "ada", ALARMS[0].name, last_years),
            "nothing is found": IncidentQuery("nowhere"),
        }
        return figures + [_figures(search, asked, query) for asked, query in queries.items()]


def _figures(search: IncidentSearch, asked: str, query: IncidentQuery) -> SearchFigures:
    times_s = []
    for _ in range(_REPEATED):
        begun_s = time.perf_counter()
        found = search.find(query, _PAGE)
        times_s.append(time.perf_counter() - begun_s)
    return SearchFigures(asked, len(found), max(times_s))
