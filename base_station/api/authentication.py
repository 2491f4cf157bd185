"""Authentication and authorization of requests.

A browser has a session cookie; a program has an API token (``Authorization: Bearer``).  A page
of another origin can do nothing with the cookie: it is ``SameSite=Strict``, and what changes
something must come with the station's own ``Origin``.
"""

from __future__ import annotations

from collections.abc import Collection
from enum import StrEnum
from typing import Annotated
from urllib.parse import urlsplit

from fastapi import Depends, Request
from fastapi.security import APIKeyCookie, HTTPBearer
from starlette.requests import HTTPConnection

from base_station.accounts.principals import Principal, Role
from base_station.api.problems import Problem
from base_station.api.refusals import ONLY_REPLAYS
from base_station.api.services import Logins, LoginServices, login_services_of
from shared.coded_text import coded

COOKIE = "muster_session"
CHANGE_FIRST = coded(
    "password-generated",
    "Change your password first: this one was generated, and is written in a file.",
)
_SAFE_METHODS = frozenset({"GET", "HEAD", "OPTIONS"})
# Requests that a station which changes nothing allows all the same: log in, look, and make it lead.
_ALLOWED_READ_ONLY = ("login", "logout", "replays", "standby")

# They declare the schemes in the OpenAPI document; ``principal_of`` reads the headers itself.
_cookie_scheme = APIKeyCookie(name=COOKIE, auto_error=False)
_token_scheme = HTTPBearer(auto_error=False)


def principal_of(connection: HTTPConnection, services: LoginServices) -> Principal | None:
    """Return the principal of the cookie or the token of a request, and remember its network as
    known.
    """
    token = _token_of(connection)
    if token is not None:
        principal = services.accounts.of_token(token)
    else:
        cookie = connection.cookies.get(COOKIE)
        principal = None if cookie is None else services.accounts.of_session(cookie)
    if principal is not None and connection.client is not None:
        connection.app.state.known_networks.add(connection.client.host)
    return principal


def _token_of(connection: HTTPConnection) -> str | None:
    """Return the API token of a request; a cookie beside it is ignored."""
    kind, _, secret = connection.headers.get("authorization", "").partition(" ")
    return secret.strip() if kind.lower() == "bearer" else None


def is_own_origin(connection: HTTPConnection) -> bool:
    """True if the page that sends the request was served by this station, or if no origin is given.

    A page that was served without TLS is of another origin than a station with TLS, even with the
    same host.
    """
    origin = connection.headers.get("origin")
    if origin is None:
        return True
    host, page = connection.headers.get("host", ""), urlsplit(origin)
    schemes = (
        {"https"} if login_services_of(connection).secure else {"http", "https"}
    )  # behind a proxy
    return page.scheme in schemes and page.netloc == host and host != ""


def check_origin(connection: HTTPConnection) -> None:
    """Dependency of every route: a page of another origin cannot change anything.

    WebSockets check their origin in the handshake.
    """
    if connection.scope.get("method", "GET") in _SAFE_METHODS:
        return
    if not is_own_origin(connection):
        raise Problem(
            403, coded("foreign-page", "This was asked by a page that is not the station's own.")
        )
    is_by_cookie = COOKIE in connection.cookies and _token_of(connection) is None
    if is_by_cookie and "origin" not in connection.headers:
        raise Problem(
            403,
            coded(
                "origin-missing",
                "A browser's request must name its origin; programs use an API token.",
            ),
        )


def check_leads(connection: HTTPConnection) -> None:
    """Dependency of every route: of two stations only the leading one accepts changes, and a
    station that only replays accepts none.
    """
    services = login_services_of(connection)
    if connection.scope.get("method", "GET") in _SAFE_METHODS:
        return
    resource = connection.scope["path"].removeprefix("/api/v1/").partition("/")[0]
    if resource in _ALLOWED_READ_ONLY:
        return
    if services.is_replay_only:
        raise Problem(409, ONLY_REPLAYS)
    refusal = None if services.ha_status is None else services.ha_status.refusal()
    if refusal is not None:
        raise Problem(
            503, coded("not-in-charge", "Nothing was changed: {reason}.", reason=str(refusal))
        )


def _authenticated(
    request: Request,
    services: Logins,
    _cookie: Annotated[object, Depends(_cookie_scheme)],
    _token: Annotated[object, Depends(_token_scheme)],
) -> Principal:
    principal = principal_of(request, services)
    if principal is None:
        raise unauthenticated()
    tags = request.scope["route"].tags
    if not scope_covers(principal, tags):
        allowed = ", ".join(sorted(principal.scopes))
        raise Problem(
            403,
            coded(
                "token-scope",
                "This token is for {allowed}, not for {wanted}.",
                allowed=allowed,
                wanted=", ".join(tags),
            ),
        )
    is_password_change = "login" in tags or request.scope["route"].path == "/me/password"
    if must_change_password(principal, services) and not is_password_change:
        raise Problem(403, CHANGE_FIRST)
    return principal


def must_change_password(principal: Principal, services: LoginServices) -> bool:
    """True for a generated password.  False at a station that only replays, as it cannot store
    another.
    """
    return principal.must_change_password and not services.is_replay_only


def unauthenticated() -> Problem:
    return Problem(401, coded("login-first", "Log in first."), {"WWW-Authenticate": "Bearer"})


Viewer = Annotated[Principal, Depends(_authenticated)]


def _commander(principal: Viewer) -> Principal:
    return require_role(principal, Role.COMMANDER)


def _administrator(principal: Viewer) -> Principal:
    return require_role(principal, Role.ADMINISTRATOR)


Commander = Annotated[Principal, Depends(_commander)]
Administrator = Annotated[Principal, Depends(_administrator)]


def require_role(principal: Principal, role: Role) -> Principal:
    """Return the principal if it has this role or a higher one.  Problem 403."""
    if principal.role < role:
        raise Problem(
            403,
            coded(
                "role-too-low",
                "This needs the role {needed}; {user} is {role}.",
                needed=role.word,
                user=principal.username,
                role=principal.role.word,
            ),
        )
    return principal


class Scope(StrEnum):
    """Part of the API for which a token can be valid: the tag of a router."""

    ACCOUNTABILITY = "accountability"
    ALARMS = "alarms"
    ASSIGNMENTS = "assignments"
    AUDIT = "audit"
    COMMANDS = "commands"
    DISPATCH = "dispatch"
    ENROLMENTS = "enrolments"
    EXPORTS = "exports"
    FORGETTING = "forgetting"
    HEALTH = "health"
    INCIDENTS = "incidents"
    LIVE = "live"
    PEOPLE = "people"
    PINS = "pins"
    RADIO = "radio"
    RECORDINGS = "recordings"
    REPLAYS = "replays"
    SAMPLES = "samples"
    SITE = "site"
    STANDBY = "standby"
    TOKENS = "tokens"
    TRACKS = "tracks"
    UNITS = "units"
    USERS = "users"


def scope_covers(principal: Principal, tags: Collection[str]) -> bool:
    """True if the token is valid for this part of the API; any token may ask for its own user."""
    return not principal.scopes or "login" in tags or not principal.scopes.isdisjoint(tags)
