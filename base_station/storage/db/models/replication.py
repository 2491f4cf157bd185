"""Notes for the exchange of kept rows between two stations: kept themselves."""

from __future__ import annotations

from sqlalchemy.orm import Mapped, mapped_column

from base_station.storage.db.models.base import Base


class Tombstone(Base):
    """Mark of a row that was removed for good (``tombstones``): a station that was not connected
    then does not bring it back.
    """

    __tablename__ = "ended"

    what: Mapped[str] = mapped_column(primary_key=True)
    until_ns: Mapped[int | None]  # by itself it would have ended then; None: never


class LostTable(Base):
    """A kept table whose rows this database lost when it was made again: the other station has
    them, until it has given them back.
    """

    __tablename__ = "lost_tables"

    name: Mapped[str] = mapped_column(primary_key=True)
