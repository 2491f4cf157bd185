"""Users, their login sessions and API tokens.

Sessions, tokens and tickets are 256 random bits, of which only the SHA-256 is stored: a reader of
the database cannot log in with it.

Of two stations each has sessions of its own, and one table of users.  To end a user's sessions, a
new *generation* of them is begun in that table: it ends those at the other station too, which
copies it.  A new user with the name of a removed one does not get that one's generation.  Removals
are noted for good (``tombstones``), and of a role and a password the later one holds: so changes at
one station while the other was off apply to both when they have contact again.
"""

from __future__ import annotations

import secrets
from collections.abc import Collection, Sequence

from pwdlib import PasswordHash
from sqlalchemy import ColumnElement, and_, delete, func, select
from sqlalchemy.orm import Session

from base_station.accounts.passwords import Passwords
from base_station.accounts.principal_cache import PrincipalCache
from base_station.accounts.principals import Principal, Role, require_username
from base_station.storage.db.database import Database
from base_station.storage.db.models import (
    ApiToken,
    LoginSession,
    LoginTransferTicket,
    Tombstone,
    User,
)
from base_station.storage.db.tombstones import end
from base_station.storage.db.unit_tokens import TOKEN_PREFIX, UnitTokens, sha256
from shared.clock import NS_PER_S, Clock
from shared.coded_text import coded
from shared.errors import UserError

SESSION_S = 12 * 3600
LOGIN_TICKET_S = 600  # from being made until the other station leads and the browser has gone there
GENERATED_NS = -1  # as the time of a password that the program made: any other one is later
MOST_TOKENS = 100  # of one user: the other station copies all of them


class Accounts:
    """Thread-safe; every method is one transaction."""

    def __init__(self, store: Database, clock: Clock, hasher: PasswordHash | None = None) -> None:
        self._store = store
        self._clock = clock
        self._passwords = Passwords(hasher)
        self._let_in = PrincipalCache()
        self.unit_tokens = UnitTokens(store, clock, self._let_in.forget_all)

    # ---- users

    def add_user(
        self, username: str, password: str, role: Role, *, generated: bool = False
    ) -> None:
        """``generated``: by the program; the user must change it at first."""
        require_username(username)
        password_hash = self._passwords.hash(password)
        with self._store.write() as session:
            if session.get(User, username) is not None:
                raise UserError(
                    coded("user-there", "there is a user {username!r} already", username=username)
                )
            session.add(
                User(
                    username=username,
                    password_hash=password_hash,
                    role=role.word,
                    created_ns=self._clock.utc_ns(),
                    generation=secrets.randbelow(1 << 53),
                    password_ns=GENERATED_NS if generated else 0,
                )
            )

    def change_user(self, username: str, password: str | None, role: Role | None) -> None:
        """Another role ends the user's sessions, a new password the tokens, too."""
        self._let_in.forget_all()
        password_hash = "" if password is None else self._passwords.hash(password)
        with self._store.write() as session:
            user = _required_user(session, username)
            if role is not None and role is not Role.ADMINISTRATOR:
                _keep_an_administrator(session, user)
            changed = password is not None or (role is not None and role.word != user.role)
            if changed:
                _end_sessions(session, user)
            now_ns = self._clock.utc_ns()  # which may have been set back
            if role is not None and role.word != user.role:
                user.role, user.role_ns = role.word, max(now_ns, user.role_ns + 1)
            if password is not None:
                user.password_hash = password_hash
                user.password_ns = max(now_ns, user.password_ns + 1)
                of_user = select(ApiToken).filter_by(username=username, unit_id="")
                for token in session.scalars(of_user).all():
                    end(session, token)

    def remove_user(self, username: str) -> None:
        self._let_in.forget_all()
        with self._store.write() as session:
            user = _required_user(session, username)
            _keep_an_administrator(session, user)
            end(session, user)

    def users(self) -> Sequence[User]:
        with self._store.read() as session:
            return session.scalars(select(User).order_by(User.username)).all()

    # ---- sessions

    def open_sessions(self) -> dict[str, int]:
        """Number of open sessions, by user; users without any are left out."""
        with self._store.read() as session:
            rows = session.execute(
                select(LoginSession.username, func.count())
                .join(User, self._is_open())
                .group_by(LoginSession.username)
            )
            return {row[0]: row[1] for row in rows}

    def end_sessions(self, username: str) -> None:
        """End all sessions of a user, who has to log in again."""
        self._let_in.forget_all()
        with self._store.write() as session:
            _end_sessions(session, _required_user(session, username))

    def verify_password(self, username: str, password: str) -> bool:
        """Check a password; takes the same time for an unknown name."""
        with self._store.read() as session:
            user = session.get(User, username)
        return self._passwords.is_valid(password, None if user is None else user.password_hash)

    def log_in(self, username: str, password: str) -> str | None:
        """Begin a session and return its secret; None where name or password is wrong."""
        with self._store.read() as session:
            user = session.get(User, username)
        stored = None if user is None else user.password_hash
        if not self._passwords.is_valid(password, stored) or user is None:
            return None
        now_ns = self._clock.utc_ns()
        with self._store.write() as session:
            session.execute(delete(LoginSession).where(LoginSession.expires_ns <= now_ns))
            session.execute(delete(Tombstone).where(Tombstone.until_ns <= now_ns))
            # Of the generation whose password was right: it may have been changed since.
            expires_ns = now_ns + SESSION_S * NS_PER_S
            return self._begin_session(session, username, user.generation, expires_ns)

    def begin_session(self, username: str) -> str:
        """Begin a session after a change of the password, which ended the one before, and return
        its secret.
        """
        with self._store.write() as session:
            expires_ns = self._clock.utc_ns() + SESSION_S * NS_PER_S
            generation = _required_user(session, username).generation
            return self._begin_session(session, username, generation, expires_ns)

    def _begin_session(
        self, session: Session, username: str, generation: int, expires_ns: int
    ) -> str:
        secret = secrets.token_urlsafe(32)
        session.add(
            LoginSession(
                token_hash=sha256(secret),
                username=username,
                created_ns=self._clock.utc_ns(),
                expires_ns=expires_ns,
                generation=generation,
            )
        )
        return secret

    def log_out(self, secret: str) -> None:
        self._let_in.forget_all()
        with self._store.write() as session:
            found = session.get(LoginSession, sha256(secret))
            if found is not None:
                end(session, found)

    def of_session(self, secret: str) -> Principal | None:
        return self._let_in.resolve(secret, self._of_session)

    def _of_session(self, secret: str) -> Principal | None:
        with self._store.read() as session:
            found = session.execute(
                select(User.username, User.role, User.password_ns)
                .join(LoginSession, self._is_open())
                .where(LoginSession.token_hash == sha256(secret))
            ).one_or_none()
        if found is None:
            return None
        generated = found.password_ns == GENERATED_NS
        return Principal(found.username, Role.of(found.role), must_change_password=generated)

    def _is_open(self) -> ColumnElement[bool]:
        """True if a session is a user's, and not over."""
        return and_(
            LoginSession.username == User.username,
            LoginSession.generation == User.generation,
            LoginSession.expires_ns > self._clock.utc_ns(),
        )

    # ---- login at the other station, by ticket

    def create_login_ticket(self, secret: str) -> str | None:
        """Return a ticket that logs its holder in at the other station as the user of this session,
        within ``LOGIN_TICKET_S``; None where there is no such session.
        """
        if self.of_session(secret) is None:
            return None
        ticket, now_ns = secrets.token_urlsafe(32), self._clock.utc_ns()
        with self._store.write() as session:
            session.execute(
                delete(LoginTransferTicket).where(LoginTransferTicket.expires_ns <= now_ns)
            )
            session.add(
                LoginTransferTicket(
                    ticket_hash=sha256(ticket),
                    session_hash=sha256(secret),
                    expires_ns=now_ns + LOGIN_TICKET_S * NS_PER_S,
                )
            )
        return ticket

    def redeem_login_ticket(self, ticket: str) -> str | None:
        """Begin a session that ends when the one before it would have, and return its secret; None
        where the ticket is not valid (any more).
        """
        with self._store.write() as session:
            found = session.execute(
                select(LoginTransferTicket, LoginSession)
                .join(LoginSession, LoginSession.token_hash == LoginTransferTicket.session_hash)
                .join(User, self._is_open())
                .where(
                    LoginTransferTicket.ticket_hash == sha256(ticket),
                    LoginTransferTicket.expires_ns > self._clock.utc_ns(),
                )
            ).one_or_none()
            if found is None:
                return None
            shown, before = found
            end(session, shown)
            return self._begin_session(
                session, before.username, before.generation, before.expires_ns
            )

    # ---- API tokens

    def add_token(
        self,
        username: str,
        name: str,
        role: Role,
        expires_ns: int | None,
        scopes: Collection[str] = (),
    ) -> tuple[str, str]:
        """Return ``(token_id, secret)`` of a new token; the secret cannot be read again.  Ended
        tokens are deleted.
        """
        secret, token_id = TOKEN_PREFIX + secrets.token_urlsafe(32), secrets.token_hex(8)
        with self._store.write() as session:
            mine = _is_own(username)
            session.execute(
                delete(ApiToken).where(mine, ApiToken.expires_ns <= self._clock.utc_ns())
            )
            if (session.scalar(select(func.count()).where(mine)) or 0) >= MOST_TOKENS:
                raise UserError(
                    coded(
                        "tokens-too-many",
                        "{user} has {most} tokens; remove one that is not used",
                        user=username,
                        most=MOST_TOKENS,
                    )
                )
            if role > Role.of(_required_user(session, username).role):
                raise UserError(
                    coded(
                        "token-role-too-high",
                        "a token can have its owner's role or a lower one, not a higher",
                    )
                )
            session.add(
                ApiToken(
                    token_id=token_id,
                    token_hash=sha256(secret),
                    username=username,
                    name=name,
                    role=role.word,
                    scopes=" ".join(sorted(scopes)),
                    created_ns=self._clock.utc_ns(),
                    expires_ns=expires_ns,
                )
            )
        return token_id, secret

    def remove_token(self, username: str, token_id: str) -> bool:
        self._let_in.forget_all()
        with self._store.write() as session:
            token = session.get(ApiToken, token_id)
            if token is None or token.username != username or token.unit_id:
                return False
            end(session, token)
            return True

    def tokens(self, username: str) -> Sequence[ApiToken]:
        with self._store.read() as session:
            mine = select(ApiToken).where(_is_own(username))
            return session.scalars(mine.order_by(ApiToken.created_ns)).all()

    def of_token(self, secret: str) -> Principal | None:
        return self._let_in.resolve(secret, self._of_token)

    def _of_token(self, secret: str) -> Principal | None:
        with self._store.read() as session:
            found = session.execute(
                select(ApiToken, User.role)
                .join(User, User.username == ApiToken.username)
                .where(ApiToken.token_hash == sha256(secret))
            ).one_or_none()
        if found is None:
            return None
        token, owner_role = found
        if token.expires_ns is not None and token.expires_ns <= self._clock.utc_ns():
            return None
        # Tokens of a demoted owner are demoted too.
        role = min(Role.of(token.role), Role.of(owner_role))
        scopes = frozenset(token.scopes.split())
        return Principal(token.username, role, scopes, token.expires_ns, token.unit_id)


def _is_own(username: str) -> ColumnElement[bool]:
    """True for a token of the user's own, not for a unit's that the user made."""
    return and_(ApiToken.username == username, ApiToken.unit_id == "")


def _required_user(session: Session, username: str) -> User:
    user = session.get(User, username)
    if user is None:
        raise UserError(coded("user-unknown", "there is no user {username!r}", username=username))
    return user


def _end_sessions(session: Session, user: User) -> None:
    """End a user's sessions here, and at the other station when it has copied the user."""
    user.generation += 1
    session.execute(delete(LoginSession).where(LoginSession.username == user.username))


def _keep_an_administrator(session: Session, user: User) -> None:
    administrators = session.scalar(
        select(func.count()).where(User.role == Role.ADMINISTRATOR.word)
    )
    if user.role == Role.ADMINISTRATOR.word and administrators == 1:
        raise UserError(
            coded(
                "last-administrator",
                "{user!r} is the only administrator; make another one first",
                user=user.username,
            )
        )
