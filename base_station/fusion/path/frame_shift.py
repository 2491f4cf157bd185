"""How the incident frame has moved since rows of places were packed, so that they may stay as they
are.
"""

from __future__ import annotations

import msgspec
import numpy as np

from base_station.fusion.path.packed_rows import Records
from base_station.fusion.path.points import saturated
from shared.geo import rotate


class FrameShift(msgspec.Struct, frozen=True, array_like=True):
    """Turned clockwise, then shifted."""

    turn_rad: float = 0.0
    north_m: float = 0.0
    east_m: float = 0.0
    down_m: float = 0.0

    def __bool__(self) -> bool:
        return any(msgspec.structs.astuple(self))

    def place(self, north_m: float, east_m: float) -> tuple[float, float]:
        """Where it is now."""
        north_m, east_m = rotate(north_m, east_m, self.turn_rad)
        return north_m + self.north_m, east_m + self.east_m

    def and_then(self, later: FrameShift) -> FrameShift:
        return FrameShift(
            self.turn_rad + later.turn_rad,
            *later.place(self.north_m, self.east_m),
            self.down_m + later.down_m,
        )

    def undone(self) -> FrameShift:
        back = rotate(-self.north_m, -self.east_m, -self.turn_rad)
        return FrameShift(-self.turn_rad, *back, -self.down_m)

    def of(self, rows: Records, north: str, east: str, down: str | None = None) -> Records:
        """Rows whose places, in columns of centimetres, are moved."""
        if not self:
            return rows
        moved = rows.copy()
        cosine, sine = np.cos(self.turn_rad), np.sin(self.turn_rad)
        north_cm, east_cm = rows[north].astype(float), rows[east].astype(float)
        moved[north] = saturated(cosine * north_cm - sine * east_cm + self.north_m * 1e2)
        moved[east] = saturated(sine * north_cm + cosine * east_cm + self.east_m * 1e2)
        if down is not None:
            moved[down] = saturated(rows[down] + self.down_m * 1e2)
        return moved
