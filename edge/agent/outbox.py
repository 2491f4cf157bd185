"""Outbox of a unit: messages go into the journal first, then on the air.

A thread of its own, because a disk may be slow to confirm a write.  Messages that wait together are
committed together, at most every tenth of a second; an alert is committed immediately.  Messages of
one call are one transaction: after a crash all of them are in the journal or none.
"""

from __future__ import annotations

import logging
import time
from collections.abc import Callable, Iterable
from queue import Empty, SimpleQueue
from threading import Event

from edge.storage.journal.journal import JournalRow
from edge.storage.journal.writer import JournalWriter
from shared.channels import Qos, channel_of
from shared.codec import encode
from shared.messages import Message
from shared.worker import Worker

logger = logging.getLogger(__name__)

_GROUP_S = 0.1

Publish = Callable[[str, bytes, Qos], None]


class Outbox:
    """Queue that keeps the order in which ``put`` was called; ``put`` never waits."""

    def __init__(self, unit_id: str, journal_writer: JournalWriter, publish: Publish) -> None:
        self._unit_id = unit_id
        self._journal_writer = journal_writer
        self._publish = publish
        self._waiting: SimpleQueue[tuple[Message, ...] | None] = SimpleQueue()
        self._bus_fails = False
        self._urgent = Event()
        self._last_commit_s = -_GROUP_S
        self._worker = Worker(
            "outbox", self._send_group, "messages are neither kept nor sent", retry_s=0.0
        )
        self._worker.start()

    @property
    def is_working(self) -> bool:
        return self._worker.is_working

    def put(self, messages: Iterable[Message]) -> None:
        together = tuple(messages)
        self._waiting.put(together)
        if any(channel_of(message).qos is Qos.ALERT for message in together):
            self._urgent.set()

    def close(self) -> None:
        """Send all queued messages, then stop."""
        self._waiting.put(None)
        self._urgent.set()
        self._worker.join()

    def _send_group(self) -> float:
        """Commit and send the waiting messages together."""
        first = self._waiting.get()
        self._urgent.wait(max(0.0, self._last_commit_s + _GROUP_S - time.monotonic()))
        self._urgent.clear()
        group = self._drain(first)
        self._last_commit_s = time.monotonic()
        self._journal_writer.write(group)
        self._send(group)
        return 0.0

    def _drain(self, first: tuple[Message, ...] | None) -> list[JournalRow]:
        group = []
        together = first
        try:
            while True:
                if together is None:
                    self._worker.stop()
                else:
                    group += [kept for message in together for kept in _journal_rows(message)]
                together = self._waiting.get_nowait()
        except Empty:
            return group

    def _send(self, group: list[JournalRow]) -> None:
        """Send a message.  A bus that fails is reopened by the link, and the journal keeps the
        message.
        """
        for each in group:
            try:
                self._publish(each.channel.key(self._unit_id), each.payload, each.channel.qos)
            except Exception:
                if not self._bus_fails:
                    logger.exception("messages cannot be sent; the journal keeps them")
                self._bus_fails = True
            else:
                self._bus_fails = False


def _journal_rows(message: Message) -> list[JournalRow]:
    """Return the row of a message; where it cannot be encoded, log that and return none."""
    header, channel = message.header, channel_of(message)
    try:
        return [JournalRow(header.seq, channel, header.t_utc_ns, encode(message))]
    except ValueError:
        logger.exception("a %s message cannot be sent", channel.name)
        return []
