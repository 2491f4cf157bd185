"""How a request has the station do something, once however often it is sent."""

from __future__ import annotations

import uuid
from typing import Annotated

from fastapi import Depends, Header, Request

from base_station.api.forms import IdempotencyKeyText
from base_station.api.security import Commander
from base_station.api.services import Services, Station, key_used_before
from base_station.live.sinks import ActionDone
from base_station.once import once_id, row_id
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


class Acting:
    """One request of one person, for one action or one row of a table."""

    def __init__(self, station: Services, by: str, key: str, asked: bytes) -> None:
        self.by = by
        self._station = station
        self._key = key  # empty: the client gave none
        self._asked = asked

    def __call__(self, action: Action) -> ActionDone:
        """What became of it, now or when it was asked for before (``Services.act``)."""
        if not self._key:
            return self._station.act(self.by, action)
        action_id = once_id(self.by, self._key, self._asked, uuid.uuid4().hex)
        return self._station.act(self.by, action, action_id)

    @property
    def row_id(self) -> str:
        """For the one row that the request adds to a table; empty: any will do."""
        return row_id(self.by, self._key, self._asked) if self._key else ""

    def require_row(self, found_id: str) -> None:
        """``found_id``: of the row that was added with this key, now or before."""
        if self._key and found_id != self.row_id:
            raise key_used_before()


async def _acting(
    request: Request, station: Station, who: Commander, idempotency_key: _Key = None
) -> Acting:
    if idempotency_key is None:
        return Acting(station, who.username, "", b"")
    url = request.url
    asked = f"{request.method} {url.path}?{url.query}\n".encode() + await request.body()
    return Acting(station, who.username, idempotency_key.strip('"'), asked)


Act = Annotated[Acting, Depends(_acting)]
