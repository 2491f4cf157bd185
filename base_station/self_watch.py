"""Which parts of the station fail, told once: a part that stutters is not well in between."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from shared.messages.station import ReportProblem

WELL_AFTER = 5  # checks in a row without a problem, one a second


class SelfWatch:
    """Turns what is wrong now into reports of what has changed."""

    def __init__(self) -> None:
        self._quiet: dict[str, int] = {}  # checks without a problem, of parts that had one

    def check(self, now: Mapping[str, str], known: Mapping[str, str]) -> Iterator[ReportProblem]:
        """``now``: what is wrong, by part, empty where nothing is; ``known``: what has been
        reported.  A part that had never failed in this run, and is reported by others, is left
        to them.
        """
        for part, text in now.items():
            if text:
                self._quiet[part] = 0
                if part not in known:
                    yield ReportProblem(part, text)
            elif part in known:
                self._quiet.setdefault(part, 0)
        for part in [part for part in self._quiet if not now.get(part)]:
            self._quiet[part] += 1
            if self._quiet[part] >= WELL_AFTER:
                del self._quiet[part]
                if part in known:
                    yield ReportProblem(part, "")
