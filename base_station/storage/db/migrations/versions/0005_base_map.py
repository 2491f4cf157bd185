"""A picture of the ground about the site."""

from __future__ import annotations

import sqlalchemy as sa
from alembic import op

revision = "0005"
down_revision = "0004"
branch_labels = None
depends_on = None


def upgrade() -> None:
    op.create_table(
        "base_map",
        sa.Column("image_hash", sa.String(), nullable=False),
        sa.Column("image", sa.LargeBinary(), nullable=False),
        sa.Column("corners", sa.LargeBinary(), nullable=False),
        sa.PrimaryKeyConstraint("image_hash", name=op.f("pk_base_map")),
    )


def downgrade() -> None:
    op.drop_table("base_map")
