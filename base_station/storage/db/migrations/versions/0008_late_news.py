"""Time of late data of a closed incident, and the data with which its trails were made."""

from __future__ import annotations

import sqlalchemy as sa
from alembic import op

revision = "0008"
down_revision = "0007"
branch_labels = None
depends_on = None


def upgrade() -> None:
    for table, column in (("incidents", "news_ns"), ("smoothed_incidents", "known_ns")):
        op.add_column(table, sa.Column(column, sa.BigInteger(), server_default="0", nullable=False))


def downgrade() -> None:
    for table, column in (("smoothed_incidents", "known_ns"), ("incidents", "news_ns")):
        op.drop_column(table, column)
