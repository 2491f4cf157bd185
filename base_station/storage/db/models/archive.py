"""Copies of incidents in archives, with the index by which their files are read: kept."""

from __future__ import annotations

from sqlalchemy.orm import Mapped, mapped_column

from base_station.storage.db.models.base import Base

OUTDATED_NS = 0  # ``known_ns`` of a copy that an erasure has outdated


class ArchivedIncident(Base):
    """A copy of an incident in an archive; the archive has this and what follows as a file, too."""

    __tablename__ = "archived_incidents"

    incident_id: Mapped[str] = mapped_column(primary_key=True)
    archive: Mapped[str]  # its address
    archived_ns: Mapped[int]
    known_ns: Mapped[int]  # as ``IndexedIncident``; another than there: it is copied once more


class ArchivedObject(Base):
    """A file of a copy."""

    __tablename__ = "archived_objects"

    incident_id: Mapped[str] = mapped_column(primary_key=True)
    name: Mapped[str] = mapped_column(primary_key=True)
    size_bytes: Mapped[int]
    sha256: Mapped[str]
    summary_offset: Mapped[int]  # where the file's own table of contents begins
    topics: Mapped[str]  # JSON, a list


class ArchivedRange(Base):
    """A chunk of such a file: a request for these bytes gives all of that time."""

    __tablename__ = "archived_ranges"

    incident_id: Mapped[str] = mapped_column(primary_key=True)
    name: Mapped[str] = mapped_column(primary_key=True)
    offset: Mapped[int] = mapped_column(primary_key=True, autoincrement=False)
    size_bytes: Mapped[int]
    from_ns: Mapped[int]
    until_ns: Mapped[int]  # of the last message
