"""Inserts that update a row which is there already, for SQLite and PostgreSQL alike."""

from __future__ import annotations

from typing import Any

from sqlalchemy import ColumnElement, func
from sqlalchemy.dialects import postgresql, sqlite
from sqlalchemy.orm import DeclarativeBase, Session

Insert = sqlite.Insert | postgresql.Insert


def insert_into(session: Session, table: type[DeclarativeBase]) -> Insert:
    """An insert with ``on_conflict_do_nothing`` and ``on_conflict_do_update``."""
    return postgresql.insert(table) if is_on_server(session) else sqlite.insert(table)


def later_of(session: Session, one: ColumnElement[int], other: Any) -> ColumnElement[int]:
    """The larger of two values of a row."""
    larger = func.greatest if is_on_server(session) else func.max
    return larger(one, other)


def is_on_server(session: Session) -> bool:
    """True if the session is with PostgreSQL."""
    return session.get_bind().dialect.name == postgresql.dialect.name
