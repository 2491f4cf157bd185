"""Request bodies: sizes, media types, and the errors of invalid ones."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator

import httpx
import pytest
import pytest_asyncio

from base_station.accounts.principals import Role
from base_station.api.forms import MAX_BYTES, MAX_UPLOAD_BYTES
from base_station.api.uploads import UploadTurns
from tests.rig.in_process_station import InProcessStation
from tests.rig.waiting import PATIENCE_S


@pytest_asyncio.fixture
async def commander(station: InProcessStation) -> AsyncIterator[httpx.AsyncClient]:
    async with station.client(Role.COMMANDER) as client:
        yield client


JSON = {"content-type": "application/json"}


async def chunks(count: int) -> AsyncIterator[bytes]:
    for _ in range(count):
        yield bytes(100_000)


@pytest.mark.parametrize(
    ("method", "path", "most"),
    [
        ("POST", "/people", MAX_BYTES),
        ("PUT", "/site/plan", MAX_UPLOAD_BYTES),
        ("PUT", "/people/x/photo", MAX_UPLOAD_BYTES),
    ],
)
async def test_endless_body_is_refused(
    commander: httpx.AsyncClient, method: str, path: str, most: int
) -> None:
    reported = await commander.request(method, path, content=b"x" * (most + 1), headers=JSON)
    untold = await commander.request(method, path, content=chunks(most // 100_000 + 1))
    for answer in (reported, untold):
        assert (answer.status_code, answer.json()["status"]) == (413, 413)
        assert answer.json()["detail"].startswith("This is too large: a picture, a plan or a map")
        assert answer.headers["content-type"] == "application/problem+json"
        assert "default-src 'self'" in answer.headers["content-security-policy"]


@pytest.mark.parametrize("path", ["/site/plan", "/people/x/photo", "/site/base-map?world=1"])
async def test_body_of_a_request_without_login_is_not_read(
    station: InProcessStation, path: str
) -> None:
    read = 0

    async def body() -> AsyncIterator[bytes]:
        nonlocal read
        for _ in range(100):
            read += 1
            yield bytes(100_000)

    async with station.client() as client:
        assert (await client.put(path, content=body())).status_code == 401
    assert read <= 1


@pytest.mark.parametrize("bomb", ["[" * 60_000, '{"a":' * 10_000, "9" * 60_000, '"\\ud800"'])
async def test_deeply_nested_json_is_refused(commander: httpx.AsyncClient, bomb: str) -> None:
    for path in ("/people", "/commands", "/tokens"):
        assert (await commander.post(path, content=bomb)).status_code in (400, 422)
    assert (await commander.put("/site/plan", content=bomb)).status_code in (400, 422)


async def test_slow_uploads_delay_no_picture_and_no_plan_of_others(
    station: InProcessStation, commander: httpx.AsyncClient
) -> None:
    station.app.state.upload_turns = UploadTurns(turn_s=0.1)
    read, may_end = 0, asyncio.Event()

    async def slow_body() -> AsyncIterator[bytes]:
        nonlocal read
        read += 1
        yield b" "
        await may_end.wait()

    async with (
        station.client(Role.VIEWER) as viewer,
        station.client(Role.ADMINISTRATOR) as administrator,
    ):
        slow = [
            asyncio.create_task(client.put("/people/x/photo", content=slow_body(), headers=JSON))
            for client in (viewer, viewer, administrator, administrator)
        ]
        async with asyncio.timeout(PATIENCE_S):
            while read < len(slow):  # all that are read at once
                await asyncio.sleep(0.01)
            answers = [
                await commander.put(path, content=b"{}", headers=JSON)
                for path in ("/people/x/photo", "/site/plan")
            ]
            refused, *_ = await asyncio.wait(slow, return_when=asyncio.FIRST_COMPLETED)
            may_end.set()
            statuses = [answer.status_code for answer in await asyncio.gather(*slow)]
    assert [answer.status_code for answer in answers] == [422, 422]  # read, and of no use
    assert statuses.count(408) == len(refused) == 1  # one was enough
    ended = next(iter(refused)).result()
    assert "others waited" in ended.json()["detail"]
    assert ended.headers["connection"] == "close"


FORM = b'{"name": "Ada"}'


@pytest.mark.parametrize(
    ("body", "kind"),
    [
        (b"", None),
        (b"", "application/json"),
        (FORM, None),
        (FORM, "text/plain"),
        (FORM, "application/x-www-form-urlencoded"),
        (FORM[:-1], "application/json"),
        (b"\xff", "application/json"),
        (b"[1]", "application/json"),
    ],
)
@pytest.mark.parametrize(("method", "path"), [("POST", "/people"), ("PUT", "/site/plan")])
async def test_body_that_is_no_json_is_refused_with_a_reason(
    commander: httpx.AsyncClient, method: str, path: str, body: bytes, kind: str | None
) -> None:
    headers = {} if kind is None else {"content-type": kind}
    answer = await commander.request(method, path, content=body, headers=headers)
    assert answer.status_code in (400, 422)
    wanted = "send one JSON object as the body, with the header Content-Type: application/json"
    assert answer.json()["detail"] == wanted


@pytest.mark.parametrize(
    ("body", "kind"), [(b"", None), (b"[1]", "application/json"), (b"\xff", "application/json")]
)
async def test_body_that_is_no_picture_is_refused_with_a_reason(
    commander: httpx.AsyncClient, body: bytes, kind: str | None
) -> None:
    headers = {} if kind is None else {"content-type": kind}
    answer = await commander.put("/people/x/photo", content=body, headers=headers)
    assert answer.status_code in (400, 422)
    assert "send the file itself as the body" in answer.json()["detail"]
