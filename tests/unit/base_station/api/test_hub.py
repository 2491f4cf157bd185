"""The console hub: one encoding for all, bounded queues, a snapshot after a gap."""

from __future__ import annotations

import asyncio
import threading
from collections.abc import Callable
from typing import Any

import msgspec
import pytest

from base_station.api.hub import MAX_QUEUED, Client, Hub
from base_station.engine.ports import Trails
from base_station.views.wire import Delta, HealthView, Snapshot
from shared.errors import StoreError

HEALTH = HealthView((), 0, 0, 0, 0, 0, 0.0, insecure=False)


class Source:
    """A live source whose thread is whoever calls it; it answers snapshots when told to."""

    def __init__(self, hub: Hub) -> None:
        self._hub = hub
        self.seq = 0
        self.asked: list[Callable[[Snapshot, Trails], None]] = []
        self.trails: dict[str, msgspec.Raw] = {}

    def request_snapshot(self, deliver: Callable[[Snapshot, Trails], None]) -> None:
        self.asked.append(deliver)

    def say(self, times: int = 1) -> None:
        for _ in range(times):
            self.seq += 1
            self._hub.delta(Delta(self.seq, self.seq))

    def snapshot(self) -> Snapshot:
        seq = self.seq
        return Snapshot(seq, seq, None, (), (), (), (), (), (), None, None, HEALTH, None)

    def answer(self) -> None:
        for deliver in self.asked:
            deliver(self.snapshot(), self.trails)
        self.asked.clear()


async def settle() -> None:
    await asyncio.sleep(0)
    await asyncio.sleep(0)


async def next_one(client: Client) -> dict[str, Any]:
    message = await asyncio.wait_for(client.next_message(), 1.0)
    decoded: dict[str, Any] = msgspec.json.decode(message)
    return decoded


@pytest.fixture
async def hub() -> Hub:
    return Hub()


@pytest.fixture
async def source(hub: Hub) -> Source:
    source = Source(hub)
    hub.connect(asyncio.get_running_loop(), source)
    return source


async def test_a_client_gets_a_snapshot_and_then_every_delta(hub: Hub, source: Source) -> None:
    source.say(3)
    client = hub.join()
    source.answer()
    source.say(5)
    await settle()
    first = await next_one(client)
    assert (first["type"], first["seq"]) == ("snapshot", 3)
    assert [(await next_one(client))["seq"] for _ in range(5)] == [4, 5, 6, 7, 8]


async def test_a_source_that_cannot_be_asked_now_is_asked_by_the_next_console(
    hub: Hub, source: Source, monkeypatch: pytest.MonkeyPatch
) -> None:
    def fail(_: object) -> None:
        raise StoreError("the disk does not answer")

    with monkeypatch.context() as patched:
        patched.setattr(source, "request_snapshot", fail)
        with pytest.raises(StoreError):
            hub.join()
    assert hub.watchers == 0
    client = hub.join()
    source.answer()
    await settle()
    assert (await next_one(client))["type"] == "snapshot"


async def test_a_console_that_came_before_the_source_is_shown_it(hub: Hub) -> None:
    client = hub.join()
    source = Source(hub)
    hub.connect(asyncio.get_running_loop(), source)
    source.answer()
    await settle()
    assert (await next_one(client))["type"] == "snapshot"


async def test_how_the_station_is_is_known_where_nobody_looks(hub: Hub, source: Source) -> None:
    assert hub.health is None
    hub.delta(Delta(1, 1, health=HEALTH))
    source.say()
    assert hub.health is HEALTH


async def test_deltas_before_the_snapshot_are_left_out(hub: Hub, source: Source) -> None:
    client = hub.join()
    source.say(4)  # before the source has looked at its requests
    source.answer()
    source.say()
    await settle()
    assert [(await next_one(client))["seq"] for _ in range(2)] == [4, 5]


async def test_everyone_gets_the_same_bytes_encoded_once(hub: Hub, source: Source) -> None:
    clients = [hub.join() for _ in range(3)]
    assert len(source.asked) == 1  # they share one snapshot
    source.answer()
    source.say()
    await settle()
    received = [[await client.next_message() for _ in range(2)] for client in clients]
    assert received[0][0] is received[1][0] is received[2][0]
    assert received[0][1] is received[1][1] is received[2][1]


async def test_a_slow_client_gets_a_new_snapshot_and_the_others_nothing_of_it(
    hub: Hub, source: Source
) -> None:
    slow, quick = hub.join(), hub.join()
    source.answer()
    await settle()
    await next_one(slow)
    seen = [await next_one(quick)]
    for _ in range(3 * MAX_QUEUED):
        source.say()
        await settle()
        seen.append(await next_one(quick))
    assert [one["seq"] for one in seen[1:]] == list(range(1, 3 * MAX_QUEUED + 1))
    assert not source.asked  # nothing is made for a client that takes nothing

    waiting = asyncio.create_task(next_one(slow))
    await settle()
    source.answer()
    caught_up = await waiting
    assert (caught_up["type"], caught_up["seq"]) == ("snapshot", source.seq)
    source.say()
    await settle()
    assert (await next_one(slow))["seq"] == source.seq
    assert (slow.lapses, quick.lapses) == (1, 0)


async def test_a_client_may_ask_again_and_asks_once(hub: Hub, source: Source) -> None:
    client = hub.join()
    source.answer()
    await settle()
    await next_one(client)
    source.say(2)
    await settle()
    for _ in range(5):
        client.request_snapshot()
    assert len(source.asked) == 1
    source.answer()
    await settle()
    assert (await next_one(client))["type"] == "snapshot"


async def test_a_reset_reaches_all(hub: Hub, source: Source) -> None:
    client = hub.join()
    source.answer()
    source.say(2)
    hub.reset(source.snapshot(), {})
    source.say()
    await settle()
    assert [(await next_one(client))["type"] for _ in range(2)] == ["snapshot", "delta"]


async def test_the_source_may_speak_from_its_own_thread(hub: Hub, source: Source) -> None:
    client = hub.join()
    source.answer()
    thread = threading.Thread(target=source.say, args=(50,))
    thread.start()
    seqs = [(await next_one(client))["seq"] for _ in range(51)]
    thread.join()
    assert seqs == list(range(51))


async def test_without_clients_nothing_is_encoded(hub: Hub, source: Source) -> None:
    client = hub.join()
    hub.leave(client)
    source.answer()
    source.say(10)
    await settle()
    assert hub.watchers == 0
    with pytest.raises(TimeoutError):
        await asyncio.wait_for(client.next_message(), 0.01)


async def test_a_program_may_ask_for_the_picture(hub: Hub, source: Source) -> None:
    asked = hub.snapshot()
    assert not asked.done()
    source.say(4)
    source.answer()
    assert asked.result(0).seq == 4


@pytest.fixture
async def walked(hub: Hub, source: Source) -> Client:
    """Has asked for a picture with three trails, and has it in part."""
    source.trails = {f"FF-{i}": msgspec.Raw(b"[[%d,1.0,2.0,null]]" % i) for i in range(3)}
    client = hub.join()
    source.answer()
    await settle()
    assert (await next_one(client))["type"] == "snapshot"
    first = {"type": "trail", "unit_id": "FF-0", "points": [[0, 1.0, 2.0, None]]}
    assert await next_one(client) == first
    return client


async def test_trails_wait_for_whatever_is_new(source: Source, walked: Client) -> None:
    source.say(2)
    await settle()
    assert [(await next_one(walked)).get("seq") for _ in range(2)] == [1, 2]
    assert [(await next_one(walked))["unit_id"] for _ in range(2)] == ["FF-1", "FF-2"]


async def test_a_trail_that_was_told_anew_does_not_come_again(
    hub: Hub, source: Source, walked: Client
) -> None:
    source.seq += 1
    hub.delta(Delta(source.seq, 0, trails={"FF-1": msgspec.Raw(b"[]")}))
    await settle()
    assert (await next_one(walked))["trails"] == {"FF-1": []}
    assert (await next_one(walked))["unit_id"] == "FF-2"


async def test_trails_of_a_picture_are_gone_with_it(
    hub: Hub, source: Source, walked: Client
) -> None:
    hub.reset(source.snapshot(), {})
    source.say()
    await settle()
    assert [(await next_one(walked))["type"] for _ in range(2)] == ["snapshot", "delta"]
    with pytest.raises(TimeoutError):
        await asyncio.wait_for(walked.next_message(), 0.01)


async def test_many_trails_push_nobody_out(hub: Hub, source: Source) -> None:
    source.trails = {f"FF-{i}": msgspec.Raw(b"[]") for i in range(3 * MAX_QUEUED)}
    client = hub.join()
    source.answer()
    source.say(MAX_QUEUED // 2)
    await settle()
    seen = [(await next_one(client))["type"] for _ in range(1 + MAX_QUEUED // 2 + 3 * MAX_QUEUED)]
    assert seen == ["snapshot", *["delta"] * (MAX_QUEUED // 2), *["trail"] * (3 * MAX_QUEUED)]
    assert client.lapses == 0
