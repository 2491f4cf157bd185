"""Detector of messages that the log has lost: its disk returns other bytes than were written, or
lacks a file.  All messages that the saved state contains must be in the log.  Those that are not
count as missing again, and are fetched from the units' journals like those that the radio lost.
"""

from __future__ import annotations

import logging
from collections import defaultdict
from collections.abc import Callable, Collection, Generator, Hashable, Iterable, Iterator, Mapping

from base_station.core.events import number_in
from base_station.core.state import StationState
from base_station.storage.checkpoints import SavedState
from shared.clock import Clock
from shared.errors import LogError
from shared.mcap_log import LogRecord
from shared.sequence_set import Run, SequenceSet

_log = logging.getLogger(__name__)

_TURN_NS = 300_000_000  # of reading at a time, so that a long log delays nothing

Lost = Mapping[tuple[str, int], tuple[Run, ...]]  # by sender and run of its program
_Numbers = defaultdict[tuple[str, int], SequenceSet]


class LogGapDetector:
    """``look`` now and then, from one thread."""

    def __init__(
        self,
        damaged: Callable[[], Collection[Hashable]],
        saved_after: Callable[[int], SavedState | None],
        records: Callable[[], Iterable[LogRecord]],
        clock: Clock,
        take_back: Callable[[Lost], None],
    ) -> None:
        """``damaged`` names the parts of the log that are known not to be what they were;
        ``saved_after`` gives a state of the station that was saved after a time, all of which had
        come to the log before.
        """
        self._damaged = damaged
        self._saved_after = saved_after
        self._records = records
        self._clock = clock
        self._take_back = take_back
        self._search = self._searches()

    def search_further(self) -> None:
        """Continue the search for a moment."""
        next(self._search)

    def _searches(self) -> Iterator[None]:
        """Search once for each new damage."""
        known: set[Hashable] = set()
        while True:
            new = set(self._damaged()) - known
            if not new:
                yield
                continue
            noticed_ns = self._clock.utc_ns()
            while (saved := self._saved_after(noticed_ns)) is None:
                yield
            try:
                logged = yield from self._numbers_in_log()
            except LogError as error:  # a file went while it was read
                _log.warning("what the log lacks is looked for again: %s", error)
                yield
                continue
            known |= new
            lost = _lacking(saved.pipeline.state, logged)
            if lost:
                count = sum(run.last - run.first + 1 for runs in lost.values() for run in runs)
                _log.warning("the log lacks %d messages that came: their units are asked", count)
                self._take_back(lost)

    def _numbers_in_log(self) -> Generator[None, None, _Numbers]:
        numbers: _Numbers = defaultdict(SequenceSet)
        turn_ends_ns = self._clock.monotonic_ns() + _TURN_NS
        for _, key, payload in self._records():
            number = number_in(key, payload)
            if number is not None:
                sender, boot_id, seq = number
                numbers[sender, boot_id].add(seq)
            if self._clock.monotonic_ns() > turn_ends_ns:
                yield
                turn_ends_ns = self._clock.monotonic_ns() + _TURN_NS
        return numbers


def _lacking(state: StationState, logged: _Numbers) -> Lost:
    seen = {
        (sender.unit_id, boot.boot_id): boot.seen
        for unit in state.units.values()
        for sender in (unit, unit.tracker)
        if sender is not None
        for boot in sender.boots
    }
    lacking = {
        name: tuple(hole for run in numbers.runs() for hole in logged[name].missing(*run))
        for name, numbers in seen.items()
    }
    return {name: runs for name, runs in lacking.items() if runs}
