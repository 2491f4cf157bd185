"""Incidents, their members, dispatches and imported files: projections."""

from __future__ import annotations

from sqlalchemy import false
from sqlalchemy.orm import Mapped, mapped_column

from base_station.storage.db.models.base import Base


class IncidentRow(Base):
    __tablename__ = "incidents"

    incident_id: Mapped[str] = mapped_column(primary_key=True)
    name: Mapped[str]
    opened_ns: Mapped[int] = mapped_column(index=True)
    opened_by: Mapped[str]
    closed_ns: Mapped[int | None]
    closed_by: Mapped[str]
    # station time of the newest data that came after the end
    late_data_ns: Mapped[int] = mapped_column("news_ns", server_default="0")
    dispatch_number: Mapped[str] = mapped_column(server_default="")  # empty: opened from none
    site_id: Mapped[str] = mapped_column(server_default="")  # empty: on the station's own site
    # Its members are known; else it is of an earlier version, and everybody was in it.
    has_members: Mapped[bool] = mapped_column(server_default=false())


class IncidentMember(Base):
    """A unit in an incident, from when until when; in one at a time."""

    __tablename__ = "incident_members"

    unit_id: Mapped[str] = mapped_column(primary_key=True)
    from_ns: Mapped[int] = mapped_column(primary_key=True, autoincrement=False)
    incident_id: Mapped[str] = mapped_column(index=True)
    until_ns: Mapped[int | None]  # None: still


class DispatchRow(Base):
    """The newest report of a dispatch."""

    __tablename__ = "dispatches"

    number: Mapped[str] = mapped_column(primary_key=True)
    updated_ns: Mapped[int]  # time of the change at the dispatch centre; 0: not reported
    report: Mapped[str]  # JSON of ``shared.messages.station.NoteDispatch``


class ImportRow(Base):
    """A file that was brought into an incident (``base_station.storage.imports``)."""

    __tablename__ = "imports"

    incident_id: Mapped[str] = mapped_column(primary_key=True)
    import_id: Mapped[str] = mapped_column(primary_key=True)
    file_name: Mapped[str]  # with references to people, as texts of the log
    format: Mapped[str]
    sha256: Mapped[str]
    size_bytes: Mapped[int]
    shift_s: Mapped[float]
    first_ns: Mapped[int]
    last_ns: Mapped[int]
    t_ns: Mapped[int]  # when it was brought in
    by: Mapped[str]
