"""Writes what a unit says into its journal, by a thread that waits for the disk.

Who gives messages waits with it, but not for long: a disk that refuses or hangs, as worn cards
do, costs the unit its journal and not its link.  What the disk has not taken waits in memory and
is written when it does.
"""

from __future__ import annotations

import logging
from collections import deque
from collections.abc import Iterable
from threading import Condition, Thread

from edge.disk_watch import HANGS_S, DiskWatch
from edge.journal.spool import Journaled, Spool
from shared.channels import Qos
from shared.errors import StoreError

logger = logging.getLogger(__name__)

_PATIENCE_S = 1.0  # of who gives messages
_AGAIN_S = 1.0  # after a refusal: offering all of them at every message takes half a processor
_UNSAVED_KEPT = 10_000  # and as many alerts, which nothing else ousts


class JournalWriter:
    """``write`` is for one thread; it never raises, and waits a second at most."""

    def __init__(self, spool: Spool) -> None:
        self._spool = spool
        self._changed = Condition()
        self._alerts = _Unsaved()
        self._others = _Unsaved()
        self._disk = DiskWatch()
        self._refusal: str | None = None
        self._closed = False
        self._thread = Thread(target=self._run, name="journal", daemon=True)
        self._thread.start()

    @property
    def is_working(self) -> bool:
        return self._thread.is_alive()

    @property
    def fault(self) -> str | None:
        """Why the journal cannot be written; None while it can."""
        if self._disk.hangs and self._refusal is None:
            return f"the journal hangs: the disk has not answered for {HANGS_S:.0f} s"
        return self._refusal

    @property
    def never_saved(self) -> int:
        """Messages that were given and are not kept."""
        return self._alerts.ousted + self._others.ousted

    def write(self, messages: Iterable[Journaled]) -> None:
        """Returns when they are on the disk, or when it is not to be waited for any longer."""
        with self._changed:
            for message in messages:
                alert = message.channel.qos is Qos.ALERT
                (self._alerts if alert else self._others).add(message)
            self._changed.notify_all()
            if self._disk.owed_for_s < _PATIENCE_S:
                self._changed.wait_for(self._is_answered, _PATIENCE_S)

    def close(self) -> None:
        """Offers the disk what is left; one that hangs may still take it until the process ends."""
        with self._changed:
            self._closed = True
            self._changed.notify_all()
        if not self._disk.join(self._thread):
            logger.error(
                "the journal hangs: its last %d messages are not kept; "
                "the station has them if it was linked",
                len(self._alerts.messages) + len(self._others.messages),
            )

    def _is_answered(self) -> bool:
        return self._refusal is not None or not (self._alerts.messages or self._others.messages)

    def _run(self) -> None:
        while True:
            with self._changed:
                if self._refusal is not None:
                    self._changed.wait_for(lambda: self._closed, _AGAIN_S)
                self._changed.wait_for(
                    lambda: self._closed or self._alerts.messages or self._others.messages
                )
                ends = self._closed
                offered = [*self._alerts.take(), *self._others.take()]
                self._disk.asked()
            self._offer(offered)
            if ends:
                return

    def _offer(self, messages: list[Journaled]) -> None:
        refusal = None
        try:
            if messages:
                self._spool.append(messages)
        except StoreError as error:
            refusal = str(error)
        with self._changed:
            self._tell(refusal)
            self._refusal = refusal
            self._disk.answered()
            for unsaved in (self._alerts, self._others):
                unsaved.settle(saved=refusal is None)
            self._changed.notify_all()

    def _tell(self, refusal: str | None) -> None:
        if refusal is not None and self._refusal is None:
            logger.error("%s; messages are sent but not kept", refusal)
        if refusal is None and self._refusal is not None:
            logger.warning(
                "the journal can be written again; "
                "%d messages were sent and not kept since the start",
                self.never_saved,
            )


class _Unsaved:
    """What is not on the disk, the oldest first; what it has been offered is not ousted."""

    def __init__(self) -> None:
        self.messages: deque[Journaled] = deque()
        self.ousted = 0
        self._offered = 0

    def add(self, message: Journaled) -> None:
        self.messages.append(message)
        self._oust()

    def take(self) -> list[Journaled]:
        self._offered = len(self.messages)
        return list(self.messages)

    def settle(self, *, saved: bool) -> None:
        """The disk has taken what it was offered, or has refused it."""
        if saved:
            for _ in range(self._offered):
                self.messages.popleft()
        self._offered = 0
        self._oust()

    def _oust(self) -> None:
        while len(self.messages) - self._offered > _UNSAVED_KEPT:
            del self.messages[self._offered]
            self.ousted += 1
