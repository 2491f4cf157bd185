"""Who was removed from the roster keeps the name for incidents of before: the log has none."""

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
