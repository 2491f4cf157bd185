"""Reports of the dispatch centre, and the incidents that were opened from them."""

from __future__ import annotations

import sqlalchemy as sa
from alembic import op

revision = "0015"
down_revision = "0014"
branch_labels = None
depends_on = None


def upgrade() -> None:
    number = sa.Column("dispatch_number", sa.String(), nullable=False, server_default="")
    op.add_column("incidents", number)
    op.create_table(
        "dispatches",
        sa.Column("number", sa.String(), nullable=False),
        sa.Column("updated_ns", sa.BigInteger(), nullable=False),
        sa.Column("report", sa.String(), nullable=False),
        sa.PrimaryKeyConstraint("number", name="pk_dispatches"),
    )


def downgrade() -> None:
    op.drop_table("dispatches")
    op.drop_column("incidents", "dispatch_number")
