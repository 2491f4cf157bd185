"""People and incidents that were erased here, as copies elsewhere are held against."""

from __future__ import annotations

from typing import NamedTuple

from sqlalchemy import func, select

from base_station.storage.db.database import Database
from base_station.storage.db.erasure import erased_incidents
from base_station.storage.db.models import IncidentRow, Tombstone
from base_station.storage.db.tombstones import PERSON
from base_station.storage.db.window import FOREVER_NS


class ErasuresDone(NamedTuple):
    person_ids: frozenset[str]
    incidents_ns: dict[str, int]  # by id: station time at which it was erased last


def erasures_done(store: Database) -> ErasuresDone:
    people = select(Tombstone.what).where(Tombstone.what.startswith(PERSON, autoescape=True))
    with store.read() as session:
        erased = frozenset(one.removeprefix(PERSON) for one in session.scalars(people))
        return ErasuresDone(erased, erased_incidents(session))


def erased_incidents_since(
    store: Database, since_ns: int, from_ns: int, until_ns: int
) -> frozenset[str]:
    """Ids of incidents that were erased since, and were open between two station times."""
    incidents_ns = erasures_done(store).incidents_ns
    erased_since = [one for one, t_ns in incidents_ns.items() if t_ns >= since_ns]
    overlapping = select(IncidentRow.incident_id).where(
        IncidentRow.incident_id.in_(erased_since),
        IncidentRow.opened_ns < until_ns,
        func.coalesce(IncidentRow.closed_ns, FOREVER_NS) > from_ns,
    )
    with store.read() as session:
        return frozenset(session.scalars(overlapping))
