"""Identity of the log of a segment.  An older program, whose segments do not carry it, opens this
database no more: they would be left out of the log.
"""

from __future__ import annotations

import sqlalchemy as sa
from alembic import op

revision = "0011"
down_revision = "0010"
branch_labels = None
depends_on = None


def upgrade() -> None:
    op.add_column(
        "log_segments", sa.Column("log_id", sa.String(), server_default="", nullable=False)
    )


def downgrade() -> None:
    op.drop_column("log_segments", "log_id")
