"""Tokens with which units post their samples to the station: one part of the API, one unit.

They are rows of the API tokens, so that they reach the other station and end there as those do.
A token belongs to the administrator who made it and ends when that user is removed; a new password
of the user does not end it, as the unit would be silent then.
"""

from __future__ import annotations

import hashlib
import secrets
from collections.abc import Callable, Sequence

from sqlalchemy import delete, func, select

from base_station.accounts.principals import Role
from base_station.storage.db.database import Database
from base_station.storage.db.models import ApiToken, User
from base_station.storage.db.tombstones import end
from shared.clock import Clock
from shared.coded_text import coded
from shared.errors import UserError

TOKEN_PREFIX = "muster_"  # noqa: S105  # so that a leaked token can be found
SCOPE = "samples"
MOST_OF_A_UNIT = 5  # one in use, and its successor


class UnitTokens:
    """Thread-safe; every method is one transaction."""

    def __init__(
        self, store: Database, clock: Clock, forget_principals: Callable[[], None]
    ) -> None:
        """``forget_principals``: has every token looked up again."""
        self._store = store
        self._clock = clock
        self._forget_principals = forget_principals

    def add(self, unit_id: str, by: str, expires_ns: int | None) -> tuple[str, str]:
        """``(token_id, secret)``; the secret is never to be had again.  ``by``: its owner.

        Raises UserError where there is no such user, or the unit has too many.
        """
        secret, token_id = TOKEN_PREFIX + secrets.token_urlsafe(32), secrets.token_hex(8)
        with self._store.write() as session:
            if session.get(User, by) is None:
                raise UserError(coded("token-maker-unknown", "there is no user {user!r}", user=by))
            of_unit = ApiToken.unit_id == unit_id
            ended = ApiToken.expires_ns <= self._clock.utc_ns()
            session.execute(delete(ApiToken).where(of_unit, ended))
            if (session.scalar(select(func.count()).where(of_unit)) or 0) >= MOST_OF_A_UNIT:
                raise UserError(
                    coded(
                        "unit-tokens-too-many",
                        "{unit} has {most} tokens; remove one of them first",
                        unit=unit_id,
                        most=MOST_OF_A_UNIT,
                    )
                )
            session.add(
                ApiToken(
                    token_id=token_id,
                    token_hash=sha256(secret),
                    username=by,
                    name=f"samples of {unit_id}",
                    role=Role.VIEWER.word,
                    scopes=SCOPE,
                    created_ns=self._clock.utc_ns(),
                    expires_ns=expires_ns,
                    unit_id=unit_id,
                )
            )
        return token_id, secret

    def remove(self, unit_id: str, token_id: str) -> bool:
        """End a token for good; False where the unit has no such token."""
        self._forget_principals()
        with self._store.write() as session:
            token = session.get(ApiToken, token_id)
            if token is None or token.unit_id != unit_id:
                return False
            end(session, token)
            return True

    def of(self, unit_id: str) -> Sequence[ApiToken]:
        """The unit's tokens, the oldest first."""
        with self._store.read() as session:
            found = select(ApiToken).where(ApiToken.unit_id == unit_id)
            return session.scalars(found.order_by(ApiToken.created_ns)).all()


def sha256(secret: str) -> str:
    return hashlib.sha256(secret.encode()).hexdigest()
