"""Alarms and their transitions: projections."""

from __future__ import annotations

from sqlalchemy.orm import Mapped, mapped_column

from base_station.storage.db.models.base import Base


class AlarmRow(Base):
    """An alarm as it stands."""

    __tablename__ = "alarms"

    alarm_id: Mapped[str] = mapped_column(primary_key=True)
    rule: Mapped[str]
    unit_id: Mapped[str]
    priority: Mapped[int]
    state: Mapped[str]
    level: Mapped[str]
    text: Mapped[str]
    by: Mapped[str]
    raised_ns: Mapped[int] = mapped_column(index=True)
    last_raised_ns: Mapped[int] = mapped_column(server_default="0")  # at first, or anew
    changed_ns: Mapped[int]
    code: Mapped[str] = mapped_column(server_default="")  # empty: of an earlier version
    parameters: Mapped[str] = mapped_column(server_default="{}")  # JSON
    reason: Mapped[str] = mapped_column(server_default="")  # of its resolution, as a code
    note: Mapped[str] = mapped_column(server_default="")
    peak: Mapped[float | None]  # worst value so far of its rule's measure


class AlarmTransition(Base):
    """One change in the life of an alarm."""

    __tablename__ = "alarm_changes"

    alarm_id: Mapped[str] = mapped_column(primary_key=True)
    t_ns: Mapped[int] = mapped_column(primary_key=True, autoincrement=False)
    state: Mapped[str] = mapped_column(primary_key=True)
    level: Mapped[str] = mapped_column(primary_key=True)
    text: Mapped[str]
    by: Mapped[str]
    code: Mapped[str] = mapped_column(server_default="")
    parameters: Mapped[str] = mapped_column(server_default="{}")
    reason: Mapped[str] = mapped_column(server_default="")  # as above
    note: Mapped[str] = mapped_column(server_default="")
    peak: Mapped[float | None]
