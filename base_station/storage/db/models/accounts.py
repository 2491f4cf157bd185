"""Users, their sessions and tokens, and the audit: kept, the log has none of it."""

from __future__ import annotations

from sqlalchemy import ForeignKey, Integer
from sqlalchemy.orm import Mapped, mapped_column

from base_station.storage.db.models.base import Base


class User(Base):
    __tablename__ = "users"

    username: Mapped[str] = mapped_column(primary_key=True)
    password_hash: Mapped[str]
    role: Mapped[str]
    created_ns: Mapped[int]  # with the name, identifies the user; the name may be used again
    generation: Mapped[int] = mapped_column(server_default="0")  # of logins; older ones are over
    role_ns: Mapped[int] = mapped_column(server_default="0")  # since when; of two stations' the
    password_ns: Mapped[int] = mapped_column(server_default="0")  # later holds


class LoginSession(Base):
    __tablename__ = "sessions"

    token_hash: Mapped[str] = mapped_column(primary_key=True)  # SHA-256 of the cookie
    username: Mapped[str] = mapped_column(ForeignKey("users.username", ondelete="CASCADE"))
    created_ns: Mapped[int]
    expires_ns: Mapped[int]
    generation: Mapped[int] = mapped_column(server_default="0")  # its user's when it began


class LoginTransferTicket(Base):
    """Ticket that continues a session at the other station, once."""

    __tablename__ = "hand_overs"

    ticket_hash: Mapped[str] = mapped_column(primary_key=True)  # SHA-256
    session_hash: Mapped[str] = mapped_column(ForeignKey("sessions.token_hash", ondelete="CASCADE"))
    expires_ns: Mapped[int]


class ApiToken(Base):
    __tablename__ = "api_tokens"

    token_id: Mapped[str] = mapped_column(primary_key=True)
    token_hash: Mapped[str] = mapped_column(unique=True)  # SHA-256 of the token
    username: Mapped[str] = mapped_column(ForeignKey("users.username", ondelete="CASCADE"))
    name: Mapped[str]
    role: Mapped[str]  # at most that of its owner
    scopes: Mapped[str] = mapped_column(server_default="")  # separated by spaces; empty: all
    created_ns: Mapped[int]
    expires_ns: Mapped[int | None]
    unit_id: Mapped[str] = mapped_column(server_default="")  # it posts samples of; empty: none


class AuditEntry(Base):
    """Entry of the audit; one of an operator's action carries the action's own id."""

    __tablename__ = "audit"
    __table_args__ = {"sqlite_autoincrement": True}  # noqa: RUF012  # SQLAlchemy's way

    # In the order in which this station got to know; the other station's clock may be another.
    number: Mapped[int] = mapped_column(Integer, primary_key=True)
    entry_id: Mapped[str] = mapped_column(unique=True)
    t_ns: Mapped[int] = mapped_column(index=True)
    by: Mapped[str]
    action: Mapped[str]
    detail: Mapped[str]
