"""Tombstones of users, sessions, tickets and API tokens that were removed, of forgotten people.

Of two stations one may do this while the other is off, or cannot be reached, and leads later.  So
removed rows are kept by name and copied in both directions, and are never restored.
"""

from __future__ import annotations

from sqlalchemy.orm import Session

from base_station.storage.db.models import (
    ApiToken,
    Base,
    LoginSession,
    LoginTransferTicket,
    PersonRow,
    Tombstone,
    User,
)

PERSON = "person "  # before the id


def end(
    session: Session, row: User | LoginSession | LoginTransferTicket | ApiToken | PersonRow
) -> None:
    """Delete it, for good."""
    until_ns = getattr(row, "expires_ns", None)
    session.merge(Tombstone(what=name_of(row), until_ns=until_ns))
    session.delete(row)


def name_of(row: Base) -> str:
    """Return the name of a row's tombstone, which no other row ever has."""
    match row:
        case User():
            return f"user {row.username} {row.created_ns}"
        case LoginSession():
            return f"session {row.token_hash}"
        case LoginTransferTicket():
            return f"ticket {row.ticket_hash}"
        case ApiToken():
            return f"token {row.token_id}"
        case PersonRow():
            return f"{PERSON}{row.person_id}"
    raise TypeError(type(row))
