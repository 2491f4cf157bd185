"""Logging in and out, and who one is."""

from __future__ import annotations

from typing import Annotated

from fastapi import APIRouter, Request, Response
from pydantic import BaseModel, StringConstraints

from base_station.api.forms import Form, Name
from base_station.api.problems import Problem
from base_station.api.security import COOKIE, Throttle, Viewer
from base_station.api.services import Station
from base_station.db.accounts import SESSION_S, Principal

router = APIRouter(tags=["login"])


class Credentials(Form):
    username: Name
    password: Annotated[str, StringConstraints(max_length=256)]


class Me(BaseModel):
    username: str
    role: str


def _me(principal: Principal) -> Me:
    return Me(username=principal.username, role=principal.role.word)


@router.post("/login")
def log_in(
    credentials: Credentials,
    request: Request,
    response: Response,
    station: Station,
    throttle: Throttle,
) -> Me:
    address = request.client.host if request.client else ""
    throttle.check(address, credentials.username)
    secret = station.accounts.log_in(credentials.username, credentials.password)
    principal = None if secret is None else station.accounts.of_session(secret)
    if secret is None or principal is None:
        station.records.audit(credentials.username, "LoginRefused", address)
        raise Problem(401, "Name or password is wrong.")
    station.records.audit(principal.username, "LoggedIn", address)
    response.set_cookie(
        COOKIE, secret, max_age=SESSION_S, httponly=True, secure=station.secure, samesite="strict"
    )
    return _me(principal)


@router.post("/logout", status_code=204)
def log_out(request: Request, response: Response, station: Station) -> None:
    secret = request.cookies.get(COOKIE)
    if secret is not None:
        station.accounts.log_out(secret)
    response.delete_cookie(COOKIE, httponly=True, secure=station.secure, samesite="strict")


@router.get("/me")
def me(principal: Viewer) -> Me:
    return _me(principal)
