"""Fusers of all units, by unit: one that ignores pins, and beside it one that follows them."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping

from base_station.core.pins.pinned_units import PinnedUnits
from base_station.core.positioning.fuser_change import succeed
from base_station.core.state import StationState, UnitState
from base_station.fusion.interface import Fuser, FuserKind
from base_station.fusion.smoothing.interface import Smoother
from base_station.site.floor_grid import FloorGrid


class UnitFusers:
    """Fusers of one kind; each is made at the first message that needs it."""

    def __init__(
        self,
        kind: FuserKind,
        smoother: Smoother,
        saved: Mapping[str, bytes],
        saved_pinned: Mapping[str, bytes],
    ) -> None:
        self.kind = kind
        self.grids: dict[str, FloorGrid | None] = {}  # walls and storeys of plans, by site
        self.pinned = PinnedUnits(kind, smoother, saved_pinned)
        self._plain = {unit_id: kind.restore(state) for unit_id, state in saved.items()}

    def existing(self, units: Iterable[UnitState]) -> Iterator[Fuser]:
        """Fusers of these units, as far as any was made."""
        for unit in units:
            for fuser in (self._plain.get(unit.unit_id), self.pinned.get(unit.unit_id)):
                if fuser is not None:
                    yield fuser

    def set_map(self, site_id: str, grid: FloorGrid | None, units: Iterable[UnitState]) -> None:
        """Set the walls that the fusers of a site's units use."""
        self.grids[site_id] = grid
        for fuser in self.existing(units):
            fuser.set_map(grid)

    def use_kind(self, kind: FuserKind, state: StationState) -> None:
        """Replace all fusers by those of another kind, which go on where the units are."""
        if kind == self.kind:
            return
        self.kind, before = kind, self._plain
        self.pinned.use_kind(kind)
        self._plain = {}
        for unit_id, fuser in before.items():
            succeed(fuser, self.plain(state.units[unit_id]), state.units[unit_id].position)

    def plain(self, unit: UnitState) -> Fuser:
        """Fuser of a unit that ignores pins."""
        fuser = self._plain.get(unit.unit_id)
        if fuser is None:
            fuser = self._plain[unit.unit_id] = self.kind.new()
            fuser.set_map(self.grids.get(unit.site_id))
        return fuser

    def of(self, unit: UnitState) -> tuple[Fuser, ...]:
        """Fusers of a unit: the one without pins, then the one with pins if there is one."""
        pinned = self.pinned.get(unit.unit_id)
        return (self.plain(unit),) if pinned is None else (self.plain(unit), pinned)

    def forget(self, unit: UnitState) -> Fuser | None:
        """Delete the fusers of a unit; gives the one that ignored pins."""
        self.pinned.forget(unit)
        return self._plain.pop(unit.unit_id, None)

    def save(self) -> dict[str, bytes]:
        """Saved states of the fusers that ignore pins."""
        return {unit_id: fuser.save() for unit_id, fuser in self._plain.items()}
