"""Place of a unit, as it is shown."""

from __future__ import annotations

import msgspec

from base_station.site.plan import Ring
from shared.messages import FusedPosition
from shared.quality import LOST


class UnitPlace(msgspec.Struct):
    """Fused position and what follows from it; station times, None: not so."""

    fused: FusedPosition | None = None
    lost_since_ns: int | None = None  # the fused position is lost
    inside_since_ns: int | None = None  # the wearer is in the building
    reach: Ring = ()  # without contact: border of the area reachable by now, where there is a plan
    last_backfill_s: int = 0  # second of station time of the last late position that was shown

    def show(self, fused: FusedPosition, t_ns: int) -> None:
        """Store it as the present position."""
        self.fused, self.reach = fused, ()
        if fused.quality is not LOST:
            self.lost_since_ns = None
        elif self.lost_since_ns is None:
            self.lost_since_ns = t_ns
