"""Raw trails and assessments of closed incidents are kept."""

from __future__ import annotations

import sqlalchemy as sa
from alembic import op

revision = "0004"
down_revision = "0003"
branch_labels = None
depends_on = None


def upgrade() -> None:
    op.create_table(
        "looked_back",
        sa.Column("incident_id", sa.String(), nullable=False),
        sa.Column("raw_tracks", sa.LargeBinary(), nullable=False),
        sa.Column("report", sa.LargeBinary(), nullable=True),
        sa.PrimaryKeyConstraint("incident_id", name=op.f("pk_looked_back")),
    )


def downgrade() -> None:
    op.drop_table("looked_back")
