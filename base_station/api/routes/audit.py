"""Audit of operator actions."""

from __future__ import annotations

from typing import Annotated

from fastapi import APIRouter, Depends
from pydantic import BaseModel

from base_station.api.authentication import Administrator, Viewer
from base_station.api.current_tables import CurrentStation
from base_station.api.forms import IdempotencyKey, Limit, window
from base_station.api.problems import Problem
from base_station.core.idempotency import audit_entry_prefixes
from base_station.storage.db.window import Window
from base_station.views.answer import to_ms
from shared.coded_text import coded

router = APIRouter(tags=["audit"])


class AuditEntryAnswer(BaseModel):
    entry_id: str
    t_ms: int
    by: str
    action: str
    detail: str


class CarriedOut(BaseModel):
    """Action that a request with an Idempotency-Key has carried out."""

    action: str
    t_ms: int


@router.get("/idempotency-keys/{key}")
def get_carried_out(key: IdempotencyKey, station: CurrentStation, who: Viewer) -> CarriedOut:
    """Outcome of a request to which a client got no answer: the action that this user's request
    with this key has carried out.  404 if it was not carried out so far, or was refused.
    """
    entry = station.records.audited(audit_entry_prefixes(who.username, key.strip('"')))
    if entry is None:
        raise Problem(
            404,
            coded("nothing-carried-out", "Nothing was carried out with this Idempotency-Key."),
        )
    return CarriedOut(action=entry.action, t_ms=to_ms(entry.t_ns))


@router.get("/audit")
def list_audit(
    station: CurrentStation,
    _: Administrator,
    when: Annotated[Window, Depends(window)],
    limit: Limit = 100,
) -> list[AuditEntryAnswer]:
    """Actions in the window, newest first."""
    return [
        AuditEntryAnswer(
            entry_id=entry.entry_id,
            t_ms=to_ms(entry.t_ns),
            by=entry.by,
            action=entry.action,
            detail=station.roster.shown(entry.detail),
        )
        for entry in station.records.audit_entries(when, limit)
    ]
