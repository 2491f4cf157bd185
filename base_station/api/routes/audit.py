"""Who did what."""

from __future__ import annotations

from typing import Annotated

from fastapi import APIRouter, Depends
from pydantic import BaseModel

from base_station.api.forms import Limit, window
from base_station.api.security import Administrator
from base_station.api.services import Station
from base_station.db.records import Window
from base_station.views.answer import to_ms

router = APIRouter(tags=["audit"])


class AuditEntry(BaseModel):
    entry_id: str
    t_ms: int
    by: str
    action: str
    detail: str


@router.get("/audit")
def list_audit(
    station: Station,
    _: Administrator,
    when: Annotated[Window, Depends(window)],
    limit: Limit = 100,
) -> list[AuditEntry]:
    """What was done in the window, newest first."""
    return [
        AuditEntry(
            entry_id=entry.entry_id,
            t_ms=to_ms(entry.t_ns),
            by=entry.by,
            action=entry.action,
            detail=entry.detail,
        )
        for entry in station.records.audit_entries(when, limit)
    ]
