"""Forwarder to TAK: keeps a connection and sends what the outbox has due."""

from __future__ import annotations

import asyncio
import logging

from base_station.forwarders.connection_status import ConnectionStatus
from base_station.forwarders.interface import Surroundings
from base_station.forwarders.mailbox import Mailbox
from base_station.forwarders.tak.config import TakConfig
from base_station.forwarders.tak.connection import (
    NO_ANSWER,
    ConnectionLostError,
    TakConnection,
    in_batches,
    open_connection,
)
from base_station.forwarders.tak.cot import CotEvents
from base_station.forwarders.tak.inbox import ExternalInbox
from base_station.forwarders.tak.outbox import TakOutbox
from base_station.storage.projection import Projection
from base_station.views.answer import to_ms, to_ms_or_none
from base_station.views.text_code import text_code_view_or_none
from base_station.views.wire import Delta, ForwarderView, Snapshot
from shared.clock import NS_PER_S
from shared.coded_text import code_of_text, coded, text_of_error
from shared.worker import Worker

_FIRST_RETRY_S = 1.0
_RETRY_MAX_S = 30.0
_STANDBY_S = 1.0
_PING_NS = 10 * NS_PER_S
_SILENT_NS = 35 * NS_PER_S  # three pings without an answer, of a server that has answered
_CLOSE_S = 5.0

logger = logging.getLogger(__name__)


class TakForwarder:
    """A ``Forwarder`` for one ``[tak.NAME]``."""

    def __init__(self, name: str, config: TakConfig, surroundings: Surroundings) -> None:
        self._name, self._config = name, config
        self._clock, self._leads = surroundings.clock, surroundings.leads
        events = CotEvents(config.uid_prefix, config.team, names=config.names)
        self._events = events
        self._outbox = TakOutbox(events, config.every_s, breadcrumbs=config.breadcrumbs)
        self._inbox = ExternalInbox(
            name, config.uid_prefix, config.within_m, surroundings.note_external
        )
        self._mailbox = Mailbox()
        self._status = ConnectionStatus(f"TAK {name} ({config.url})", self._clock)
        self._retry_s = _FIRST_RETRY_S
        self._awake: asyncio.Event | None = None  # of the connection that is open
        self._loop: asyncio.AbstractEventLoop | None = None
        self._last_received_ns: int | None = (
            None  # monotonic; None: nothing came over this connection
        )
        self._worker = Worker(
            f"tak-{name}", self._step, f"the TAK connection {name!r} does not go on"
        )

    # ---- from other threads

    def delta(self, delta: Delta) -> None:
        self._mailbox.put_delta(delta)
        self._wake()

    def reset(self, snapshot: Snapshot) -> None:
        self._mailbox.put_picture(snapshot)
        self._wake()

    def project(self, projection: Projection) -> None:
        """Nothing: emergencies are made of the alarms that consoles are shown."""

    def start(self) -> None:
        self._worker.start()

    def close(self) -> None:
        self._worker.stop()
        self._wake()
        self._worker.join(_CLOSE_S)

    def view(self) -> ForwarderView:
        status = self._status
        text = status.reason if status.state == "connecting" else self._outbox.hint
        return ForwarderView(
            name=self._name,
            kind="tak",
            address=self._config.url,
            state=status.state,
            since_ms=to_ms_or_none(status.since_ns),
            sent=status.sent,
            received=self._inbox.taken,
            refused=self._inbox.refused,
            text=str(text),
            text_code=text_code_view_or_none(code_of_text(text)),
        )

    def problem(self) -> str:
        away_s = self._status.away_s
        if away_s < self._config.alarm_after_s:
            return ""
        return coded(
            "tak-away",
            "The TAK connection {name!r} ({url}) has been away for {away_s:.0f} s: it {reason}",
            name=self._name,
            url=self._config.url,
            away_s=away_s,
            reason=self._status.reason or NO_ANSWER,
        )

    def _wake(self) -> None:
        loop, awake = self._loop, self._awake
        if loop is None or awake is None:
            return
        try:
            loop.call_soon_threadsafe(awake.set)
        except RuntimeError:  # the connection has ended meanwhile
            return

    # ---- in the forwarder's thread

    def _step(self) -> float:
        """One connection from beginning to end; gives the pause before the next one."""
        if not self._leads():
            self._status.set("standby")
            return _STANDBY_S
        if self._status.state == "standby":
            self._status.set("connecting")
        try:
            asyncio.run(self._connect_and_serve())
        except ConnectionLostError as error:
            self._status.set("connecting", text_of_error(error))
        else:
            return 0.0  # another one leads, or the station stops
        pause_s, self._retry_s = self._retry_s, min(2.0 * self._retry_s, _RETRY_MAX_S)
        return pause_s

    async def _connect_and_serve(self) -> None:
        """Raises ConnectionLostError when the connection is over."""
        connection = await open_connection(self._config)
        self._loop, self._awake = asyncio.get_running_loop(), asyncio.Event()
        self._last_received_ns = None
        self._outbox.begin_connection()
        self._inbox.begin_connection()
        self._status.set("connected")
        receiving = asyncio.create_task(self._receive(connection))
        sending = asyncio.create_task(self._send(connection))
        try:
            await asyncio.wait((receiving, sending), return_when=asyncio.FIRST_COMPLETED)
        finally:
            self._loop = self._awake = None
            over = [task for task in (sending, receiving) if task.done()]
            for task in (receiving, sending):
                task.cancel()
            await asyncio.gather(receiving, sending, return_exceptions=True)
            connection.close()
        for task in over:
            task.result()

    async def _send(self, connection: TakConnection) -> None:
        """Until the station stops or leaves the lead to another one."""
        assert self._awake is not None
        clock, ping_ns = self._clock, self._clock.monotonic_ns() + _PING_NS
        while self._leads() and not self._worker.stopping.is_set():
            self._awake.clear()
            now_ns, now_ms = clock.monotonic_ns(), to_ms(clock.utc_ns())
            self._outbox.apply(self._mailbox.take(), now_ms)
            self._inbox.deliver_due(now_ns)
            if now_ns >= ping_ns:
                ping_ns = now_ns + _PING_NS
                await self._ping(connection, now_ms)
            for events in in_batches(self._outbox.due(now_ns, now_ms)):
                await connection.send(events)
                self._status.sent += len(events)
                if self._awake.is_set():  # an emergency may have come: it goes first
                    break
            else:
                await self._wait(self._outbox.next_due_ns(now_ns) - now_ns)

    async def _wait(self, duration_ns: int) -> None:
        assert self._awake is not None
        try:
            await asyncio.wait_for(self._awake.wait(), min(duration_ns / NS_PER_S, 1.0))
        except TimeoutError:
            return

    async def _ping(self, connection: TakConnection, now_ms: int) -> None:
        """Ask a server whether it is there; a connection that has lasted so long works."""
        self._retry_s = _FIRST_RETRY_S
        if self._config.is_datagram or self._outbox.anchor is None:
            return
        last_ns = self._last_received_ns
        if last_ns is not None and self._clock.monotonic_ns() - last_ns > _SILENT_NS:
            raise ConnectionLostError(coded("tak-silent", "does not answer any more"))
        await connection.send([self._events.ping(self._outbox.anchor, now_ms)])

    async def _receive(self, connection: TakConnection) -> None:
        while True:
            data = await connection.receive()
            self._last_received_ns = self._clock.monotonic_ns()
            if self._config.receive and self._leads():
                self._inbox.push(data, self._outbox.anchor, self._clock.utc_ns())
