"""Who is asking, and whether they may.

A browser has a session cookie; a program has an API token (``Authorization: Bearer``).  A page
of another origin can do nothing with the cookie: it is ``SameSite=Strict``, and what changes
something must come with the station's own ``Origin``.
"""

from __future__ import annotations

import ipaddress
from collections.abc import Callable, Collection, Coroutine
from enum import StrEnum
from typing import Annotated, Any
from urllib.parse import urlsplit

from fastapi import Depends, Request, Response
from fastapi.routing import APIRoute
from fastapi.security import APIKeyCookie, HTTPBearer
from limits import parse
from limits.storage import MemoryStorage
from limits.strategies import MovingWindowRateLimiter
from starlette.concurrency import run_in_threadpool
from starlette.requests import HTTPConnection

from base_station.api.problems import Problem
from base_station.api.services import Services, Station, services_of
from base_station.db.principals import Principal, Role

COOKIE = "muster_session"
_SAFE_METHODS = frozenset({"GET", "HEAD", "OPTIONS"})
# What a standby lets people do all the same: log in, look, and make it lead.
_AT_A_STANDBY = ("login", "logout", "replays", "standby")
_LOGINS_OF_ONE = parse("10/minute")  # one name from one address
_LOGINS_OF_ALL = parse("60/minute")  # any name from one address

# They declare the schemes in the OpenAPI document; ``principal_of`` reads the headers itself.
_cookie_scheme = APIKeyCookie(name=COOKIE, auto_error=False)
_token_scheme = HTTPBearer(auto_error=False)


def principal_of(connection: HTTPConnection, services: Services) -> Principal | None:
    """Whoever the cookie or the token stands for."""
    kind, _, secret = connection.headers.get("authorization", "").partition(" ")
    if kind.lower() == "bearer":
        return services.accounts.of_token(secret.strip())
    cookie = connection.cookies.get(COOKIE)
    return None if cookie is None else services.accounts.of_session(cookie)


def is_own_origin(connection: HTTPConnection) -> bool:
    """Whether the page that asks was served by this station; True where none is named.

    Over TLS a page that was not is another one, whatever its host.
    """
    origin = connection.headers.get("origin")
    if origin is None:
        return True
    host, asking = connection.headers.get("host", ""), urlsplit(origin)
    schemes = {"https"} if services_of(connection).secure else {"http", "https"}  # behind a proxy
    return asking.scheme in schemes and asking.netloc == host and host != ""


def check_origin(connection: HTTPConnection) -> None:
    """Dependency of every route: nothing is changed at the wish of another site.

    WebSockets check theirs in the handshake.
    """
    if connection.scope.get("method", "GET") in _SAFE_METHODS:
        return
    if not is_own_origin(connection):
        raise Problem(403, "This was asked by a page that is not the station's own.")
    by_cookie = COOKIE in connection.cookies and "authorization" not in connection.headers
    if by_cookie and "origin" not in connection.headers:
        raise Problem(403, "A browser's request must name its origin; programs use an API token.")


def check_standing(connection: HTTPConnection) -> None:
    """Dependency of every route: of two stations, things are changed at the one that leads."""
    standing = services_of(connection).standing
    if standing is None or connection.scope.get("method", "GET") in _SAFE_METHODS:
        return
    resource = connection.scope["path"].removeprefix("/api/v1/").partition("/")[0]
    refusal = None if resource in _AT_A_STANDBY else standing.refusal()
    if refusal is not None:
        raise Problem(503, f"Nothing was changed: {refusal}.")


def _signed_in(
    request: Request,
    services: Station,
    _cookie: Annotated[object, Depends(_cookie_scheme)],
    _token: Annotated[object, Depends(_token_scheme)],
) -> Principal:
    principal = principal_of(request, services)
    if principal is None:
        raise _nobody()
    tags = request.scope["route"].tags
    if not covers(principal, tags):
        allowed = ", ".join(sorted(principal.scopes))
        raise Problem(403, f"This token is for {allowed}, not for {', '.join(tags)}.")
    return principal


def _nobody() -> Problem:
    return Problem(401, "Log in first.", {"WWW-Authenticate": "Bearer"})


Viewer = Annotated[Principal, Depends(_signed_in)]


def _commander(principal: Viewer) -> Principal:
    return _at_least(principal, Role.COMMANDER)


def _administrator(principal: Viewer) -> Principal:
    return _at_least(principal, Role.ADMINISTRATOR)


Commander = Annotated[Principal, Depends(_commander)]
Administrator = Annotated[Principal, Depends(_administrator)]


def _at_least(principal: Principal, role: Role) -> Principal:
    if principal.role < role:
        raise Problem(
            403, f"This needs the role {role.word}; {principal.username} is {principal.role.word}."
        )
    return principal


class AfterLogin(APIRoute):
    """A route with a large body, which is not read from just anybody."""

    def get_route_handler(self) -> Callable[[Request], Coroutine[Any, Any, Response]]:
        handle = super().get_route_handler()

        async def checked(request: Request) -> Response:
            if await run_in_threadpool(principal_of, request, services_of(request)) is None:
                raise _nobody()
            return await handle(request)

        return checked


class Scope(StrEnum):
    """What a token can be for: the tags of the routers."""

    ACCOUNTABILITY = "accountability"
    ALARMS = "alarms"
    ASSIGNMENTS = "assignments"
    AUDIT = "audit"
    COMMANDS = "commands"
    EXPORTS = "exports"
    FORGETTING = "forgetting"
    HEALTH = "health"
    INCIDENTS = "incidents"
    LIVE = "live"
    PEOPLE = "people"
    PINS = "pins"
    RECORDINGS = "recordings"
    REPLAYS = "replays"
    SITE = "site"
    STANDBY = "standby"
    TOKENS = "tokens"
    TRACKS = "tracks"
    UNITS = "units"
    USERS = "users"


def covers(principal: Principal, tags: Collection[str]) -> bool:
    """Whether a token is for this part of the API; who one is may always be asked."""
    return not principal.scopes or "login" in tags or not principal.scopes.isdisjoint(tags)


class LoginThrottle:
    """How often passwords may be tried."""

    def __init__(self) -> None:
        self._limiter = MovingWindowRateLimiter(MemoryStorage())

    def check(self, address: str, username: str) -> None:
        """Count a try; Problem 429 where there were too many."""
        place = _place_of(address)
        allowed = self._limiter.hit(_LOGINS_OF_ALL, place) and self._limiter.hit(
            _LOGINS_OF_ONE, place, username
        )
        if not allowed:
            raise Problem(429, "Too many tries to log in; wait a minute.", {"Retry-After": "60"})


def _place_of(address: str) -> str:
    """One machine has as many addresses of an IPv6 network as it likes; they count as one."""
    try:
        parsed = ipaddress.ip_address(address.partition("%")[0])
    except ValueError:
        return address
    if parsed.version == 6 and parsed.ipv4_mapped is None:
        return str(ipaddress.ip_network((parsed, 64), strict=False))
    return str(getattr(parsed, "ipv4_mapped", None) or parsed)


def throttle_of(request: Request) -> LoginThrottle:
    throttle: LoginThrottle = request.app.state.login_throttle
    return throttle


Throttle = Annotated[LoginThrottle, Depends(throttle_of)]
