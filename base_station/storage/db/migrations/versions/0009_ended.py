"""Tombstones, and since when a user has role and password: for replication of two stations."""

from __future__ import annotations

import sqlalchemy as sa
from alembic import op

revision = "0009"
down_revision = "0008"
branch_labels = None
depends_on = None


def upgrade() -> None:
    for name in ("role_ns", "password_ns"):
        op.add_column("users", sa.Column(name, sa.BigInteger(), server_default="0", nullable=False))
    op.create_table(
        "ended",
        sa.Column("what", sa.String(), nullable=False),
        sa.Column("until_ns", sa.BigInteger(), nullable=True),
        sa.PrimaryKeyConstraint("what", name=op.f("pk_ended")),
    )


def downgrade() -> None:
    op.drop_table("ended")
    for name in ("password_ns", "role_ns"):
        op.drop_column("users", name)
