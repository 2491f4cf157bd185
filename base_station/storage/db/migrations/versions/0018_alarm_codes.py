"""Codes and parameters of alarms, from which consoles make their sentences in every language.

Alarms of an earlier version have their English sentence alone.
"""

from __future__ import annotations

import sqlalchemy as sa
from alembic import op

revision = "0018"
down_revision = "0017"
branch_labels = None
depends_on = None

_TABLES = ("alarms", "alarm_changes")


def upgrade() -> None:
    for table in _TABLES:
        op.add_column(table, _text("code", ""))
        op.add_column(table, _text("parameters", "{}"))


def downgrade() -> None:
    for table in _TABLES:
        op.drop_column(table, "parameters")
        op.drop_column(table, "code")


def _text(name: str, default: str) -> sa.Column[str]:
    return sa.Column(name, sa.String(), nullable=False, server_default=default)
