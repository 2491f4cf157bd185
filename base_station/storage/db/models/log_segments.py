"""Files of the log: a projection."""

from __future__ import annotations

from sqlalchemy.orm import Mapped, mapped_column

from base_station.storage.db.models.base import Base


class LogSegment(Base):
    """One file of the log."""

    __tablename__ = "log_segments"

    name: Mapped[str] = mapped_column(primary_key=True)
    first_ns: Mapped[int]
    last_ns: Mapped[int]
    messages: Mapped[int]
    size_bytes: Mapped[int]
    note: Mapped[str]  # of its recovery; empty: none
    log_id: Mapped[str] = mapped_column(default="", server_default="")  # empty: an earlier version
