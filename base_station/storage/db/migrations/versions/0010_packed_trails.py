"""Trails as they are known afterwards are kept packed, unit by unit."""

from __future__ import annotations

import zlib
from collections.abc import Iterator
from typing import Any

import msgspec
import sqlalchemy as sa
import zstandard
from alembic import op

revision = "0010"
down_revision = "0009"
branch_labels = None
depends_on = None

_COLUMNS = (
    "t_ns", "north_m", "east_m", "down_m", "std_north_m", "std_east_m", "std_down_m",
    "heading_rad", "floor", "quality",
)  # fmt: skip


def upgrade() -> None:
    table = op.create_table(
        "incident_trails",
        sa.Column("incident_id", sa.String(), nullable=False),
        sa.Column("unit_id", sa.String(), nullable=False),
        sa.Column("smoothed", sa.LargeBinary(), nullable=True),
        sa.Column("raw", sa.LargeBinary(), nullable=True),
        sa.PrimaryKeyConstraint("incident_id", "unit_id", name=op.f("pk_incident_trails")),
    )
    connection = op.get_bind()
    for (incident_id,) in connection.execute(sa.text(_INCIDENTS)).all():
        raw = _raw(connection, incident_id)
        for unit_id in sorted({*_units(connection, incident_id), *raw}):
            smoothed = _smoothed(connection, incident_id, unit_id)
            row = {"incident_id": incident_id, "unit_id": unit_id}
            row |= {"smoothed": _packed(smoothed), "raw": _packed(raw.get(unit_id, []))}
            connection.execute(table.insert(), row)
    op.drop_table("smoothed_tracks")
    op.drop_column("looked_back", "raw_tracks")


def downgrade() -> None:
    """Trails are worked out again where they are missing."""
    for name in ("looked_back", "smoothed_incidents"):
        op.execute(f"DELETE FROM {name}")  # noqa: S608  # names of tables
    op.drop_table("incident_trails")
    op.add_column("looked_back", sa.Column("raw_tracks", sa.LargeBinary(), nullable=False))
    op.create_table(
        "smoothed_tracks",
        sa.Column("incident_id", sa.String(), primary_key=True),
        sa.Column("unit_id", sa.String(), primary_key=True),
        sa.Column("t_ns", sa.BigInteger(), primary_key=True, autoincrement=False),
        *(sa.Column(name, sa.Float(), nullable=False) for name in _COLUMNS[1:8]),
        sa.Column("floor", sa.Integer()),
        sa.Column("quality", sa.String(), nullable=False),
    )


_INCIDENTS = """
    SELECT DISTINCT incident_id FROM smoothed_tracks
    UNION SELECT incident_id FROM looked_back
"""


def _units(connection: sa.Connection, incident_id: str) -> Iterator[str]:
    wanted = sa.text("SELECT DISTINCT unit_id FROM smoothed_tracks WHERE incident_id = :one")
    return iter(connection.scalars(wanted, {"one": incident_id}).all())


def _smoothed(connection: sa.Connection, incident_id: str, unit_id: str) -> list[dict[str, Any]]:
    wanted = sa.text(
        f"SELECT {', '.join(_COLUMNS)} FROM smoothed_tracks "  # noqa: S608  # names of columns
        "WHERE incident_id = :incident AND unit_id = :unit ORDER BY t_ns"
    )
    rows = connection.execute(wanted, {"incident": incident_id, "unit": unit_id})
    return [dict(row._mapping) for row in rows]  # noqa: SLF001  # as SQLAlchemy calls it


def _raw(connection: sa.Connection, incident_id: str) -> dict[str, list[dict[str, Any]]]:
    wanted = sa.text("SELECT raw_tracks FROM looked_back WHERE incident_id = :one")
    packed = connection.scalars(wanted, {"one": incident_id}).first()
    if packed is None:
        return {}
    raw: dict[str, list[dict[str, Any]]] = msgspec.msgpack.decode(zlib.decompress(packed))
    return raw


def _packed(track: list[dict[str, Any]]) -> bytes | None:
    if not track:
        return None
    columns = {name: [sample[name] for sample in track] for name in _COLUMNS}
    return zstandard.ZstdCompressor().compress(msgspec.msgpack.encode(columns))
