"""Health monitor: reports a part that fails once, until it works steadily again."""

from __future__ import annotations

import logging
import re
from collections.abc import Iterator, Mapping
from contextlib import contextmanager

from shared.coded_text import coded
from shared.messages.station import ReportProblem

WELL_AFTER = 5  # checks in a row without a problem, one a second
_NUMBER = re.compile(r"\d+")
_REPORTED_PARTS = (
    "drive",
    "pipeline",
    "bus",
    "checkpoint",
    "console recorder",
)  # by ``report`` and ``report_bug``
log = logging.getLogger(__name__)


class HealthMonitor:
    """Monitor that turns present problems into reports of changes."""

    def __init__(self) -> None:
        self._failed: dict[str, str] = {}  # problems since the last check, by part
        self._quiet: dict[str, int] = {}  # checks without a problem, of parts that had one
        self._logged: dict[str, set[type[Exception]]] = {}  # by part, until it is well

    def report(self, part: str, text: str) -> None:
        """Report a momentary failure, which a later check would not find."""
        self._failed[part] = text

    @contextmanager
    def guard(self, part: str) -> Iterator[None]:
        """Catch and report errors, so that a bug in one event does not end the station."""
        try:
            yield
        except Exception as error:  # noqa: BLE001  # reported, and the station continues
            self.report_bug(part, error)

    def report_bug(self, part: str, error: Exception) -> None:
        """Report a bug in the program; one that occurs again is logged once."""
        kinds = self._logged.setdefault(part, set())
        if type(error) not in kinds:
            kinds.add(type(error))
            log.error("the station's %s failed", part, exc_info=error)
        text = coded(
            "part-failed",
            "The station's {part} failed: {error}; please report it",
            part=part,
            error=repr(error),
        )
        self.report(part, text)

    def check(self, seen: Mapping[str, str], known: Mapping[str, str]) -> Iterator[ReportProblem]:
        """Compare present problems with those that were reported.  ``seen``: present problems by
        part, empty for a part without one; ``known``: reported problems, perhaps by an earlier run
        of the program.  Parts with a monitor of their own are left out.
        """
        now = {**dict.fromkeys(_REPORTED_PARTS, ""), **seen, **self._failed}
        self._failed = {}
        for part, text in now.items():
            if text:
                self._quiet[part] = 0
                if part not in known or (
                    part in seen and _without_numbers(text) != _without_numbers(known[part])
                ):
                    yield ReportProblem.of(part, text)
            elif part in known:
                self._quiet.setdefault(part, 0)
        for part in [part for part in self._quiet if not now.get(part)]:
            self._quiet[part] += 1
            if self._quiet[part] >= WELL_AFTER:
                del self._quiet[part]
                self._logged.pop(part, None)
                if part in known:
                    yield ReportProblem(part, "")


def _without_numbers(text: str) -> str:
    """Return the text without its counts, so that a new count alone is not a new problem."""
    return _NUMBER.sub("", text)
