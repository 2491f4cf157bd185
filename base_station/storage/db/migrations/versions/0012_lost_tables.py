"""Tables whose rows a database lost when it was made again, and the other station may have."""

from __future__ import annotations

import sqlalchemy as sa
from alembic import op

revision = "0012"
down_revision = "0011"
branch_labels = None
depends_on = None


def upgrade() -> None:
    op.create_table(
        "lost_tables",
        sa.Column("name", sa.String(), nullable=False),
        sa.PrimaryKeyConstraint("name", name=op.f("pk_lost_tables")),
    )


def downgrade() -> None:
    op.drop_table("lost_tables")
