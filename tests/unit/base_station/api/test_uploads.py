"""Turns of uploads: which account's upload is read, and for how long while others wait."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator
from contextlib import AsyncExitStack

import pytest
import pytest_asyncio
from starlette.types import Message

from base_station.api.problems import Problem
from base_station.api.uploads import UploadTurn, UploadTurns
from tests.rig.waiting import PATIENCE_S

NEVER_S = 3600.0
LAST_PIECE: Message = {"type": "http.request", "body": b"x", "more_body": False}


async def no_piece() -> Message:
    await asyncio.sleep(NEVER_S)
    raise AssertionError


async def last_piece() -> Message:
    return LAST_PIECE


class Upload:
    """One upload; its body arrives when the test lets it."""

    def __init__(self, turns: UploadTurns, account: str) -> None:
        self._turns = turns
        self._account = account
        self._turn: asyncio.Future[UploadTurn] = asyncio.get_running_loop().create_future()
        self._may_finish = asyncio.Event()
        self._task = asyncio.create_task(self._take())

    @property
    def has_turn(self) -> bool:
        return self._turn.done() and not self._task.done()

    async def turn(self) -> UploadTurn:
        async with asyncio.timeout(PATIENCE_S):
            return await asyncio.shield(self._turn)

    async def finish(self) -> None:
        self._may_finish.set()
        await self._task

    async def cancel(self) -> None:
        self._task.cancel()
        await asyncio.wait({self._task})

    async def _take(self) -> None:
        async with self._turns.take(self._account) as turn:
            self._turn.set_result(turn)
            await self._may_finish.wait()


async def settle() -> None:
    for _ in range(10):
        await asyncio.sleep(0)


@pytest_asyncio.fixture
async def cleanup() -> AsyncIterator[AsyncExitStack]:
    async with AsyncExitStack() as stack:
        yield stack


def uploads(cleanup: AsyncExitStack, turns: UploadTurns, accounts: str) -> list[Upload]:
    """One upload for each letter, which is the account's name."""
    made = [Upload(turns, account) for account in accounts]
    for one in made:
        cleanup.push_async_callback(one.cancel)
    return made


async def test_one_account_has_two_turns_and_all_have_four(cleanup: AsyncExitStack) -> None:
    made = uploads(cleanup, UploadTurns(NEVER_S), "aaabbbc")
    await settle()
    assert [one.has_turn for one in made] == [True, True, False, True, True, False, False]


async def test_turn_goes_to_the_account_that_waits_longest(cleanup: AsyncExitStack) -> None:
    a, *rest = uploads(cleanup, UploadTurns(NEVER_S), "aabbaaaac")
    await settle()
    await a.finish()
    await settle()
    assert [one.has_turn for one in rest] == [True] * 3 + [True] + [False] * 4
    await rest[0].finish()
    await settle()
    assert rest[-1].has_turn  # of another account, though it came last


async def test_slow_body_loses_its_turn_to_a_waiting_upload(cleanup: AsyncExitStack) -> None:
    turns = UploadTurns(0.0)
    slow = uploads(cleanup, turns, "aabb")
    first, second = await slow[0].turn(), await slow[1].turn()
    [waiting] = uploads(cleanup, turns, "c")
    with pytest.raises(Problem) as refused:
        await first.receive(no_piece)
    assert refused.value.status_code == 408
    assert "smaller" in refused.value.detail
    assert not second.has_ended  # one slow upload ends for one that waits
    await slow[0].finish()
    await waiting.turn()


async def test_slow_body_keeps_its_turn_without_waiting_uploads(cleanup: AsyncExitStack) -> None:
    slow = uploads(cleanup, UploadTurns(0.0), "aabb")
    await settle()
    assert not any([(await one.turn()).has_ended for one in slow])


async def test_upload_ends_no_turn_of_its_own_account(cleanup: AsyncExitStack) -> None:
    slow = uploads(cleanup, UploadTurns(0.0), "aaa")
    await settle()
    assert not any([(await one.turn()).has_ended for one in slow[:2]])
    assert not slow[2].has_turn


async def test_received_body_is_processed_without_time_limit(cleanup: AsyncExitStack) -> None:
    turns = UploadTurns(0.0)
    come, *_ = made = uploads(cleanup, turns, "aabb")
    first, second = await come.turn(), await made[1].turn()
    assert await first.receive(last_piece) == LAST_PIECE
    uploads(cleanup, turns, "c")
    with pytest.raises(Problem):
        await second.receive(no_piece)
    assert not first.has_ended


async def test_waiting_upload_that_ends_takes_no_turn(cleanup: AsyncExitStack) -> None:
    turns = UploadTurns(NEVER_S)
    first, *_, gone, last = uploads(cleanup, turns, "aabbcd")
    await settle()
    await gone.cancel()
    await first.finish()
    await last.turn()
