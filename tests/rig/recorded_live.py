"""A live picture that was recorded as a console gets it, served again without its station."""

from __future__ import annotations

import asyncio
import json
import time
from contextlib import ExitStack, suppress
from dataclasses import dataclass, field
from threading import Event, Thread

from websockets.asyncio.server import Server, ServerConnection, serve
from websockets.exceptions import ConnectionClosed
from websockets.sync.client import connect

from base_station.api.hub_client import PacedClient
from tests.rig.console_client import Api


@dataclass(slots=True)
class Recording:
    """``FieldDelta`` of one connection, with the snapshot and the trails before them."""

    began_s: float = 0.0  # UTC, when the snapshot came
    snapshot: bytes = b""
    trails: dict[str, bytes] = field(default_factory=dict)  # by unit
    deltas: list[tuple[float, bytes]] = field(default_factory=list)  # seconds after the snapshot


class Recorder:
    """Confirms each message at once, so that the station merges none."""

    def __init__(self, api: Api, closing: ExitStack) -> None:
        """Records until ``closing`` ends."""
        self.recording = Recording()
        self._socket = closing.enter_context(
            connect(
                api.live_url + "?deltas=fields",
                additional_headers={"Cookie": api.cookie, "Origin": api.origin},
                max_size=None,
            )
        )
        Thread(target=self._listen, name="bench-recorder", daemon=True).start()

    def _listen(self) -> None:
        with suppress(ConnectionClosed):
            for count, message in enumerate(self._socket, 1):
                self._note(message.encode() if isinstance(message, str) else message)
                self._socket.send(json.dumps({"type": "shown", "count": count}))

    def _note(self, message: bytes) -> None:
        content = json.loads(message)
        recording = self.recording
        if content["type"] == "snapshot":
            recording.began_s, recording.snapshot = time.time(), message
        elif content["type"] == "trail":
            recording.trails[content["unit_id"]] = message
        else:
            recording.deltas.append((time.time() - recording.began_s, message))


class RecordedLive:
    """A WebSocket that plays the recording to every console, paced as by the station."""

    def __init__(self, recording: Recording, closing: ExitStack) -> None:
        """Served until ``closing`` ends."""
        self.url = ""
        self.late_s = 0.0  # what the newest console gets comes so long after it was recorded
        self._recording = recording
        self._loop = asyncio.new_event_loop()
        self._server: Server | None = None
        ready = Event()
        thread = Thread(target=self._run, args=(ready,), name="recorded-live", daemon=True)
        thread.start()
        ready.wait()
        closing.callback(thread.join)
        closing.callback(self._loop.call_soon_threadsafe, self._loop.stop)

    def _run(self, ready: Event) -> None:
        self._loop.run_until_complete(self._open())
        ready.set()
        self._loop.run_forever()
        self._loop.run_until_complete(self._close())
        self._loop.close()

    async def _open(self) -> None:
        self._server = await serve(self._show, "127.0.0.1", 0, max_size=None)
        _, port = next(iter(self._server.sockets)).getsockname()
        self.url = f"ws://127.0.0.1:{port}"

    async def _close(self) -> None:
        if self._server is not None:
            self._server.close()
            await self._server.wait_closed()

    async def _show(self, socket: ServerConnection) -> None:
        client = PacedClient(lambda: None)
        client.request_snapshot()
        recording = self._recording
        client.enqueue_snapshot(recording.snapshot, recording.trails, requested_only=True)
        self.late_s = time.time() - recording.began_s
        others = [
            asyncio.create_task(self._play(client)),
            asyncio.create_task(_send(socket, client)),
        ]
        try:
            async for message in socket:
                content = json.loads(message)
                if content["type"] == "shown":
                    client.note_shown(content["count"])
        finally:
            for task in others:
                task.cancel()
            await asyncio.gather(*others, return_exceptions=True)

    async def _play(self, client: PacedClient) -> None:
        began_s = self._loop.time()
        for after_s, message in self._recording.deltas:
            await asyncio.sleep(began_s + after_s - self._loop.time())
            client.enqueue_delta(message, ())


async def _send(socket: ServerConnection, client: PacedClient) -> None:
    with suppress(ConnectionClosed):
        while True:
            await socket.send((await client.next_message()).decode())
