"""Announcement on the network that is begun, replaced and withdrawn as its content changes."""

from __future__ import annotations

import logging
from collections.abc import Callable
from typing import Self

from shared.discovery import Announcement, Announcer, ConsoleAnnouncement
from shared.log_on_change import LogOnChange

AnyAnnouncement = Announcement | ConsoleAnnouncement


class ServiceAnnouncement:
    """Announcement; as a context manager it withdraws the announcement at the end."""

    def __init__(self, log: logging.Logger, failing: str) -> None:
        """``failing``: sentence for the log about a failing announcement, without the cause."""
        self._fault_log = LogOnChange(log, failing)
        self._announced: AnyAnnouncement | None = None
        self._announcer: Announcer | None = None

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self._withdraw()

    @property
    def fault(self) -> str:
        """Reason of the last failure; empty if the last attempt succeeded."""
        return self._fault_log.fault

    def keep(
        self, wanted: Callable[[], AnyAnnouncement], interfaces: Callable[[], tuple[str, ...]]
    ) -> None:
        """Announce the present content; after a failure the next call tries again."""
        with self._fault_log:
            now = wanted()
            if now == self._announced:
                return
            self._withdraw()
            if now.addresses:
                self._announcer = Announcer(now, interfaces())
            self._announced = now

    def _withdraw(self) -> None:
        announcer, self._announcer, self._announced = self._announcer, None, None
        if announcer is not None:
            announcer.close()
