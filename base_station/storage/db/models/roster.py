"""People (kept), and units with their wearers (projections)."""

from __future__ import annotations

from sqlalchemy import Index, LargeBinary
from sqlalchemy.orm import Mapped, mapped_column

from base_station.storage.db.models.base import Base


class PersonRow(Base):
    """Nothing else has a person's name: logs, and what is made of them, have the id."""

    __tablename__ = "people"

    person_id: Mapped[str] = mapped_column(primary_key=True)
    name: Mapped[str]
    crew: Mapped[str]
    role: Mapped[str]
    created_ns: Mapped[int]
    photo: Mapped[bytes | None] = mapped_column(LargeBinary, deferred=True)  # JPEG
    photo_hash: Mapped[str | None]
    removed_ns: Mapped[int | None]  # from the roster; the name stays for incidents of before


class Unit(Base):
    """A wearable that is registered or has sent a message."""

    __tablename__ = "units"

    unit_id: Mapped[str] = mapped_column(primary_key=True)
    label: Mapped[str]
    registered_ns: Mapped[int | None]  # None: received, but not ours
    last_heard_ns: Mapped[int | None]
    software_version: Mapped[str]
    source: Mapped[str]
    sensor_name: Mapped[str]
    tracker: Mapped[str]
    calibration: Mapped[str]
    has_gps: Mapped[bool]
    # JSON of ``base_station.core.units.worn_sensors.WornSensor``, a list
    sensors: Mapped[str] = mapped_column(server_default="[]")


class Assignment(Base):
    """Wearer of a unit, from when until when; name, crew and role as they were then only where
    the log is of an earlier version, and otherwise empty.
    """

    __tablename__ = "assignments"
    __table_args__ = (Index("ix_assignments_unit_id_from_ns", "unit_id", "from_ns"),)

    action_id: Mapped[str] = mapped_column(primary_key=True)
    unit_id: Mapped[str]
    person_id: Mapped[str]
    person_name: Mapped[str]
    crew: Mapped[str]
    role: Mapped[str]
    from_ns: Mapped[int]
    until_ns: Mapped[int | None]
