"""Scopes of a token: the parts of the API that it is for."""

from __future__ import annotations

import sqlalchemy as sa
from alembic import op

revision = "0002"
down_revision = "0001"
branch_labels = None
depends_on = None


def upgrade() -> None:
    column = sa.Column("scopes", sa.String(), nullable=False, server_default="")
    op.add_column("api_tokens", column)


def downgrade() -> None:
    op.drop_column("api_tokens", "scopes")
