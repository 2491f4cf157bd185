"""Tokens with which a unit posts its samples."""

from __future__ import annotations

import sqlalchemy as sa
from alembic import op

revision = "0014"
down_revision = "0013"
branch_labels = None
depends_on = None


def upgrade() -> None:
    column = sa.Column("unit_id", sa.String(), nullable=False, server_default="")
    op.add_column("api_tokens", column)


def downgrade() -> None:
    op.drop_column("api_tokens", "unit_id")
