"""Index of the search for incidents: a projection."""

from __future__ import annotations

from sqlalchemy import String
from sqlalchemy.orm import Mapped, mapped_column

from base_station.storage.db.models.base import Base


class IndexedIncident(Base):
    """The search finds an incident as it was known then (``search_index``)."""

    __tablename__ = "indexed_incidents"

    incident_id: Mapped[str] = mapped_column(primary_key=True)
    known_ns: Mapped[int]  # station time of its newest record; 0: open, or to be indexed again


class SearchTerm(Base):
    """A term by which an incident is found: a word, a person in it, or the rule of an alarm."""

    __tablename__ = "search_terms"

    kind: Mapped[str] = mapped_column(primary_key=True)
    # A word of the place; the id of a person; the name of a rule.  In the order of its bytes:
    # words that begin alike stand beside each other.
    value: Mapped[str] = mapped_column(
        String().with_variant(String(collation="C"), "postgresql"), primary_key=True
    )
    incident_id: Mapped[str] = mapped_column(primary_key=True, index=True)
