"""API tokens for programs: each has its owner's role or a lower one."""

from __future__ import annotations

from typing import Annotated

from fastapi import APIRouter
from pydantic import BaseModel, Field

from base_station.accounts.principals import Role
from base_station.api.authentication import Scope, Viewer
from base_station.api.forms import Form, Id, Name
from base_station.api.problems import Problem
from base_station.api.routes.users import RoleWord
from base_station.api.services import Station
from base_station.views.answer import to_ms, to_ms_or_none
from shared.clock import NS_PER_DAY
from shared.coded_text import coded

router = APIRouter(tags=["tokens"])


class Token(BaseModel):
    token_id: str
    name: str
    role: str
    scopes: list[str]  # parts of the API; empty: all that the role may
    created_ms: int
    expires_ms: int | None


class NewToken(Form):
    name: Name
    role: RoleWord
    scopes: Annotated[tuple[Scope, ...], Field(max_length=len(Scope))] = ()  # empty: all
    days: Annotated[int, Field(ge=1, le=3660)] | None = None


class TokenSecret(BaseModel):
    token_id: str
    token: str  # shown this once


@router.get("/tokens")
def list_tokens(station: Station, who: Viewer) -> list[Token]:
    return [
        Token(
            token_id=token.token_id,
            name=token.name,
            role=token.role,
            scopes=token.scopes.split(),
            created_ms=to_ms(token.created_ns),
            expires_ms=to_ms_or_none(token.expires_ns),
        )
        for token in station.accounts.tokens(who.username)
    ]


@router.post("/tokens", status_code=201)
def add_token(new: NewToken, station: Station, who: Viewer) -> TokenSecret:
    expires_ns = None if new.days is None else station.clock.utc_ns() + new.days * NS_PER_DAY
    role = Role.of(new.role)
    if role > who.role:  # a token makes no token that may do more than itself
        raise Problem(
            403,
            coded(
                "token-above-own-role",
                "You are {role}; a token of yours cannot be {wanted}.",
                role=who.role.word,
                wanted=new.role,
            ),
        )
    scopes = frozenset(new.scopes)
    if who.scopes and (not scopes or not scopes <= who.scopes):
        raise Problem(
            403,
            coded("token-beyond-own-scope", "A token makes only tokens for what it is for itself."),
        )
    ends_ns = who.token_ends_ns
    if ends_ns is not None and (expires_ns is None or expires_ns > ends_ns):
        raise Problem(
            403,
            coded("token-outlasts", "A token makes no token that outlasts it; give fewer days."),
        )
    token_id, secret = station.accounts.add_token(who.username, new.name, role, expires_ns, scopes)
    what = ", ".join(sorted(scopes)) or "everything"
    station.records.audit(who.username, "AddedToken", f"{new.name} as {new.role} for {what}")
    return TokenSecret(token_id=token_id, token=secret)


@router.delete("/tokens/{token_id}", status_code=204)
def remove_token(token_id: Id, station: Station, who: Viewer) -> None:
    if not station.accounts.remove_token(who.username, token_id):
        raise Problem(404, coded("token-not-yours", "You have no such token."))
    station.records.audit(who.username, "RemovedToken", token_id)
