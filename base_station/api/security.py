"""Who is asking, and whether they may.

A browser has a session cookie; a program has an API token (``Authorization: Bearer``).  A page
of another origin can do nothing with the cookie: it is ``SameSite=Strict``, and what changes
something must come with the station's own ``Origin``.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Collection, Coroutine
from enum import StrEnum
from threading import Lock
from typing import Annotated, Any
from urllib.parse import urlsplit

from fastapi import Depends, Request, Response
from fastapi.routing import APIRoute
from fastapi.security import APIKeyCookie, HTTPBearer
from starlette.concurrency import run_in_threadpool
from starlette.requests import HTTPConnection

from base_station.accounts.principals import Principal, Role
from base_station.api.networks import network_of
from base_station.api.problems import Problem
from base_station.api.services import Services, Station, services_of
from base_station.api.tries import Tries

COOKIE = "muster_session"
_SAFE_METHODS = frozenset({"GET", "HEAD", "OPTIONS"})
# What a station that changes nothing lets people do all the same: log in, look, and make it lead.
_WITHOUT_CHANGES = ("login", "logout", "replays", "standby")
_LOGINS_OF_ONE = 10  # a minute: one name from one place
_LOGINS_OF_ALL = 60  # any name from one place
_MINUTE_S = 60.0

# They declare the schemes in the OpenAPI document; ``principal_of`` reads the headers itself.
_cookie_scheme = APIKeyCookie(name=COOKIE, auto_error=False)
_token_scheme = HTTPBearer(auto_error=False)


def principal_of(connection: HTTPConnection, services: Services) -> Principal | None:
    """Whoever the cookie or the token stands for."""
    token = _token_of(connection)
    if token is not None:
        return services.accounts.of_token(token)
    cookie = connection.cookies.get(COOKIE)
    return None if cookie is None else services.accounts.of_session(cookie)


def _token_of(connection: HTTPConnection) -> str | None:
    """Where one is shown, the cookie beside it counts for nothing."""
    kind, _, secret = connection.headers.get("authorization", "").partition(" ")
    return secret.strip() if kind.lower() == "bearer" else None


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
    by_cookie = COOKIE in connection.cookies and _token_of(connection) is None
    if by_cookie and "origin" not in connection.headers:
        raise Problem(403, "A browser's request must name its origin; programs use an API token.")


def check_standing(connection: HTTPConnection) -> None:
    """Dependency of every route: of two stations, things are changed at the one that leads, and at
    one that only replays nothing is.
    """
    services = services_of(connection)
    if connection.scope.get("method", "GET") in _SAFE_METHODS:
        return
    resource = connection.scope["path"].removeprefix("/api/v1/").partition("/")[0]
    if resource in _WITHOUT_CHANGES:
        return
    if services.only_replays:
        raise Problem(409, "This station only replays; nothing can be changed here.")
    refusal = None if services.standing is None else services.standing.refusal()
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
    """How often passwords may be tried.  Thread-safe.

    What is refused here is not counted: who tries one name again and again locks out nobody else
    of the same place, which may be all consoles behind one router.
    """

    def __init__(self, monotonic_s: Callable[[], float] = time.monotonic) -> None:
        self._lock = Lock()
        self._of_one = Tries(_LOGINS_OF_ONE, _MINUTE_S, monotonic_s)
        self._of_all = Tries(_LOGINS_OF_ALL, _MINUTE_S, monotonic_s)

    def check(self, address: str, username: str) -> None:
        """Count a try; Problem 429 where there were too many."""
        place = network_of(address)
        one = place, username
        with self._lock:
            if not (self._of_all.has_room(place) and self._of_one.has_room(one)):
                raise _too_many()
            self._of_all.note(place)
            self._of_one.note(one)

    def check_place(self, address: str) -> None:
        """Problem 429 where there were too many tries; counts none."""
        with self._lock:
            if not self._of_all.has_room(network_of(address)):
                raise _too_many()

    def note_refused(self, address: str) -> None:
        """Count a ticket that was of no use.  Good ones are not counted: nobody guesses one, and
        all consoles of a place go on at once.
        """
        with self._lock:
            self._of_all.note(network_of(address))


def _too_many() -> Problem:
    return Problem(429, "Too many tries to log in; wait a minute.", {"Retry-After": "60"})


def throttle_of(request: Request) -> LoginThrottle:
    throttle: LoginThrottle = request.app.state.login_throttle
    return throttle


Throttle = Annotated[LoginThrottle, Depends(throttle_of)]
