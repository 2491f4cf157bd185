"""Writer of the journal: a thread that waits for the disk.

Who gives messages waits with it, but not for long: a disk that refuses or hangs, as worn cards
do, costs the unit its journal and not its link.  What the disk has not taken waits in memory and
is written when it does.
"""

from __future__ import annotations

import logging
import time
from collections import deque
from collections.abc import Iterable
from threading import Condition

from edge.storage.disk_watchdog import HANGS_S, DiskWatchdog
from edge.storage.journal.journal import Journal, JournalRow
from shared.channels import Qos
from shared.coded_text import coded, text_of_error
from shared.errors import StoreError
from shared.worker import UNTIL_WOKEN, Worker

logger = logging.getLogger(__name__)

_WRITE_TIMEOUT_S = 1.0  # of who gives messages
_RETRY_S = 1.0  # after a refusal: offering all of them at every message takes half a processor
_UNSAVED_MAX = 10_000  # and as many alerts, which nothing else ousts


class JournalWriter:
    """Writer; ``write`` is for one thread; it never raises, and waits a second at most."""

    def __init__(self, journal: Journal) -> None:
        self._journal = journal
        self._changed = Condition()
        self._alerts = _Unsaved()
        self._others = _Unsaved()
        self._disk = DiskWatchdog()
        self._refusal: str | None = None
        self._retry_due_s = 0.0  # after a refusal
        self._worker = Worker(
            "journal", self._step, "the journal is not written", at_end=self._offer_all
        )
        self._worker.start()

    @property
    def is_working(self) -> bool:
        return self._worker.is_working

    @property
    def fault(self) -> str | None:
        """Reason that the journal cannot be written; None while it can."""
        if self._disk.hangs and self._refusal is None:
            return coded(
                "journal-hangs",
                "the journal hangs: the disk has not answered for {silent_s:.0f} s",
                silent_s=HANGS_S,
            )
        return self._refusal

    @property
    def never_saved(self) -> int:
        """Messages that were given and are not kept."""
        return self._alerts.dropped + self._others.dropped

    def write(self, messages: Iterable[JournalRow]) -> None:
        """Write; return when they are on the disk, or after a second at most."""
        with self._changed:
            for message in messages:
                alert = message.channel.qos is Qos.ALERT
                (self._alerts if alert else self._others).add(message)
            self._worker.wake()
            if self._disk.waiting_s < _WRITE_TIMEOUT_S:
                self._changed.wait_for(self._is_answered, _WRITE_TIMEOUT_S)

    def close(self) -> None:
        """Offer the disk what is left; one that hangs may still take it until the process ends."""
        self._worker.stop()
        if not self._disk.join(self._worker):
            logger.error(
                "the journal hangs: its last %d messages are not kept; "
                "the station has them if it was linked",
                len(self._alerts.messages) + len(self._others.messages),
            )

    def _is_answered(self) -> bool:
        return self._refusal is not None or not (self._alerts.messages or self._others.messages)

    def _step(self) -> float:
        """Offer what waits, after a refusal once a second."""
        pause_s = self._retry_due_s - time.monotonic()
        if pause_s <= 0.0:
            self._offer_all()
            pause_s = _RETRY_S if self._refusal is not None else UNTIL_WOKEN
            self._retry_due_s = time.monotonic() + (0.0 if self._refusal is None else _RETRY_S)
        return pause_s

    def _offer_all(self) -> None:
        with self._changed:
            offered = [*self._alerts.take(), *self._others.take()]
        if not offered:
            return
        refusal = self._append(offered)
        with self._changed:
            self._log_change(refusal)
            self._refusal = refusal
            for unsaved in (self._alerts, self._others):
                unsaved.resolve(saved=refusal is None)
            self._changed.notify_all()

    def _append(self, messages: list[JournalRow]) -> str | None:
        """Return why the disk refuses; None: the messages are on it."""
        try:
            with self._disk.request():
                self._journal.append(messages)
        except StoreError as error:
            return text_of_error(error)
        return None

    def _log_change(self, refusal: str | None) -> None:
        if refusal is not None and self._refusal is None:
            logger.error("%s; messages are sent but not kept", refusal)
        if refusal is None and self._refusal is not None:
            logger.warning(
                "the journal can be written again; "
                "%d messages were sent and not kept since the start",
                self.never_saved,
            )


class _Unsaved:
    """Messages that are not on the disk, the oldest first; offered ones are not dropped."""

    def __init__(self) -> None:
        self.messages: deque[JournalRow] = deque()
        self.dropped = 0
        self._offered = 0

    def add(self, message: JournalRow) -> None:
        self.messages.append(message)
        self._drop_oldest()

    def take(self) -> list[JournalRow]:
        self._offered = len(self.messages)
        return list(self.messages)

    def resolve(self, *, saved: bool) -> None:
        """Remove the offered messages if the disk has taken them."""
        if saved:
            for _ in range(self._offered):
                self.messages.popleft()
        self._offered = 0
        self._drop_oldest()

    def _drop_oldest(self) -> None:
        while len(self.messages) - self._offered > _UNSAVED_MAX:
            del self.messages[self._offered]
            self.dropped += 1
