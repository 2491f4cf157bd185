"""Straightness test of a path: points between two of a straight line at one pace are not kept."""

from __future__ import annotations

import math

import msgspec

OFF_M = 0.1  # each axis: so far may a place lie from where it is taken to have been


class StraightnessTest(msgspec.Struct, array_like=True):
    """Interval of speeds north and east, from a point on, that pass all later places within
    ``OFF_M``: the swinging door algorithm of process recorders (Bristol 1990).
    """

    least_north_mps: float = -math.inf
    most_north_mps: float = math.inf
    least_east_mps: float = -math.inf
    most_east_mps: float = math.inf

    def allows(self, north_m: float, east_m: float, after_s: float) -> bool:
        """True where a speed of the interval leads to a place; metres and seconds since
        the point.
        """
        return (
            self.least_north_mps * after_s <= north_m <= self.most_north_mps * after_s
            and self.least_east_mps * after_s <= east_m <= self.most_east_mps * after_s
        )

    def narrow(self, north_m: float, east_m: float, after_s: float) -> None:
        """Narrow the interval to speeds that pass a place."""
        self.least_north_mps = max(self.least_north_mps, (north_m - OFF_M) / after_s)
        self.most_north_mps = min(self.most_north_mps, (north_m + OFF_M) / after_s)
        self.least_east_mps = max(self.least_east_mps, (east_m - OFF_M) / after_s)
        self.most_east_mps = min(self.most_east_mps, (east_m + OFF_M) / after_s)
