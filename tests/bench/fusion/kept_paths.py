"""Fusers with, beside each, what a station would keep of the path that it received."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, cast

from base_station.fusion.interface import Estimate, Fuser, FuserKind, Start
from base_station.fusion.odometry.path_history import PathHistory
from base_station.fusion.smoothing.interface import UnitEvidence
from base_station.site.floor_grid import FloorGrid
from shared.messages import Header, Position
from tests.rig import message_factory
from tests.rig.incident.cramer_rao_bound import ENGINE_STD_M
from tests.rig.incident.people import RATE_HZ
from tests.rig.incident.run import Person, Run

ENGINE = "engine"


class PathKeeping:
    """Makes the fusers of another kind, and keeps what a station would keep of each path."""

    def __init__(self, kind: FuserKind) -> None:
        self._kind = kind
        self._known = _KnownPlan()
        self.histories: list[PathHistory] = []

    @property
    def name(self) -> str:
        return self._kind.name

    def restore(self, saved: bytes) -> Fuser:
        return self._kind.restore(saved)

    def new(self) -> Fuser:
        self.histories.append(PathHistory())
        return cast("Fuser", _Keeping(self._kind.new(), self.histories[-1], self._known))

    def evidence(self, runs: Sequence[Run]) -> dict[str, UnitEvidence]:
        """Evidence of each fused person, by number."""
        found = {}
        for number, (history, run) in enumerate(zip(self.histories, runs, strict=True)):
            for fix in run.taken:
                history.fix(fix, fix.t_mono_ns)
            found[str(number)] = UnitEvidence(
                history.arrays(),
                history.start.position,
                history.start.begin_ns,
                grid=self._known.grid,
            )
        return found


def engine_evidence(person: Person) -> dict[str, UnitEvidence]:
    """Evidence of the receiver on the engine's roof."""
    history = PathHistory()
    for row in range(0, len(person.truth.t_s), RATE_HZ):
        t_ns = message_factory.mono_ns(float(person.truth.t_s[row]))
        history.append(
            message_factory.position(Header(ENGINE, 1, row + 1, t_ns)), t_ns, jumped=False
        )
    history.set_start(Start(*person.engine_m, 0.0, 0.0, ENGINE_STD_M, math.pi))
    for fix in person.engine_fixes.values():
        history.fix(fix, fix.t_mono_ns)
    return {ENGINE: UnitEvidence(history.arrays(), history.start.position, history.start.begin_ns)}


@dataclass
class _KnownPlan:
    grid: FloorGrid | None = None


class _Keeping:
    def __init__(self, fuser: Fuser, history: PathHistory, known: _KnownPlan) -> None:
        self._fuser, self._history, self._known = fuser, history, known

    def __getattr__(self, name: str) -> Any:
        return getattr(self._fuser, name)

    def set_map(self, grid: FloorGrid | None) -> None:
        self._known.grid = grid
        self._fuser.set_map(grid)

    def start(self, start: Start) -> None:
        self._history.set_start(start)
        self._fuser.start(start)

    def predict(self, position: Position) -> str:
        reason = self._fuser.predict(position)
        self._history.append(position, position.header.t_mono_ns, bool(reason))
        return reason

    def estimate(self) -> Estimate | None:
        estimate = self._fuser.estimate()
        if estimate is not None:
            self._history.set_live_estimate(estimate, None)
        return estimate
