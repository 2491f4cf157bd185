"""Sends what a unit has to say: into the journal first, then on the air.

A thread of its own, because a disk may take its time to say that bytes are safe.  Messages
that wait together are committed together, at most every tenth of a second; an alert waits
for nobody.  What is put at once is committed at once: after a sudden end all of it is there or
none.
"""

from __future__ import annotations

import logging
import time
from collections.abc import Callable, Iterable
from queue import Empty, SimpleQueue
from threading import Event, Thread

from edge.journal.spool import Journaled
from edge.journal.writer import JournalWriter
from shared.channels import Qos, channel_of
from shared.codec import encode
from shared.messages import Message

logger = logging.getLogger(__name__)

_GROUP_S = 0.1

Publish = Callable[[str, bytes, Qos], None]


class Outbox:
    """Keeps the order in which ``put`` was called; ``put`` never waits."""

    def __init__(self, unit_id: str, journal: JournalWriter, publish: Publish) -> None:
        self._unit_id = unit_id
        self._journal = journal
        self._publish = publish
        self._waiting: SimpleQueue[tuple[Message, ...] | None] = SimpleQueue()
        self._bus_fails = False
        self._urgent = Event()
        self._closed = False
        self._thread = Thread(target=self._run, name="outbox", daemon=True)
        self._thread.start()

    @property
    def is_working(self) -> bool:
        return self._thread.is_alive()

    def put(self, messages: Iterable[Message]) -> None:
        together = tuple(messages)
        self._waiting.put(together)
        if any(channel_of(message).qos is Qos.ALERT for message in together):
            self._urgent.set()

    def close(self) -> None:
        """Send everything that was put, then stop."""
        self._waiting.put(None)
        self._urgent.set()
        self._thread.join()

    def _run(self) -> None:
        last_commit_s = -_GROUP_S
        while not self._closed:
            first = self._waiting.get()
            self._urgent.wait(max(0.0, last_commit_s + _GROUP_S - time.monotonic()))
            self._urgent.clear()
            group = self._drain(first)
            last_commit_s = time.monotonic()
            self._journal.write(group)
            self._send(group)

    def _drain(self, first: tuple[Message, ...] | None) -> list[Journaled]:
        group = []
        together = first
        try:
            while True:
                if together is None:
                    self._closed = True
                else:
                    group += [kept for message in together for kept in _journaled(message)]
                together = self._waiting.get_nowait()
        except Empty:
            return group

    def _send(self, group: list[Journaled]) -> None:
        """A bus that fails ends nothing: the link opens it anew, and the journal has the rest."""
        for each in group:
            try:
                self._publish(each.channel.key(self._unit_id), each.payload, each.channel.qos)
            except Exception:
                if not self._bus_fails:
                    logger.exception("messages cannot be sent; the journal keeps them")
                self._bus_fails = True
            else:
                self._bus_fails = False


def _journaled(message: Message) -> list[Journaled]:
    """What cannot be put into bytes is left out: it is not to cost the alert behind it."""
    header, channel = message.header, channel_of(message)
    try:
        return [Journaled(header.seq, channel, header.t_utc_ns, encode(message))]
    except ValueError:
        logger.exception("a %s message cannot be sent", channel.name)
        return []
