"""Sensors of units, and where they are worn."""

from __future__ import annotations

import sqlalchemy as sa
from alembic import op

revision = "0016"
down_revision = "0015"
branch_labels = None
depends_on = None


def upgrade() -> None:
    column = sa.Column("sensors", sa.String(), nullable=False, server_default="[]")
    op.add_column("units", column)


def downgrade() -> None:
    op.drop_column("units", "sensors")
