"""Log of a failure that recurs at every try: one line when it begins, and one when it is over."""

from __future__ import annotations

import logging
from types import TracebackType

from shared.errors import MusterError


class LogOnChange:
    """Context manager of one try; it suppresses failures of disk, bus and files, and logs them."""

    def __init__(self, log: logging.Logger, failing: str) -> None:
        """``failing``: sentence that is true while tries fail, without its cause."""
        self._log = log
        self._failing = failing
        self.fault = ""  # cause of the last failure, until a try succeeds

    def __enter__(self) -> None:
        pass

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> bool:
        if error is None:
            self.note_success()
        elif isinstance(error, (MusterError, OSError)):
            self.note_failure(error)
            return True
        return False

    def note_success(self) -> None:
        if self.fault:
            self._log.warning("over: %s", self._failing)
            self.fault = ""

    def note_failure(self, error: Exception) -> None:
        """Log the failure where it is a new one; an error of this program with its traceback."""
        is_expected = isinstance(error, (MusterError, OSError))
        fault = str(error) if is_expected else f"{type(error).__name__}: {error}"
        if fault == self.fault:
            return
        self.fault = fault
        if is_expected:
            self._log.warning("%s: %s", self._failing, fault)
        else:
            self._log.error("%s", self._failing, exc_info=error)
