"""Tracks as shown live, and results of post-processing: projections."""

from __future__ import annotations

from sqlalchemy import LargeBinary
from sqlalchemy.orm import Mapped, mapped_column

from base_station.storage.db.models.base import Base


class TrackPoint(Base):
    """Place of a unit, at most once a second; NED metres about the site anchor."""

    __tablename__ = "tracks"
    __table_args__ = {"postgresql_partition_by": "RANGE (t_s)"}  # noqa: RUF012  # as above

    unit_id: Mapped[str] = mapped_column(primary_key=True)
    t_s: Mapped[int] = mapped_column(primary_key=True, autoincrement=False)  # whole seconds
    t_ns: Mapped[int]
    north_m: Mapped[float]
    east_m: Mapped[float]
    down_m: Mapped[float]
    std_north_m: Mapped[float]
    std_east_m: Mapped[float]
    std_down_m: Mapped[float]
    heading_rad: Mapped[float]
    floor: Mapped[int | None]
    quality: Mapped[str]


class SmoothedIncident(Base):
    """That trails were smoothed, and when."""

    __tablename__ = "smoothed_incidents"

    incident_id: Mapped[str] = mapped_column(primary_key=True)
    smoother: Mapped[str]
    made_ns: Mapped[int]
    known_ns: Mapped[int] = mapped_column(server_default="0")  # with the news of until then


class IncidentTrails(Base):
    """Trails of one unit, as known afterwards (``base_station.storage.db.smoothed``)."""

    __tablename__ = "incident_trails"

    incident_id: Mapped[str] = mapped_column(primary_key=True)
    unit_id: Mapped[str] = mapped_column(primary_key=True)
    smoothed: Mapped[bytes | None] = mapped_column(LargeBinary)  # None: there is none
    raw: Mapped[bytes | None] = mapped_column(LargeBinary)  # by the unit's own path alone


class PostProcessingCache(Base):
    """The assessment that was worked out once of a closed incident; msgpack of
    ``base_station.replay.assessment.report``.
    """

    __tablename__ = "looked_back"

    incident_id: Mapped[str] = mapped_column(primary_key=True)
    report: Mapped[bytes | None] = mapped_column(LargeBinary)  # None: not assessed yet
