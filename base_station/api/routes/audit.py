"""Who did what."""

from __future__ import annotations

from typing import Annotated

from fastapi import APIRouter, Query
from pydantic import BaseModel

from base_station.answer import to_ms
from base_station.api.forms import LAST_MS, UntilMs
from base_station.api.security import Administrator
from base_station.api.services import Station
from shared.clock import NS_PER_MS

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
    until_ms: UntilMs = LAST_MS,
    limit: Annotated[int, Query(ge=1, le=1000)] = 100,
) -> list[AuditEntry]:
    """Newest first."""
    return [
        AuditEntry(
            entry_id=entry.entry_id,
            t_ms=to_ms(entry.t_ns),
            by=entry.by,
            action=entry.action,
            detail=entry.detail,
        )
        for entry in station.records.audit_entries(until_ms * NS_PER_MS, limit)
    ]
