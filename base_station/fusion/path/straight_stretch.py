"""Whether a wearer went straight on at the same pace, so that nothing between is worth keeping."""

from __future__ import annotations

import math

import msgspec

OFF_M = 0.1  # each axis: so far may a place lie from where it is taken to have been


class Straight(msgspec.Struct, array_like=True):
    """The speeds north and east, from a point on, that lead past every place since within
    ``OFF_M``: the swinging door of process recorders (Bristol 1990).
    """

    least_north_mps: float = -math.inf
    most_north_mps: float = math.inf
    least_east_mps: float = -math.inf
    most_east_mps: float = math.inf

    def leads_to(self, north_m: float, east_m: float, after_s: float) -> bool:
        """Whether one of them leads there; in metres and seconds since the point."""
        return (
            self.least_north_mps * after_s <= north_m <= self.most_north_mps * after_s
            and self.least_east_mps * after_s <= east_m <= self.most_east_mps * after_s
        )

    def pass_by(self, north_m: float, east_m: float, after_s: float) -> None:
        """The wearer was there."""
        self.least_north_mps = max(self.least_north_mps, (north_m - OFF_M) / after_s)
        self.most_north_mps = min(self.most_north_mps, (north_m + OFF_M) / after_s)
        self.least_east_mps = max(self.least_east_mps, (east_m - OFF_M) / after_s)
        self.most_east_mps = min(self.most_east_mps, (east_m + OFF_M) / after_s)
