"""Requests that are carried out once, however often they are received."""

from __future__ import annotations

import uuid
from typing import Annotated

from fastapi import Depends, Header, Request

from base_station.api.authentication import Commander
from base_station.api.forms import IdempotencyKeyText
from base_station.api.services import Services, Station, idempotency_key_reused
from base_station.core.idempotency import idempotent_action_id, row_id
from base_station.engine.ports import ActionResult
from shared.messages.station import Action

_Key = Annotated[
    IdempotencyKeyText | None,
    Header(
        alias="Idempotency-Key",
        description="Of the client's choice, another one for every request. Who has had no answer "
        "sends the same again with the same key: it is done once, and answered as at first. "
        "With another request the key is refused (422). The last 1000 keys hold, also after a "
        "restart and at the station that takes over.",
    ),
]


class IdempotentRequest:
    """Request of one principal for one action, or for one row of a table."""

    def __init__(self, station: Services, by: str, key: str, content: bytes) -> None:
        self.by = by
        self._station = station
        self._key = key  # empty: the client gave none
        self._content = content

    def __call__(self, action: Action) -> ActionResult:
        """Carry out the action, or return the result of the first time (``Services.perform``)."""
        if not self._key:
            return self._station.perform(self.by, action)
        action_id = idempotent_action_id(self.by, self._key, self._content, uuid.uuid4().hex)
        return self._station.perform(self.by, action, action_id)

    @property
    def row_id(self) -> str:
        """Id of the row that the request adds to a table; empty if any id will do."""
        return row_id(self.by, self._key, self._content) if self._key else ""

    def require_row(self, found_id: str) -> None:
        """Check that the row is that of this request.  ``found_id``: id of the row that was added
        with this key, now or before.
        """
        if self._key and found_id != self.row_id:
            raise idempotency_key_reused()


async def _idempotent_request(
    request: Request, station: Station, who: Commander, idempotency_key: _Key = None
) -> IdempotentRequest:
    if idempotency_key is None:
        return IdempotentRequest(station, who.username, "", b"")
    url = request.url
    content = f"{request.method} {url.path}?{url.query}\n".encode() + await request.body()
    return IdempotentRequest(station, who.username, idempotency_key.strip('"'), content)


Perform = Annotated[IdempotentRequest, Depends(_idempotent_request)]
