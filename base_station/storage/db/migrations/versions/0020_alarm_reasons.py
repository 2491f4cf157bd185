"""Reasons why alarms were resolved, with a person's words, and the worst measured value meanwhile.

Of alarms of an earlier version the words stand behind who resolved them.
"""

from __future__ import annotations

import sqlalchemy as sa
from alembic import op

revision = "0020"
down_revision = "0019"
branch_labels = None
depends_on = None

_TABLES = ("alarms", "alarm_changes")


def upgrade() -> None:
    for table in _TABLES:
        for name in ("reason", "note"):
            text: sa.Column[str] = sa.Column(name, sa.String(), nullable=False, server_default="")
            op.add_column(table, text)
        peak: sa.Column[float] = sa.Column("peak", sa.Double(), nullable=True)
        op.add_column(table, peak)


def downgrade() -> None:
    for table in _TABLES:
        for name in ("reason", "note", "peak"):
            op.drop_column(table, name)
