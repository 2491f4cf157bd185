"""Downsampling of a series for a screen, so that peaks and gaps stay.

A span is cut into buckets of equal length.  Of each, the least and the greatest value are kept with
their times: a line through them covers the same points of the screen as one through all values.
"""

from __future__ import annotations

from itertools import pairwise

import msgspec

from shared.clock import NS_PER_MS

_DIGITS = 3  # behind the point: finer than any measurement


class Column(msgspec.Struct, frozen=True):
    """A series for a chart, by time.  None between two values: nothing is known there."""

    t_ms: tuple[int, ...] = ()  # station time, milliseconds since 1970
    values: tuple[float | None, ...] = ()


class _Bucket:
    __slots__ = ("first_ns", "greatest", "last_ns", "least")

    def __init__(self, t_ns: int, value: float) -> None:
        self.first_ns = self.last_ns = t_ns
        self.least = self.greatest = (value, t_ns)

    def add(self, t_ns: int, value: float) -> None:
        self.first_ns = min(self.first_ns, t_ns)
        self.last_ns = max(self.last_ns, t_ns)
        self.least = min(self.least, (value, t_ns))
        self.greatest = max(self.greatest, (value, t_ns))

    def points(self) -> list[tuple[int, float]]:
        """One or two, by time."""
        return sorted({(t_ns, value) for value, t_ns in (self.least, self.greatest)})


class MinMaxBuckets:
    """Takes the values of one series in any order; its size is that of the buckets."""

    def __init__(self, from_ns: int, until_ns: int, buckets: int, gap_ns: int) -> None:
        """From ``from_ns`` until before ``until_ns``; values further apart than ``gap_ns`` are not
        joined.
        """
        self._from_ns = from_ns
        self._span_ns = max(until_ns - from_ns, 0)
        self._gap_ns = gap_ns
        self._count = buckets
        self._buckets: dict[int, _Bucket] = {}

    def add(self, t_ns: int, value: float) -> None:
        """A value outside the span is left out."""
        since_ns = t_ns - self._from_ns
        if not 0 <= since_ns < self._span_ns:
            return
        number = since_ns * self._count // self._span_ns
        bucket = self._buckets.get(number)
        if bucket is None:
            self._buckets[number] = _Bucket(t_ns, value)
        else:
            bucket.add(t_ns, value)

    def column(self) -> Column:
        """At most two values a bucket, and one None a gap; a gap within a bucket is left out."""
        filled = [self._buckets[number] for number in sorted(self._buckets)]
        points: list[tuple[int, float | None]] = [*filled[0].points()] if filled else []
        for before, after in pairwise(filled):
            if after.first_ns - before.last_ns > self._gap_ns:
                points.append((before.last_ns + NS_PER_MS, None))
            points += after.points()
        return Column(
            tuple(t_ns // NS_PER_MS for t_ns, _ in points),
            tuple(None if value is None else round(value, _DIGITS) for _, value in points),
        )
