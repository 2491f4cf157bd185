"""The console hub: one encoding for all clients, bounded queues, a snapshot after a gap."""

from __future__ import annotations

import asyncio
import threading
from collections.abc import Callable
from typing import Any

import msgspec
import pytest

from base_station.api.hub import Hub
from base_station.api.hub_client import MAX_QUEUED, Client, PacedClient
from base_station.engine.ports import Trails
from base_station.views.wire import Delta, HealthView, Snapshot, UnitView
from shared.errors import StoreError
from tests.e2e import scenes
from tests.rig.applied_delta import patched

HEALTH = HealthView((), 0, 0, 0, 0, 0, 0.0, insecure=False)


class Source:
    """A live source that runs on the caller's thread; it answers snapshots when the test asks it
    to.
    """

    def __init__(self, hub: Hub) -> None:
        self._hub = hub
        self.seq = 0
        self.asked: list[Callable[[Snapshot, Trails], None]] = []
        self.trails: dict[str, msgspec.Raw] = {}
        self.units: tuple[UnitView, ...] = ()

    def request_snapshot(self, deliver: Callable[[Snapshot, Trails], None]) -> None:
        self.asked.append(deliver)

    def say(self, times: int = 1) -> None:
        for _ in range(times):
            self.seq += 1
            self._hub.delta(Delta(self.seq, self.seq))

    def show(self, *units: UnitView) -> None:
        """Set the units that the source has from now on."""
        shown = {unit.unit_id: unit for unit in (*self.units, *units)}
        self.units = tuple(shown.values())
        self.seq += 1
        self._hub.delta(Delta(self.seq, self.seq, units=units))

    def snapshot(self) -> Snapshot:
        seq = self.seq
        return Snapshot(seq, seq, None, self.units, (), (), (), (), (), None, None, HEALTH, None)

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


UNITS = (scenes.unit(0), scenes.unit(1))
T_MS = UNITS[0].position.t_ms if UNITS[0].position else 0


def at(unit: UnitView, **place: float) -> UnitView:
    assert unit.position is not None
    place = {"t_ms": T_MS, "floor": 0, **place}
    position = msgspec.structs.replace(unit.position, **place)
    return msgspec.structs.replace(unit, position=position)


def shown(source: Source) -> dict[str, Any]:
    return {unit.unit_id: msgspec.json.decode(msgspec.json.encode(unit)) for unit in source.units}


class ShownPage:
    """Shows units as the page does (``console/src/live/state.ts``), and confirms it."""

    def __init__(self) -> None:
        self.units: dict[str, Any] = {}
        self._count = self._seq = 0

    async def follow(self, client: PacedClient, *, confirm: bool = True) -> dict[str, Any]:
        message = await next_one(client)
        self._count += 1
        if message["type"] == "snapshot":
            self.units = {unit["unit_id"]: unit for unit in message["units"]}
        elif message["type"] == "field_delta":
            assert message["after_seq"] == self._seq
            for unit_id, change in message.get("units", {}).items():
                self.units[unit_id] = patched(self.units.get(unit_id), change)
        self._seq = message.get("seq", self._seq)
        if confirm:
            self.confirm(client)
        return message

    def confirm(self, client: PacedClient) -> None:
        client.note_shown(self._count)


@pytest.fixture
async def hub() -> Hub:
    return Hub()


@pytest.fixture
async def source(hub: Hub) -> Source:
    source = Source(hub)
    hub.connect(asyncio.get_running_loop(), source)
    return source


async def test_client_gets_a_snapshot_and_then_every_delta(hub: Hub, source: Source) -> None:
    source.say(3)
    client = hub.join()
    source.answer()
    source.say(5)
    await settle()
    first = await next_one(client)
    assert (first["type"], first["seq"]) == ("snapshot", 3)
    assert [(await next_one(client))["seq"] for _ in range(5)] == [4, 5, 6, 7, 8]


async def test_source_that_is_busy_is_asked_by_the_next_console(
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


async def test_console_that_joined_before_the_source_gets_its_snapshot(hub: Hub) -> None:
    client = hub.join()
    source = Source(hub)
    hub.connect(asyncio.get_running_loop(), source)
    source.answer()
    await settle()
    assert (await next_one(client))["type"] == "snapshot"


async def test_health_is_known_without_consoles(hub: Hub, source: Source) -> None:
    assert hub.health is None
    hub.delta(Delta(1, 1, health=HEALTH))
    source.say()
    assert hub.health is HEALTH


async def test_deltas_before_the_snapshot_are_left_out(hub: Hub, source: Source) -> None:
    client = hub.join()
    source.say(4)  # before the source has handled its requests
    source.answer()
    source.say()
    await settle()
    assert [(await next_one(client))["seq"] for _ in range(2)] == [4, 5]


async def test_all_clients_get_the_same_bytes_encoded_once(hub: Hub, source: Source) -> None:
    clients = [hub.join() for _ in range(3)]
    assert len(source.asked) == 1  # they share one snapshot
    source.answer()
    source.say()
    await settle()
    received = [[await client.next_message() for _ in range(2)] for client in clients]
    assert received[0][0] is received[1][0] is received[2][0]
    assert received[0][1] is received[1][1] is received[2][1]


async def test_slow_client_gets_a_new_snapshot_and_the_others_are_unaffected(
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
    assert not source.asked  # nothing is encoded for a client that reads nothing

    waiting = asyncio.create_task(next_one(slow))
    await settle()
    source.answer()
    caught_up = await waiting
    assert (caught_up["type"], caught_up["seq"]) == ("snapshot", source.seq)
    source.say()
    await settle()
    assert (await next_one(slow))["seq"] == source.seq
    assert (slow.lapses, quick.lapses) == (1, 0)


async def test_repeated_request_of_a_client_is_answered_once(hub: Hub, source: Source) -> None:
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


async def test_source_may_publish_from_its_own_thread(hub: Hub, source: Source) -> None:
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


async def test_program_may_request_the_snapshot(hub: Hub, source: Source) -> None:
    asked = hub.snapshot()
    assert not asked.done()
    source.say(4)
    source.answer()
    assert asked.result(0).seq == 4


@pytest.fixture
async def walked(hub: Hub, source: Source) -> Client:
    """A client that requested a snapshot with three trails, and has received part of it."""
    source.trails = {f"FF-{i}": msgspec.Raw(b"[[%d,1.0,2.0,null]]" % i) for i in range(3)}
    client = hub.join()
    source.answer()
    await settle()
    assert (await next_one(client))["type"] == "snapshot"
    first = {"type": "trail", "unit_id": "FF-0", "points": [[0, 1.0, 2.0, None]]}
    assert await next_one(client) == first
    return client


async def test_trails_wait_for_new_deltas(source: Source, walked: Client) -> None:
    source.say(2)
    await settle()
    assert [(await next_one(walked)).get("seq") for _ in range(2)] == [1, 2]
    assert [(await next_one(walked))["unit_id"] for _ in range(2)] == ["FF-1", "FF-2"]


async def test_trail_published_again_is_not_sent_twice(
    hub: Hub, source: Source, walked: Client
) -> None:
    source.seq += 1
    hub.delta(Delta(source.seq, 0, trails={"FF-1": msgspec.Raw(b"[]")}))
    await settle()
    assert (await next_one(walked))["trails"] == {"FF-1": []}
    assert (await next_one(walked))["unit_id"] == "FF-2"


async def test_trails_of_a_snapshot_end_with_it(hub: Hub, source: Source, walked: Client) -> None:
    hub.reset(source.snapshot(), {})
    source.say()
    await settle()
    assert [(await next_one(walked))["type"] for _ in range(2)] == ["snapshot", "delta"]
    with pytest.raises(TimeoutError):
        await asyncio.wait_for(walked.next_message(), 0.01)


async def test_many_trails_displace_nothing(hub: Hub, source: Source) -> None:
    source.trails = {f"FF-{i}": msgspec.Raw(b"[]") for i in range(3 * MAX_QUEUED)}
    client = hub.join()
    source.answer()
    source.say(MAX_QUEUED // 2)
    await settle()
    seen = [(await next_one(client))["type"] for _ in range(1 + MAX_QUEUED // 2 + 3 * MAX_QUEUED)]
    assert seen == ["snapshot", *["delta"] * (MAX_QUEUED // 2), *["trail"] * (3 * MAX_QUEUED)]
    assert client.lapses == 0


# ---- consoles that confirm what they have shown


async def join_paced(hub: Hub, source: Source) -> tuple[PacedClient, ShownPage]:
    """A client that has shown its first snapshot."""
    client, page = hub.join_paced(), ShownPage()
    source.answer()
    await settle()
    await page.follow(client)
    return client, page


async def test_paced_client_gets_changed_fields_only(hub: Hub, source: Source) -> None:
    source.show(*UNITS)
    plain = hub.join()
    client, page = await join_paced(hub, source)
    assert page.units == shown(source)
    walked = at(UNITS[0], north_m=4.5)
    source.show(walked)  # all fields: the console's state before is unknown
    await settle()
    await page.follow(client)
    source.show(at(walked, east_m=9.0))
    await settle()
    message = await page.follow(client)
    place = {name: message["units"]["FF-01"]["position"][name] for name in ("north_m", "east_m")}
    assert message["units"] == {"FF-01": {"position": {**place, "t_ms": T_MS, "floor": 0}}}
    assert place == {"north_m": 4.5, "east_m": 9.0}
    assert page.units == shown(source)
    assert [(await next_one(plain))["type"] for _ in range(3)] == ["snapshot", "delta", "delta"]


async def test_client_that_has_not_shown_the_last_delta_gets_the_newest_state_as_one(
    hub: Hub, source: Source
) -> None:
    source.show(*UNITS)
    client, page = await join_paced(hub, source)
    source.show(UNITS[0])
    await settle()
    await page.follow(client, confirm=False)
    for number in range(30):
        moved = at(UNITS[number % 2], t_ms=T_MS + 100 * number, north_m=float(number))
        source.show(msgspec.structs.replace(moved, person=None) if number == 28 else moved)
    await settle()
    with pytest.raises(TimeoutError):
        await asyncio.wait_for(client.next_message(), 0.01)
    page.confirm(client)
    message = await page.follow(client)
    assert (message["after_seq"], message["seq"]) == (2, 32)
    assert page.units == shown(source)
    times = [point[0] for point in message["passed"]["FF-01"]]
    assert times == [T_MS, T_MS + 1000, T_MS + 2000]
    assert client.lapses == 0


async def test_snapshot_for_one_client_does_not_mislead_the_others(
    hub: Hub, source: Source
) -> None:
    """Changes of a snapshot that no delta has had yet go to all with the next delta."""
    source.show(*UNITS)
    one, page = await join_paced(hub, source)
    source.show(*UNITS)
    await settle()
    await page.follow(one)
    quiet = msgspec.structs.replace(UNITS[1], heat_used=0.5)
    source.units = (UNITS[0], quiet)  # without a delta
    other, other_page = await join_paced(hub, source)
    source.show(msgspec.structs.replace(quiet, heat_used=UNITS[1].heat_used, cloned=True))
    await settle()
    await page.follow(one)
    await other_page.follow(other)
    assert page.units == other_page.units == shown(source)


async def test_paced_client_gets_its_trails_though_it_is_always_behind(
    hub: Hub, source: Source
) -> None:
    source.trails = {f"FF-{i}": msgspec.Raw(b"[[%d,1.0,2.0,null]]" % i) for i in range(3)}
    client, page = hub.join_paced(), ShownPage()
    source.answer()
    source.show(*UNITS)
    await settle()
    seen = []
    for _ in range(7):
        source.say(2)
        await settle()
        seen.append((await page.follow(client))["type"])
    assert seen == [
        "snapshot",
        "trail",
        "field_delta",
        "trail",
        "field_delta",
        "trail",
        "field_delta",
    ]


async def test_paced_client_that_hangs_gets_a_snapshot_once_it_is_back(
    hub: Hub, source: Source
) -> None:
    client, page = await join_paced(hub, source)
    source.say()
    await settle()
    await page.follow(client, confirm=False)
    source.say(2 * MAX_QUEUED)
    await settle()
    waiting = asyncio.create_task(page.follow(client))
    await settle()
    assert not source.asked  # nothing is encoded for a client that reads nothing
    page.confirm(client)
    await settle()
    source.answer()
    assert (await waiting)["seq"] == source.seq
    assert client.lapses == 1


async def test_requested_snapshot_is_sent_whatever_the_client_has_shown(
    hub: Hub, source: Source
) -> None:
    client, page = await join_paced(hub, source)
    source.say()
    await settle()
    await page.follow(client, confirm=False)
    client.request_snapshot()
    source.answer()
    await settle()
    assert (await page.follow(client))["type"] == "snapshot"
