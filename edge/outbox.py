"""Sends what a unit has to say: into the journal first, then on the air.

A thread of its own, because a disk may take its time to say that bytes are safe.  Messages
that wait together are committed together, at most every tenth of a second; an alert waits
for nobody.
"""

from __future__ import annotations

import logging
import time
from collections import deque
from collections.abc import Callable, Iterable
from queue import Empty, SimpleQueue
from threading import Event, Thread

from edge.spool import Journaled, Spool
from shared.channels import Qos, channel_of
from shared.codec import encode
from shared.errors import StoreError
from shared.messages import Message

logger = logging.getLogger(__name__)

_GROUP_S = 0.1
_UNSAVED_KEPT = 10_000  # while the disk refuses
_AGAIN_S = 1.0  # after a refusal: offering all of them at every message takes half a processor

Publish = Callable[[str, bytes, Qos], None]


class Outbox:
    """Keeps the order in which ``put`` was called; ``put`` never waits."""

    def __init__(self, unit_id: str, spool: Spool, publish: Publish) -> None:
        self._unit_id = unit_id
        self._spool = spool
        self._publish = publish
        self._waiting: SimpleQueue[Message | None] = SimpleQueue()
        self._unsaved: deque[Journaled] = deque(maxlen=_UNSAVED_KEPT)
        self._unsaved_alerts: deque[Journaled] = deque(maxlen=_UNSAVED_KEPT)  # nothing ousts them
        self._storage_fault: str | None = None
        self._refused_s = 0.0  # when the disk last did
        self._bus_fails = False
        self._urgent = Event()
        self._closed = False
        self.never_saved = 0  # messages that were sent but could not be written
        self._thread = Thread(target=self._run, name="outbox", daemon=True)
        self._thread.start()

    @property
    def is_working(self) -> bool:
        return self._thread.is_alive()

    @property
    def storage_fault(self) -> str | None:
        """Why the journal cannot be written; None while it can."""
        return self._storage_fault

    def put(self, messages: Iterable[Message]) -> None:
        urgent = False
        for message in messages:
            self._waiting.put(message)
            urgent = urgent or channel_of(message).qos is Qos.ALERT
        if urgent:
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
            self._save(group)
            self._send(group)

    def _drain(self, first: Message | None) -> list[Journaled]:
        group = []
        message = first
        try:
            while True:
                if message is None:
                    self._closed = True
                else:
                    group += _journaled(message)
                message = self._waiting.get_nowait()
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

    def _save(self, group: list[Journaled]) -> None:
        """A refusal stops nothing: the messages are sent, and written when the disk allows."""
        for message in group:
            is_alert = message.channel.qos is Qos.ALERT
            unsaved = self._unsaved_alerts if is_alert else self._unsaved
            self.never_saved += len(unsaved) == _UNSAVED_KEPT
            unsaved.append(message)
        if self._is_to_be_spared():
            return
        waiting = [*self._unsaved_alerts, *self._unsaved]
        if not waiting:
            return
        try:
            self._spool.append(waiting)
        except StoreError as error:
            if self._storage_fault is None:
                logger.error("%s; messages are sent but not kept", error)
            self._storage_fault = str(error)
            self._refused_s = time.monotonic()
        else:
            if self._storage_fault is not None:
                logger.warning(
                    "the journal can be written again; "
                    "%d messages were sent and not kept since the start",
                    self.never_saved,
                )
            self._storage_fault = None
            self._unsaved.clear()
            self._unsaved_alerts.clear()

    def _is_to_be_spared(self) -> bool:
        """Whether the disk has just refused; at the end it is asked all the same."""
        refuses = self._storage_fault is not None and not self._closed
        return refuses and time.monotonic() < self._refused_s + _AGAIN_S


def _journaled(message: Message) -> list[Journaled]:
    """What cannot be put into bytes is left out: it is not to cost the alert behind it."""
    header, channel = message.header, channel_of(message)
    try:
        return [Journaled(header.seq, channel, header.t_utc_ns, encode(message))]
    except ValueError:
        logger.exception("a %s message cannot be sent", channel.name)
        return []
