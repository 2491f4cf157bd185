"""A trouble that comes again at every try is logged once, and once that it is over."""

from __future__ import annotations

import logging
from types import TracebackType

from shared.errors import MusterError


class RecurringTrouble:
    """Entered at every try; what the disk, the bus or a file did not do does not leave it."""

    def __init__(self, log: logging.Logger, what: str) -> None:
        """``what`` is so while it lasts: a sentence without its cause."""
        self._log = log
        self._what = what
        self._told = ""

    def __enter__(self) -> None:
        pass

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> bool:
        if error is None and self._told:
            self._log.warning("over: %s", self._what)
            self._told = ""
        if not isinstance(error, (MusterError, OSError)):
            return False
        if str(error) != self._told:
            self._log.warning("%s: %s", self._what, error)
            self._told = str(error)
        return True
