"""Trails of a unit: the one that is shown, and the one without pins."""

from __future__ import annotations

import msgspec

from base_station.core.state.trail import TrailStep, bound, extend_trail, insert_into_trail
from shared.messages import FusedPosition


class UnitTrails(msgspec.Struct):
    """The shown trail follows the pins in use; without one, both are the same."""

    shown: list[TrailStep] = msgspec.field(default_factory=list)
    unpinned: list[TrailStep] | None = None  # None: as it is shown

    @property
    def plain(self) -> list[TrailStep]:
        """Trail as it is without any pin."""
        return self.shown if self.unpinned is None else self.unpinned

    def extend(self, plain: FusedPosition, shown: FusedPosition) -> None:
        """Add a point, without pins and with them, where the wearer moved; at most one a second."""
        if self.unpinned is not None:
            extend_trail(self.unpinned, plain)
        extend_trail(self.shown, shown)

    def insert(self, plain: FusedPosition, shown: FusedPosition) -> None:
        """Insert a late point by its time, where none is near in time."""
        if self.unpinned is not None:
            insert_into_trail(self.unpinned, plain)
        insert_into_trail(self.shown, shown)

    def replace_plain(self, since_ns: int, trail: list[TrailStep]) -> None:
        """Replace the trail without pins from a time on."""
        plain = self.plain
        plain[:] = [*(step for step in plain if step.t_ns < since_ns), *trail]
        bound(plain)

    def show_solved(self, trail: list[TrailStep]) -> None:
        """Show the trail as solved with pins, and keep the trail without them."""
        self.unpinned = self.plain
        self.shown = trail

    def restore_unpinned(self) -> bool:
        """Show the trail without pins again; True where that changes the shown trail."""
        if self.unpinned is None:
            return False
        self.shown, self.unpinned = self.unpinned, None
        return True
