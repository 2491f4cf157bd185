"""Fusers with, beside each, what a station would keep of the path that it was told."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, cast

from base_station.fusion.path.history import PathHistory
from base_station.fusion.port import Estimate, FixVerdict, Fuser, FuserKind, PlaceFix, Start
from base_station.site.floor_grid import FloorGrid
from shared.messages import Position


class PathKeeping:
    """Makes the fusers of another kind, and keeps what a station would keep of each path."""

    def __init__(self, kind: FuserKind) -> None:
        self._kind = kind
        self._known = _KnownPlan()
        self.histories: list[PathHistory] = []

    @property
    def name(self) -> str:
        return self._kind.name

    @property
    def grid(self) -> FloorGrid | None:
        """The plan's walls, as the fusers heard of them."""
        return self._known.grid

    def restore(self, saved: bytes) -> Fuser:
        return self._kind.restore(saved)

    def new(self) -> Fuser:
        self.histories.append(PathHistory())
        return cast("Fuser", _Keeping(self._kind.new(), self.histories[-1], self._known))


@dataclass
class _KnownPlan:
    grid: FloorGrid | None = None


class _Keeping:
    def __init__(self, fuser: Fuser, history: PathHistory, known: _KnownPlan) -> None:
        self._fuser, self._history, self._known = fuser, history, known

    def __getattr__(self, name: str) -> Any:
        return getattr(self._fuser, name)

    def consider(self, grid: FloorGrid | None) -> None:
        self._known.grid = grid
        self._fuser.consider(grid)

    def start(self, start: Start) -> None:
        self._history.begin_with(start)
        self._fuser.start(start)

    def advance(self, position: Position) -> str:
        reason = self._fuser.advance(position)
        self._history.note(position, position.header.t_mono_ns, bool(reason))
        return reason

    def correct(self, fix: PlaceFix) -> FixVerdict:
        verdict = self._fuser.correct(fix)
        if verdict.accepted:
            self._history.fix(fix, fix.t_mono_ns)
        return verdict

    def estimate(self) -> Estimate | None:
        estimate = self._fuser.estimate()
        if estimate is not None:
            self._history.show(estimate, None)
        return estimate
