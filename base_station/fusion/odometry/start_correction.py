"""Correction of a run's live estimates after its start position was set."""

from __future__ import annotations

import msgspec
import numpy as np

from base_station.fusion.odometry.packed_rows import Records
from base_station.fusion.odometry.points import Point, saturated
from shared.clock import NS_PER_MS


class StartCorrection(msgspec.Struct, frozen=True):
    """The own frame of a unit's run in the incident frame: its origin, and ``cosine + i sine``, by
    which it is turned clockwise and scaled.
    """

    begin_ns: int  # of the run
    north_m: float
    east_m: float
    cosine: float
    sine: float
    sunk_m: float  # so much lower than it was shown

    def points(self, points: list[Point]) -> None:
        """Correct the points of the run."""
        for one in points:
            if one.t_ns >= self.begin_ns:
                one.shown_north_m = (
                    self.north_m + self.cosine * one.north_m - self.sine * one.east_m
                )
                one.shown_east_m = self.east_m + self.sine * one.north_m + self.cosine * one.east_m
                one.shown_down_m += self.sunk_m

    def rows(self, rows: Records) -> Records:
        """Correct the packed rows of the run."""
        led, run = rows.copy(), rows["t_ms"] >= self.begin_ns // NS_PER_MS
        north_cm, east_cm = (rows[name][run].astype(float) for name in ("north_cm", "east_cm"))
        led["shown_north_cm"][run] = saturated(
            self.north_m * 1e2 + self.cosine * north_cm - self.sine * east_cm
        )
        led["shown_east_cm"][run] = saturated(
            self.east_m * 1e2 + self.sine * north_cm + self.cosine * east_cm
        )
        led["shown_down_cm"][run] += np.int64(round(self.sunk_m * 1e2))
        return led
