"""Time at which an alarm was raised last: at first, or anew."""

from __future__ import annotations

import sqlalchemy as sa
from alembic import op

revision = "0007"
down_revision = "0006"
branch_labels = None
depends_on = None


def upgrade() -> None:
    last_raised = sa.Column("last_raised_ns", sa.BigInteger(), server_default="0", nullable=False)
    op.add_column("alarms", last_raised)
    # Of alarms that are stepped again the log has the time; of earlier ones only this is known.
    op.execute("UPDATE alarms SET last_raised_ns = raised_ns")


def downgrade() -> None:
    op.drop_column("alarms", "last_raised_ns")
