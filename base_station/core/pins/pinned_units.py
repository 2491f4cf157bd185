"""Units with pins: each has a second fuser that uses them.  The first fuser ignores pins, so that
removing the last pin gives exactly the state without pins.  The second one starts at the end of the
solved path, and is set there again at every change of a pin.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping

from base_station.core.pins.pin_solver import PathSolver, SolvedUnit, solve_pins, with_partners
from base_station.core.state import StationState, UnitState
from base_station.fusion.interface import Fuser, FuserKind
from base_station.fusion.smoothing.interface import Smoother
from base_station.site.floor_grid import FloorGrid


class PinnedUnits:
    """Fusers that use pins, by unit."""

    def __init__(self, kind: FuserKind, smoother: Smoother, saved: Mapping[str, bytes]) -> None:
        self._kind = kind
        self._smoother = smoother
        self._fusers = {unit_id: kind.restore(state) for unit_id, state in saved.items()}

    def use_kind(self, kind: FuserKind) -> None:
        """Change the kind of fuser; the caller then solves the paths again."""
        self._kind, self._fusers = kind, {}

    def save(self) -> dict[str, bytes]:
        return {unit_id: fuser.save() for unit_id, fuser in self._fusers.items()}

    def get(self, unit_id: str) -> Fuser | None:
        """Fuser of a unit with a pin in use, else None."""
        return self._fusers.get(unit_id)

    def forget(self, unit: UnitState) -> None:
        self._fusers.pop(unit.unit_id, None)
        unit.trails.unpinned = None

    def solver(self, grid: FloorGrid | None) -> PathSolver:
        """Solver for the evidence as it is now; a new one is needed after a change.  ``grid``:
        walls of the site.
        """
        return PathSolver(self._smoother, grid)

    def solve(
        self,
        state: StationState,
        unit_ids: Iterable[str],
        plain: Callable[[str], Fuser],
        grid: FloorGrid | None,
    ) -> dict[str, bool]:
        """Solve the paths of these units of one site, and of the units that they met.  Returns all
        of them, with True where the trail changed.  ``plain`` gives the fuser that ignores pins.
        """
        known = [one for one in with_partners(state, unit_ids) if one in state.units]
        solved = solve_pins(state, self.solver(grid), known)
        return {
            unit_id: self._take(state.units[unit_id], result, plain, grid)
            for unit_id, result in solved.items()
        }

    def _take(
        self,
        unit: UnitState,
        result: SolvedUnit,
        plain: Callable[[str], Fuser],
        grid: FloorGrid | None,
    ) -> bool:
        if result.path is None:
            self._fusers.pop(unit.unit_id, None)
            return unit.trails.restore_unpinned()
        fuser = self._kind.restore(plain(unit.unit_id).save())
        fuser.set_map(grid)
        fuser.set_posterior(result.path.posterior)
        self._fusers[unit.unit_id] = fuser
        unit.trails.show_solved(result.trail)
        return True
