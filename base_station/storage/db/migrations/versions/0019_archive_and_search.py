"""Words by which incidents are found, and what of them is in an archive."""

from __future__ import annotations

import sqlalchemy as sa
from alembic import op

revision = "0019"
down_revision = "0018"
branch_labels = None
depends_on = None


def _text(name: str) -> sa.Column[str]:
    return sa.Column(name, sa.String(), nullable=False)


def _number(name: str) -> sa.Column[int]:
    return sa.Column(name, sa.BigInteger(), nullable=False)


def upgrade() -> None:
    op.create_table(
        "indexed_incidents",
        _text("incident_id"),
        _number("known_ns"),
        sa.PrimaryKeyConstraint("incident_id", name="pk_indexed_incidents"),
    )
    in_bytes = sa.String().with_variant(sa.String(collation="C"), "postgresql")
    op.create_table(
        "search_terms",
        _text("kind"),
        sa.Column("value", in_bytes, nullable=False),
        _text("incident_id"),
        sa.PrimaryKeyConstraint("kind", "value", "incident_id", name="pk_search_terms"),
    )
    op.create_index("ix_search_terms_incident_id", "search_terms", ["incident_id"])
    op.create_index("ix_incidents_opened_ns", "incidents", ["opened_ns"])
    op.create_table(
        "archived_incidents",
        _text("incident_id"),
        _text("archive"),
        _number("archived_ns"),
        _number("known_ns"),
        sa.PrimaryKeyConstraint("incident_id", name="pk_archived_incidents"),
    )
    op.create_table(
        "archived_objects",
        _text("incident_id"),
        _text("name"),
        _number("size_bytes"),
        _text("sha256"),
        _number("summary_offset"),
        _text("topics"),
        sa.PrimaryKeyConstraint("incident_id", "name", name="pk_archived_objects"),
    )
    op.create_table(
        "archived_ranges",
        _text("incident_id"),
        _text("name"),
        _number("offset"),
        _number("size_bytes"),
        _number("from_ns"),
        _number("until_ns"),
        sa.PrimaryKeyConstraint("incident_id", "name", "offset", name="pk_archived_ranges"),
    )


def downgrade() -> None:
    for name in ("archived_ranges", "archived_objects", "archived_incidents"):
        op.drop_table(name)
    op.drop_index("ix_incidents_opened_ns", "incidents")
    op.drop_table("search_terms")
    op.drop_table("indexed_incidents")
