"""Rigid transform of the incident frame: turn and shift since rows were packed, so that these stay
as they are.
"""

from __future__ import annotations

import msgspec
import numpy as np

from base_station.fusion.odometry.packed_rows import Records
from base_station.fusion.odometry.points import saturated
from shared.geo import rotate


class RigidTransform2D(msgspec.Struct, frozen=True, array_like=True):
    """Clockwise turn, then shift; the height is shifted only."""

    turn_rad: float = 0.0
    north_m: float = 0.0
    east_m: float = 0.0
    down_m: float = 0.0

    def __bool__(self) -> bool:
        return any(msgspec.structs.astuple(self))

    def apply(self, north_m: float, east_m: float) -> tuple[float, float]:
        """Transformed north and east."""
        north_m, east_m = rotate(north_m, east_m, self.turn_rad)
        return north_m + self.north_m, east_m + self.east_m

    def followed_by(self, later: RigidTransform2D) -> RigidTransform2D:
        return RigidTransform2D(
            self.turn_rad + later.turn_rad,
            *later.apply(self.north_m, self.east_m),
            self.down_m + later.down_m,
        )

    def inverse(self) -> RigidTransform2D:
        back = rotate(-self.north_m, -self.east_m, -self.turn_rad)
        return RigidTransform2D(-self.turn_rad, *back, -self.down_m)

    def apply_to_rows(
        self, rows: Records, north: str, east: str, down: str | None = None
    ) -> Records:
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
