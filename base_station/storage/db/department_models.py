"""The tables of a department: reports of its stations.

They stand beside those of a station in the department's database, of which users, sessions and the
audit are used.  Times in ms are the reporting station's own; ``offset_ms`` is the lead of its
clock over the department's when it reported.
"""

from __future__ import annotations

from sqlalchemy import BigInteger, Integer, LargeBinary, MetaData
from sqlalchemy.orm import DeclarativeBase, Mapped, mapped_column, relationship
from sqlalchemy.schema import ForeignKeyConstraint, UniqueConstraint

SCHEMA_VERSION = 1


class DepartmentBase(DeclarativeBase):
    metadata = MetaData()
    type_annotation_map = {int: BigInteger}  # noqa: RUF012  # SQLAlchemy's way


class DepartmentSchema(DepartmentBase):
    """Version of these tables; there is one row."""

    __tablename__ = "department_schema"

    version: Mapped[int] = mapped_column(Integer, primary_key=True, autoincrement=False)


class LastSummary(DepartmentBase):
    """Newest summary of a station, so that it is shown after a restart while the station is away;
    written now and then.
    """

    __tablename__ = "department_summaries"

    station: Mapped[str] = mapped_column(primary_key=True)
    received_ns: Mapped[int]  # clock of the department
    summary: Mapped[bytes] = mapped_column(LargeBinary)  # as on the wire


class ReportedStream(DepartmentBase):
    """Progress of the events of one outbox of a station."""

    __tablename__ = "department_streams"

    station: Mapped[str] = mapped_column(primary_key=True)
    epoch: Mapped[int] = mapped_column(primary_key=True, autoincrement=False)
    last_seq: Mapped[int]
    missing: Mapped[int]  # numbers that were left out


class ReportedEvent(DepartmentBase):
    """An event, once, whichever machine of the station has reported it how often."""

    __tablename__ = "department_events"
    __table_args__ = (
        UniqueConstraint("station", "event_id"),
        {"sqlite_autoincrement": True},
    )

    number: Mapped[int] = mapped_column(Integer, primary_key=True)  # in the order of arrival
    station: Mapped[str]
    event_id: Mapped[str]
    kind: Mapped[str]  # alarm | par | incident | person; empty: of a newer station
    t_ms: Mapped[int]
    offset_ms: Mapped[int]
    received_ns: Mapped[int]  # clock of the department
    # As on the wire; empty where it has a name in it, which stands in a table of its own alone.
    body: Mapped[bytes] = mapped_column(LargeBinary)


class ReportedAlarm(DepartmentBase):
    """An alarm of a station as it stands."""

    __tablename__ = "department_alarms"

    station: Mapped[str] = mapped_column(primary_key=True)
    alarm_id: Mapped[str] = mapped_column(primary_key=True)
    rule: Mapped[str]
    unit_id: Mapped[str]
    priority: Mapped[int]
    state: Mapped[str] = mapped_column(index=True)
    level: Mapped[str]
    text: Mapped[str]  # people as references
    by: Mapped[str]
    raised_ms: Mapped[int]
    changed_ms: Mapped[int]
    offset_ms: Mapped[int]
    coded: Mapped[ReportedAlarmCode | None] = relationship(lazy="joined", viewonly=True)


class ReportedAlarmCode(DepartmentBase):
    """Code of an alarm's sentence; stations of an earlier version report none."""

    __tablename__ = "department_alarm_codes"
    __table_args__ = (
        ForeignKeyConstraint(
            ["station", "alarm_id"], ["department_alarms.station", "department_alarms.alarm_id"]
        ),
    )

    station: Mapped[str] = mapped_column(primary_key=True)
    alarm_id: Mapped[str] = mapped_column(primary_key=True)
    code: Mapped[str]
    parameters: Mapped[str]  # JSON of ``AlarmParameters``, people as references
    changed_ms: Mapped[int]


class ReportedIncident(DepartmentBase):
    __tablename__ = "department_incidents"

    station: Mapped[str] = mapped_column(primary_key=True)
    incident_id: Mapped[str] = mapped_column(primary_key=True)
    name: Mapped[str]
    opened_ms: Mapped[int]
    closed_ms: Mapped[int | None]
    offset_ms: Mapped[int]


class ReportedPerson(DepartmentBase):
    """A person of a station; nothing else has the name."""

    __tablename__ = "department_people"

    station: Mapped[str] = mapped_column(primary_key=True)
    person_id: Mapped[str] = mapped_column(primary_key=True)
    name: Mapped[str]  # empty: the person was erased
    crew: Mapped[str]
    role: Mapped[str]
