"""Logins that end at both stations and go on at the other; the audit in the order of its coming."""

from __future__ import annotations

import sqlalchemy as sa
from alembic import op

revision = "0006"
down_revision = "0005"
branch_labels = None
depends_on = None

_AUDIT = ("entry_id", "t_ns", "by", "action", "detail")


def upgrade() -> None:
    for table in ("users", "sessions"):
        generation = sa.Column("generation", sa.BigInteger(), server_default="0", nullable=False)
        op.add_column(table, generation)
    op.create_table(
        "hand_overs",
        sa.Column("ticket_hash", sa.String(), nullable=False),
        sa.Column("session_hash", sa.String(), nullable=False),
        sa.Column("expires_ns", sa.BigInteger(), nullable=False),
        sa.ForeignKeyConstraint(
            ["session_hash"],
            ["sessions.token_hash"],
            name=op.f("fk_hand_overs_session_hash_sessions"),
            ondelete="CASCADE",
        ),
        sa.PrimaryKeyConstraint("ticket_hash", name=op.f("pk_hand_overs")),
    )
    _make_audit_again(
        sa.Column("number", sa.Integer(), nullable=False),
        sa.UniqueConstraint("entry_id", name=op.f("uq_audit_entry_id")),
        sa.PrimaryKeyConstraint("number", name=op.f("pk_audit")),
    )


def downgrade() -> None:
    _make_audit_again(sa.PrimaryKeyConstraint("entry_id", name=op.f("pk_audit")))
    op.drop_table("hand_overs")
    for table in ("sessions", "users"):
        op.drop_column(table, "generation")


def _make_audit_again(*parts: sa.Column[int] | sa.Constraint) -> None:
    """SQLite changes no primary key in place."""
    op.rename_table("audit", "audit_before")
    if op.get_context().dialect.name == "postgresql":  # its names are of the schema, not the table
        for name in ("pk_audit", "uq_audit_entry_id"):
            op.execute(f"ALTER TABLE audit_before DROP CONSTRAINT IF EXISTS {name}")
    op.drop_index("ix_audit_t_ns", "audit_before")
    op.create_table(
        "audit",
        sa.Column("entry_id", sa.String(), nullable=False),
        sa.Column("t_ns", sa.BigInteger(), nullable=False),
        sa.Column("by", sa.String(), nullable=False),
        sa.Column("action", sa.String(), nullable=False),
        sa.Column("detail", sa.String(), nullable=False),
        *parts,
        sqlite_autoincrement=any(isinstance(part, sa.Column) for part in parts),
    )
    columns = ", ".join(f'"{name}"' for name in _AUDIT)
    op.execute(
        f"INSERT INTO audit ({columns}) SELECT {columns} FROM audit_before "  # noqa: S608  # ours
        "ORDER BY t_ns, entry_id"
    )
    op.drop_table("audit_before")
    op.create_index("ix_audit_t_ns", "audit", ["t_ns"])
