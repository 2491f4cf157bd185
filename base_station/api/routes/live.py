"""The WebSockets: the live picture, and that of one replay."""

from __future__ import annotations

import asyncio
import logging
from concurrent.futures import ThreadPoolExecutor
from typing import Literal

import msgspec
from fastapi import APIRouter, WebSocket, WebSocketDisconnect
from starlette.concurrency import run_in_threadpool

from base_station.api.authentication import (
    CHANGE_FIRST,
    Scope,
    is_own_origin,
    must_change_password,
    principal_of,
    scope_covers,
)
from base_station.api.hub import Hub
from base_station.api.hub_client import Client, PacedClient
from base_station.api.services import Services, services_of
from shared.coded_text import coded
from shared.errors import StoreError
from shared.log_on_change import LogOnChange

router = APIRouter(tags=[Scope.LIVE])

TRY_AGAIN = 1013
NOT_LOGGED_IN = 4401
NOT_FOUND = 4404
TOO_SLOW = 4408
NOT_UNDERSTOOD = 4400
SEND_TIMEOUT_S = 20.0  # one message takes longer: the console is gone
MOST_LAPSES = 30  # how often a console may fall behind
CHECK_LOGIN_S = 2.0  # half a millisecond each
CHECKED_WITHIN_S = 10.0  # else the disk hangs
# Consoles that only receive take no thread from requests.
_CHECKING = ThreadPoolExecutor(4, thread_name_prefix="check-login")

_log = logging.getLogger(__name__)


class WebSocketClosing(Exception):  # noqa: N818  # it is no error
    """Ends a WebSocket with a code and a reason."""

    def __init__(self, code: int, reason: str) -> None:
        super().__init__(reason)
        self.code = code
        self.reason = reason


Deltas = Literal["units", "fields"]  # of a changed unit: all fields, or the changed ones


class PictureRequest(msgspec.Struct, forbid_unknown_fields=True, tag="snapshot"):
    """Request of a console for a new snapshot."""


class ShownCount(msgspec.Struct, forbid_unknown_fields=True, tag="shown"):
    """Number of messages of this connection, of any type, that the console has shown."""

    count: int


@router.websocket("/live")
async def live(socket: WebSocket, deltas: Deltas = "units") -> None:
    await _serve(socket, services_of(socket).hub, deltas)


@router.websocket("/replays/{replay_id}/live")
async def replay_live(socket: WebSocket, replay_id: str, deltas: Deltas = "units") -> None:
    replay = await run_in_threadpool(services_of(socket).replays.get, replay_id)
    await _serve(socket, None if replay is None else replay.hub, deltas)


async def _serve(socket: WebSocket, hub: Hub | None, deltas: Deltas) -> None:
    if not is_own_origin(socket):
        await socket.close()  # before it was accepted: the browser gets a 403
        return
    services = services_of(socket)
    await socket.accept()
    try:
        await _check_login(socket, services)
        if hub is None:
            raise WebSocketClosing(NOT_FOUND, "there is no such replay; it may have ended")
        await _watch(socket, services, hub, deltas)
    except WebSocketClosing as closing:
        await _close(socket, closing)
    except StoreError as error:
        await _close(socket, WebSocketClosing(TRY_AGAIN, _as_reason(error)))
    except WebSocketDisconnect:
        pass


async def _watch(socket: WebSocket, services: Services, hub: Hub, deltas: Deltas) -> None:
    """Run the three tasks of a connection until one of them ends."""
    client = hub.join_paced() if deltas == "fields" else hub.join()
    tasks = {
        asyncio.create_task(_send(socket, client)),
        asyncio.create_task(_listen(socket, client)),
        asyncio.create_task(_keep_checking(socket, services)),
    }
    try:
        done, _ = await asyncio.wait(tasks, return_when=asyncio.FIRST_COMPLETED)
    finally:
        hub.leave(client)
        for task in tasks:
            task.cancel()
        await asyncio.gather(*tasks, return_exceptions=True)
    for task in done:
        task.result()


async def _send(socket: WebSocket, client: Client) -> None:
    while True:
        message = await client.next_message()
        if client.lapses > MOST_LAPSES:
            raise WebSocketClosing(TOO_SLOW, "this console is too slow for what happens")
        try:
            async with asyncio.timeout(SEND_TIMEOUT_S):
                await socket.send_text(message.decode())
        except TimeoutError:
            raise WebSocketClosing(TOO_SLOW, "this console has stopped reading") from None


async def _listen(socket: WebSocket, client: Client) -> None:
    while True:
        try:
            message = msgspec.json.decode(
                await socket.receive_text(), type=PictureRequest | ShownCount
            )
        except (msgspec.DecodeError, KeyError):
            raise WebSocketClosing(
                NOT_UNDERSTOOD,
                'a console sends {"type": "snapshot"} or {"type": "shown", "count": N}',
            ) from None
        if isinstance(message, PictureRequest):
            client.request_snapshot()
        elif isinstance(client, PacedClient):
            client.note_shown(message.count)


async def _keep_checking(socket: WebSocket, services: Services) -> None:
    """Close the WebSocket when its session ends; a disk that does not answer closes none."""
    trouble = LogOnChange(_log, "the session of a console cannot be checked")
    while True:
        await asyncio.sleep(CHECK_LOGIN_S)
        with trouble:
            await _check_login(socket, services)


async def _check_login(socket: WebSocket, services: Services) -> None:
    loop = asyncio.get_running_loop()
    checking = loop.run_in_executor(_CHECKING, principal_of, socket, services)
    try:
        async with asyncio.timeout(CHECKED_WITHIN_S):
            principal = await checking
    except TimeoutError:
        raise StoreError(
            coded("disk-does-not-answer", "the station's disk does not answer; check it")
        ) from None
    if principal is None:
        raise WebSocketClosing(NOT_LOGGED_IN, "log in first")
    if must_change_password(principal, services):
        raise WebSocketClosing(NOT_LOGGED_IN, CHANGE_FIRST)
    if not scope_covers(principal, (Scope.LIVE,)):
        raise WebSocketClosing(NOT_LOGGED_IN, "this token is not for the live picture")


def _as_reason(error: StoreError) -> str:
    """The part of a text that fits into a close frame."""
    return str(error).encode()[:120].decode(errors="ignore")


async def _close(socket: WebSocket, closing: WebSocketClosing) -> None:
    try:
        async with asyncio.timeout(1.0):
            await socket.close(closing.code, closing.reason)
    except (TimeoutError, WebSocketDisconnect, RuntimeError):
        _log.info("a console was cut off: %s", closing.reason)
