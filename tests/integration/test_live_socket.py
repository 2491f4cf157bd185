"""The live WebSocket over a real server on the loopback."""

from __future__ import annotations

import asyncio
import json
import socket
import time
from collections.abc import AsyncIterator
from typing import Any

import httpx
import jsonschema_rs
import pytest
import pytest_asyncio
from websockets.asyncio.client import ClientConnection, connect
from websockets.exceptions import ConnectionClosed, InvalidStatus

from base_station.accounts.principals import Role
from base_station.api.authentication import COOKIE, Scope
from base_station.api.routes import live
from base_station.api.server import ConsoleServer, bind
from shared.errors import StoreError
from shared.messages.station import OpenIncident, RegisterUnit
from tests.rig.in_process_station import PASSWORD, InProcessStation
from tests.rig.live_page import LIVE_SCHEMA

SCHEMA = jsonschema_rs.validator_for(LIVE_SCHEMA.read_text())


@pytest_asyncio.fixture
async def address(station: InProcessStation) -> AsyncIterator[str]:
    """HOST:PORT of the running server."""
    listening = bind("127.0.0.1", 0)
    port = listening.getsockname()[1]
    server = ConsoleServer(station.app, listening)
    task = asyncio.create_task(server.serve())
    await asyncio.wait_for(server.wait_started(), 10.0)
    yield f"127.0.0.1:{port}"
    server.stop()
    await asyncio.wait_for(task, 10.0)


def token_of(station: InProcessStation, role: Role = Role.VIEWER) -> dict[str, str]:
    _, secret = station.services.accounts.add_token(role.word, "test", role, None)
    return {"Authorization": f"Bearer {secret}"}


async def received(console: ClientConnection) -> dict[str, Any]:
    message: dict[str, Any] = json.loads(await asyncio.wait_for(console.recv(), 5.0))
    SCHEMA.validate(message)
    return message


async def close_code(console: ClientConnection) -> int:
    with pytest.raises(ConnectionClosed) as closed:
        await asyncio.wait_for(_drain(console), 15.0)
    assert closed.value.rcvd is not None
    return closed.value.rcvd.code


async def _drain(console: ClientConnection) -> None:
    while True:
        await console.recv()


async def act(station: InProcessStation, name: str) -> None:
    await asyncio.to_thread(station.services.gate.submit, "mia", OpenIncident(name, name))


async def act_unit(station: InProcessStation, unit_id: str) -> None:
    await asyncio.to_thread(station.services.gate.submit, "mia", RegisterUnit(unit_id, unit_id))


async def test_a_snapshot_and_then_deltas_and_a_snapshot_when_asked(
    station: InProcessStation, address: str
) -> None:
    headers = token_of(station)
    async with connect(f"ws://{address}/api/v1/live", additional_headers=headers) as console:
        first = await received(console)
        assert first["type"] == "snapshot"
        await act(station, "kitchen")
        delta = await received(console)
        assert (delta["type"], delta["seq"]) == ("delta", first["seq"] + 1)
        await console.send('{"type": "snapshot"}')
        again = await received(console)
        assert (again["type"], again["seq"]) == ("snapshot", delta["seq"])
        assert again["incident"]["name"] == "kitchen"


async def test_confirming_console_gets_merged_deltas(
    station: InProcessStation, address: str
) -> None:
    url, headers = f"ws://{address}/api/v1/live?deltas=fields", token_of(station)
    async with connect(url, additional_headers=headers) as slow:
        first = await received(slow)
        for unit in range(4):
            await act_unit(station, f"FF-0{unit}")
        with pytest.raises(TimeoutError):
            await asyncio.wait_for(slow.recv(), 0.3)
        await slow.send('{"type": "shown", "count": 1}')
        merged = await received(slow)
        assert (merged["type"], merged["after_seq"]) == ("field_delta", first["seq"])
        assert merged["seq"] == first["seq"] + 4
        assert {unit["label"] for unit in merged["units"].values()} == set(merged["units"])
        await slow.send('{"type": "shown", "count": 2}')
        await act_unit(station, "FF-04")
        assert list((await received(slow))["units"]) == ["FF-04"]
    # Torn off, it begins with a picture that has everything, and its count anew.
    async with connect(url, additional_headers=headers) as again:
        picture = await received(again)
        assert (picture["type"], picture["seq"]) == ("snapshot", merged["seq"] + 1)
        assert len(picture["units"]) == 5
        await again.send('{"type": "shown", "count": 1}')
        await act_unit(station, "FF-05")
        assert (await received(again))["after_seq"] == picture["seq"]


async def test_messages_are_compressed_for_consoles_that_offer_it(
    station: InProcessStation, address: str
) -> None:
    url, headers = f"ws://{address}/api/v1/live", token_of(station)
    async with (
        connect(url, additional_headers=headers) as offering,
        connect(url, additional_headers=headers, compression=None) as plain,
    ):
        assert offering.response is not None
        assert plain.response is not None
        agreed = offering.response.headers["Sec-WebSocket-Extensions"]
        assert "server_no_context_takeover" in agreed
        assert "Sec-WebSocket-Extensions" not in plain.response.headers
        assert await received(offering) == await received(plain)


async def test_browser_is_authenticated_by_its_cookie(
    station: InProcessStation, address: str
) -> None:
    async with httpx.AsyncClient(base_url=f"http://{address}") as browser:
        browser.headers["origin"] = f"http://{address}"
        credentials = {"username": "viewer", "password": PASSWORD}
        assert (await browser.post("/api/v1/login", json=credentials)).status_code == 200
        headers = {"Cookie": f"{COOKIE}={browser.cookies[COOKIE]}"}
    url = f"ws://{address}/api/v1/live"
    own, foreign = f"http://{address}", "http://evil.example"
    async with connect(url, additional_headers=headers, origin=own) as console:  # type: ignore[arg-type]  # a str will do
        assert (await received(console))["type"] == "snapshot"
    with pytest.raises(InvalidStatus):
        async with connect(url, additional_headers=headers, origin=foreign):  # type: ignore[arg-type]  # a str will do
            pass


async def test_connection_without_login_is_closed_with_its_code(address: str) -> None:
    async with connect(f"ws://{address}/api/v1/live") as console:
        assert await close_code(console) == live.NOT_LOGGED_IN


async def test_connection_before_the_password_change_is_closed(
    station: InProcessStation, address: str
) -> None:
    accounts = station.services.accounts
    accounts.add_user("first", PASSWORD, Role.ADMINISTRATOR, generated=True)
    headers = {"Cookie": f"{COOKIE}={accounts.log_in('first', PASSWORD)}"}
    url, own = f"ws://{address}/api/v1/live", f"http://{address}"
    async with connect(url, additional_headers=headers, origin=own) as console:  # type: ignore[arg-type]  # a str will do
        assert await close_code(console) == live.NOT_LOGGED_IN
        assert "generated" in (console.close_reason or "")
    accounts.change_user("first", f"{PASSWORD}!", None)
    headers = {"Cookie": f"{COOKIE}={accounts.begin_session('first')}"}
    async with connect(url, additional_headers=headers, origin=own) as console:  # type: ignore[arg-type]  # a str will do
        assert (await received(console))["type"] == "snapshot"


@pytest.mark.parametrize("path", ["live", "replays/none/live"])
async def test_token_of_another_scope_is_refused(
    station: InProcessStation, address: str, path: str
) -> None:
    accounts, url = station.services.accounts, f"ws://{address}/api/v1/{path}"
    others = {scope.value for scope in Scope} - {"live"}
    for scopes, code in ((others, live.NOT_LOGGED_IN), ({"live"}, live.NOT_FOUND)):
        _, secret = accounts.add_token("viewer", "t", Role.VIEWER, None, scopes)
        headers = {"Authorization": f"Bearer {secret}"}
        async with connect(url, additional_headers=headers) as console:
            if path == "live" and scopes == {"live"}:
                assert (await received(console))["type"] == "snapshot"
            else:
                assert await close_code(console) == code


async def test_large_message_of_a_console_is_refused(
    station: InProcessStation, address: str
) -> None:
    url = f"ws://{address}/api/v1/live"
    async with connect(url, additional_headers=token_of(station)) as console:
        await received(console)
        await console.send('{"type": "snapshot"}' + " " * 5000)
        assert await close_code(console) == 1009


async def test_unknown_replay_is_refused_with_its_code(
    station: InProcessStation, address: str
) -> None:
    url = f"ws://{address}/api/v1/replays/none/live"
    async with connect(url, additional_headers=token_of(station)) as console:
        assert await close_code(console) == live.NOT_FOUND


@pytest.mark.parametrize(
    "message", ["hello", '{"type": "delta"}', '{"type": "shown"}', "[]", "{", b"\x00\x01"]
)
async def test_invalid_request_ends_the_connection(
    station: InProcessStation, address: str, message: str | bytes
) -> None:
    url = f"ws://{address}/api/v1/live"
    async with connect(url, additional_headers=token_of(station)) as console:
        await received(console)
        await console.send(message)
        assert await close_code(console) == live.NOT_UNDERSTOOD


async def test_the_end_of_a_session_ends_its_socket(
    station: InProcessStation, address: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(live, "CHECK_LOGIN_S", 0.1)
    headers = token_of(station)
    url = f"ws://{address}/api/v1/live"
    async with connect(url, additional_headers=headers) as console:
        await received(console)
        (token,) = station.services.accounts.tokens("viewer")
        station.services.accounts.remove_token("viewer", token.token_id)
        assert await close_code(console) == live.NOT_LOGGED_IN


async def test_disk_failure_keeps_open_connections_and_refuses_new_ones(
    station: InProcessStation,
    address: str,
    monkeypatch: pytest.MonkeyPatch,
    caplog: pytest.LogCaptureFixture,
) -> None:
    def fail(_secret: str) -> None:
        tries.append(1)
        raise StoreError("the database cannot be read: disk I/O error; free or mend the disk")

    tries: list[int] = []
    monkeypatch.setattr(live, "CHECK_LOGIN_S", 0.02)
    headers, url = token_of(station), f"ws://{address}/api/v1/live"
    async with connect(url, additional_headers=headers) as console:
        await received(console)
        with monkeypatch.context() as broken:
            broken.setattr(station.services.accounts, "of_token", fail)
            async with connect(url, additional_headers=headers) as refused:
                assert await close_code(refused) == live.TRY_AGAIN
            while len(tries) < 5:
                await asyncio.sleep(0.02)
        await act(station, "kitchen")
        assert (await received(console))["type"] == "delta"
        (token,) = station.services.accounts.tokens("viewer")
        station.services.accounts.remove_token("viewer", token.token_id)
        assert await close_code(console) == live.NOT_LOGGED_IN
    assert caplog.text.count("cannot be checked: the database") == 1


async def test_console_that_stops_reading_is_disconnected(
    station: InProcessStation, address: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(live, "SEND_TIMEOUT_S", 0.5)
    headers = token_of(station)
    url = f"ws://{address}/api/v1/live"
    # A small buffer, and big messages, so that it is soon full.
    host, _, port = address.rpartition(":")
    narrow = socket.socket()
    narrow.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
    narrow.connect((host, int(port)))
    async with (
        connect(
            url,
            additional_headers=headers,
            max_queue=1,
            sock=narrow,
            close_timeout=0.5,
            compression=None,
        ) as stuck,
        connect(url, additional_headers=headers, max_queue=100_000) as reading,
    ):
        await received(stuck)
        last = (await received(reading))["seq"]
        name = "x" * 60_000
        end_s = time.monotonic() + 20.0
        while station.hub.watchers == 2:
            assert time.monotonic() < end_s, "it was not cut off"
            await act(station, name)
            while (message := await received(reading))["type"] == "snapshot":
                pass
            assert message["seq"] == last + 1
            last = message["seq"]
            station.hub.reset(station.drive.picture(), {})


async def test_the_server_stops_with_consoles_connected(station: InProcessStation) -> None:
    listening = bind("127.0.0.1", 0)
    port = listening.getsockname()[1]
    server = ConsoleServer(station.app, listening)
    task = asyncio.create_task(server.serve())
    await server.wait_started()
    url = f"ws://127.0.0.1:{port}/api/v1/live"
    async with connect(url, additional_headers=token_of(station)) as console:
        await received(console)
        server.stop()
        await asyncio.wait_for(task, 10.0)
        assert await close_code(console) in (1001, 1012)
