"""Login, logout, the present user, and login by a ticket of the other station."""

from __future__ import annotations

from typing import Annotated

from fastapi import APIRouter, Request, Response
from pydantic import BaseModel, StringConstraints

from base_station.accounts.passwords import MAX_PASSWORD
from base_station.accounts.principals import Principal
from base_station.api.admission import Queue
from base_station.api.authentication import COOKIE, Viewer, must_change_password
from base_station.api.forms import Form, Name
from base_station.api.login_throttle import Throttle
from base_station.api.problems import Problem
from base_station.api.services import Logins, LoginServices
from base_station.storage.db.accounts import LOGIN_TICKET_S, SESSION_S
from shared.coded_text import coded

router = APIRouter(tags=["login"])


class Credentials(Form):
    username: Name
    password: Annotated[str, StringConstraints(max_length=MAX_PASSWORD)]


class Me(BaseModel):
    username: str
    role: str
    must_change_password: bool


def _me(principal: Principal, station: LoginServices) -> Me:
    return Me(
        username=principal.username,
        role=principal.role.word,
        must_change_password=must_change_password(principal, station),
    )


class Ticket(BaseModel):
    """Ticket that logs its holder in at the other station's console, as the user who requested
    it.
    """

    ticket: str
    lasts_s: int


class ShownTicket(Form):
    ticket: Annotated[str, StringConstraints(max_length=256)]


@router.post("/login")
async def log_in(
    credentials: Credentials,
    request: Request,
    response: Response,
    station: Logins,
    throttle: Throttle,
    queue: Queue,
) -> Me:
    address = request.client.host if request.client else ""
    is_known = throttle.check(address, credentials.username)
    me = await queue.run(
        lambda: _log_in(credentials, address, request, response, station), is_known=is_known
    )
    throttle.record_login(address, me.username)
    return me


def _log_in(
    credentials: Credentials,
    address: str,
    request: Request,
    response: Response,
    station: LoginServices,
) -> Me:
    secret = station.accounts.log_in(credentials.username, credentials.password)
    principal = None if secret is None else station.accounts.of_session(secret)
    if secret is None or principal is None:
        station.records.audit(credentials.username, "LoginRefused", address)
        raise Problem(401, coded("login-wrong", "Name or password is wrong."))
    station.records.audit(principal.username, "LoggedIn", address)
    set_session_cookie(request, response, station, secret)
    return _me(principal, station)


@router.post("/login/hand-over")
def log_in_with_ticket(
    shown: ShownTicket, request: Request, response: Response, station: Logins, throttle: Throttle
) -> Me:
    """Log in with a ticket of the other station; each is valid once."""
    address = request.client.host if request.client else ""
    throttle.check_network(address)
    secret = station.accounts.redeem_login_ticket(shown.ticket)
    principal = None if secret is None else station.accounts.of_session(secret)
    if secret is None or principal is None:
        throttle.record_refusal(address)
        raise Problem(401, coded("ticket-void", "This ticket is of no use (any more); log in."))
    station.records.audit(principal.username, "WentOn", address)
    set_session_cookie(request, response, station, secret)
    return _me(principal, station)


def set_session_cookie(
    request: Request, response: Response, station: LoginServices, secret: str
) -> None:
    """Set the cookie of a new session and end the browser's former one."""
    before = request.cookies.get(COOKIE)
    if before is not None:
        station.accounts.log_out(before)
    response.set_cookie(
        COOKIE, secret, max_age=SESSION_S, httponly=True, secure=station.secure, samesite="strict"
    )


@router.post("/logout", status_code=204)
def log_out(request: Request, response: Response, station: Logins) -> None:
    secret = request.cookies.get(COOKIE)
    principal = None if secret is None else station.accounts.of_session(secret)
    if secret is not None and principal is not None:
        station.accounts.log_out(secret)
        station.records.audit(principal.username, "LoggedOut", "")
    response.delete_cookie(COOKIE, httponly=True, secure=station.secure, samesite="strict")


@router.post("/hand-over")
def create_login_ticket(request: Request, station: Logins, _: Viewer) -> Ticket:
    """Issue a ticket for the other station's console.  Consoles ask for one regularly, so that
    their users need not log in again when this station fails.
    """
    ticket = station.accounts.create_login_ticket(request.cookies.get(COOKIE, ""))
    if ticket is None:
        raise Problem(
            403,
            coded(
                "ticket-for-browsers",
                "A ticket is for who has logged in with a browser; a token holds there.",
            ),
        )
    return Ticket(ticket=ticket, lasts_s=LOGIN_TICKET_S)


@router.get("/me")
def me(principal: Viewer, station: Logins) -> Me:
    return _me(principal, station)
