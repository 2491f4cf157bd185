"""Picture of the ground (kept), and anchors, plans and start positions (projections)."""

from __future__ import annotations

from sqlalchemy import LargeBinary
from sqlalchemy.orm import Mapped, mapped_column

from base_station.storage.db.models.base import Base


class BaseMap(Base):
    """A picture of the ground about the site, and where its corners are; there is one or none."""

    __tablename__ = "base_map"

    image_hash: Mapped[str] = mapped_column(primary_key=True)
    image: Mapped[bytes] = mapped_column(LargeBinary, deferred=True)  # WebP
    corners: Mapped[bytes]  # JSON of ``base_station.site.base_map.Corners``


class AnchorRow(Base):
    """Place of the incident frame on the Earth from a time on."""

    __tablename__ = "anchors"

    action_id: Mapped[str] = mapped_column(primary_key=True)
    t_ns: Mapped[int] = mapped_column(index=True)
    lat_deg: Mapped[float]
    lon_deg: Mapped[float]
    height_m: Mapped[float]
    plan_rotation_rad: Mapped[float]
    incident_id: Mapped[str] = mapped_column(server_default="")  # empty: of the station's own site


class PlanRow(Base):
    """The building's plan from then on, as site GeoJSON."""

    __tablename__ = "plans"

    action_id: Mapped[str] = mapped_column(primary_key=True)
    t_ns: Mapped[int] = mapped_column(index=True)
    geojson: Mapped[bytes] = mapped_column(LargeBinary, deferred=True)
    incident_id: Mapped[str] = mapped_column(server_default="")  # as above


class UnitStart(Base):
    """Place where a unit's own frame began, as set by a person."""

    __tablename__ = "starts"

    action_id: Mapped[str] = mapped_column(primary_key=True)
    t_ns: Mapped[int]
    unit_id: Mapped[str] = mapped_column(index=True)
    north_m: Mapped[float]
    east_m: Mapped[float]
    down_m: Mapped[float]
    heading_rad: Mapped[float]
