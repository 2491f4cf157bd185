"""Set of sequence numbers, kept as runs.

Messages come nearly in order, so a long history is a handful of runs.
"""

from __future__ import annotations

from bisect import bisect_left, bisect_right
from collections.abc import Iterator
from typing import NamedTuple

import msgspec


class Run(NamedTuple):
    """Consecutive numbers; both ends belong to it."""

    first: int
    last: int


class SequenceSet(msgspec.Struct, array_like=True):
    """Sorted, disjoint and never adjacent runs."""

    firsts: list[int] = msgspec.field(default_factory=list)
    lasts: list[int] = msgspec.field(default_factory=list)

    def __contains__(self, number: int) -> bool:
        if not self.lasts or number > self.lasts[-1]:  # nearly always
            return False
        place = bisect_right(self.firsts, number) - 1
        return place >= 0 and number <= self.lasts[place]

    def add(self, number: int) -> bool:
        """True where the number was not there yet."""
        if self.lasts and number == self.lasts[-1] + 1:  # nearly always
            self.lasts[-1] = number
            return True
        place = bisect_right(self.firsts, number)
        if place and number <= self.lasts[place - 1]:
            return False
        joins_left = place > 0 and self.lasts[place - 1] == number - 1
        joins_right = place < len(self.firsts) and self.firsts[place] == number + 1
        if joins_left and joins_right:
            self.lasts[place - 1] = self.lasts.pop(place)
            del self.firsts[place]
        elif joins_left:
            self.lasts[place - 1] = number
        elif joins_right:
            self.firsts[place] = number
        else:
            self.firsts.insert(place, number)
            self.lasts.insert(place, number)
        return True

    def add_run(self, run: Run) -> None:
        """Add all numbers of a run at once."""
        begin = bisect_left(self.lasts, run.first - 1)
        end = bisect_right(self.firsts, run.last + 1)
        if begin < end:
            run = Run(min(run.first, self.firsts[begin]), max(run.last, self.lasts[end - 1]))
        self.firsts[begin:end] = [run.first]
        self.lasts[begin:end] = [run.last]

    def discard(self, number: int) -> None:
        """It is not there, whether it was or not."""
        place = bisect_right(self.firsts, number) - 1
        if place < 0 or number > self.lasts[place]:
            return
        first, last = self.firsts[place], self.lasts[place]
        halves = [
            run for run in (Run(first, number - 1), Run(number + 1, last)) if run[0] <= run[1]
        ]
        self.firsts[place : place + 1] = [run.first for run in halves]
        self.lasts[place : place + 1] = [run.last for run in halves]

    def runs(self) -> Iterator[Run]:
        return map(Run, self.firsts, self.lasts)

    def missing(self, first: int, last: int) -> Iterator[Run]:
        """The runs between ``first`` and ``last``, both included, that are not there."""
        for run in self.runs():
            if run.last < first:
                continue
            if run.first > last:
                break
            if first < run.first:
                yield Run(first, run.first - 1)
            first = run.last + 1
        if first <= last:
            yield Run(first, last)

    def newest_missing(self, first: int, last: int) -> Run | None:
        """The last of the runs that ``missing`` gives, however many there are."""
        place = bisect_right(self.firsts, last) - 1
        if place >= 0 and self.lasts[place] >= last:
            last = self.firsts[place] - 1
            place -= 1
        if last < first:
            return None
        return Run(max(first, self.lasts[place] + 1) if place >= 0 else first, last)

    def complete_to(self, first: int) -> int:
        """The last number up to which nothing is missing from ``first`` on; ``first - 1``: none."""
        place = bisect_right(self.firsts, first) - 1
        if place < 0 or self.lasts[place] < first:
            return first - 1
        return self.lasts[place]
