"""Names of people removed from the roster, for earlier incidents: the log has no names."""

from __future__ import annotations

import sqlalchemy as sa
from alembic import op

revision = "0013"
down_revision = "0012"
branch_labels = None
depends_on = None


def upgrade() -> None:
    op.add_column("people", sa.Column("removed_ns", sa.BigInteger(), nullable=True))


def downgrade() -> None:
    op.drop_column("people", "removed_ns")
