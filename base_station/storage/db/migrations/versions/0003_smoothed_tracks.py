"""Smoothed trails beside the tracks that were shown."""

from __future__ import annotations

import sqlalchemy as sa
from alembic import op

revision = "0003"
down_revision = "0002"
branch_labels = None
depends_on = None


def upgrade() -> None:
    op.create_table(
        "smoothed_incidents",
        sa.Column("incident_id", sa.String(), nullable=False),
        sa.Column("smoother", sa.String(), nullable=False),
        sa.Column("made_ns", sa.BigInteger(), nullable=False),
        sa.PrimaryKeyConstraint("incident_id", name=op.f("pk_smoothed_incidents")),
    )
    op.create_table(
        "smoothed_tracks",
        sa.Column("incident_id", sa.String(), nullable=False),
        sa.Column("unit_id", sa.String(), nullable=False),
        sa.Column("t_ns", sa.BigInteger(), autoincrement=False, nullable=False),
        sa.Column("north_m", sa.Double(), nullable=False),
        sa.Column("east_m", sa.Double(), nullable=False),
        sa.Column("down_m", sa.Double(), nullable=False),
        sa.Column("std_north_m", sa.Double(), nullable=False),
        sa.Column("std_east_m", sa.Double(), nullable=False),
        sa.Column("std_down_m", sa.Double(), nullable=False),
        sa.Column("heading_rad", sa.Double(), nullable=False),
        sa.Column("floor", sa.BigInteger(), nullable=True),
        sa.Column("quality", sa.String(), nullable=False),
        sa.PrimaryKeyConstraint("incident_id", "unit_id", "t_ns", name=op.f("pk_smoothed_tracks")),
    )


def downgrade() -> None:
    op.drop_table("smoothed_tracks")
    op.drop_table("smoothed_incidents")
