"""Members of each incident, of several that are open at once, and the site of a plan.

An incident of an earlier version has no members here: everyone was in it.
"""

from __future__ import annotations

import sqlalchemy as sa
from alembic import op

revision = "0017"
down_revision = "0016"
branch_labels = None
depends_on = None


def _text(name: str) -> sa.Column[str]:
    return sa.Column(name, sa.String(), nullable=False, server_default="")


def upgrade() -> None:
    op.add_column("incidents", _text("site_id"))
    has_members: sa.Column[bool] = sa.Column(
        "has_members", sa.Boolean(), nullable=False, server_default=sa.false()
    )
    op.add_column("incidents", has_members)
    op.add_column("plans", _text("incident_id"))
    op.add_column("anchors", _text("incident_id"))
    op.create_table(
        "incident_members",
        sa.Column("unit_id", sa.String(), nullable=False),
        sa.Column("from_ns", sa.BigInteger(), nullable=False),
        sa.Column("incident_id", sa.String(), nullable=False),
        sa.Column("until_ns", sa.BigInteger(), nullable=True),
        sa.PrimaryKeyConstraint("unit_id", "from_ns", name="pk_incident_members"),
    )
    op.create_index("ix_incident_members_incident_id", "incident_members", ["incident_id"])


def downgrade() -> None:
    op.drop_table("incident_members")
    op.drop_column("anchors", "incident_id")
    op.drop_column("plans", "incident_id")
    op.drop_column("incidents", "has_members")
    op.drop_column("incidents", "site_id")
