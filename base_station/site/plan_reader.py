"""Plan reader with a cache: a plan is read and checked in the thread of the request, so that the
engine need not read it.
"""

from __future__ import annotations

from typing import NamedTuple

from base_station.site.floor_grid import FloorGrid
from base_station.site.plan import Plan, check_plan, salvage_plan


class _Prepared(NamedTuple):
    geojson: bytes
    plan: Plan
    grid: FloorGrid | None


class PlanReader:
    """Reader with a cache of the last plan."""

    def __init__(self) -> None:
        self._last: _Prepared | None = None  # replaced whole: any thread may ask

    def check(self, geojson: bytes) -> None:
        """Check a plan and keep it ready.  Raises UserError if it cannot be used."""
        plan = check_plan(geojson)
        self._last = _Prepared(geojson, plan, FloorGrid.of(plan))

    def plan(self, geojson: bytes) -> Plan:
        """Plan that was accepted, as far as it can be read (``salvage_plan``)."""
        last = self._last
        return last.plan if last and last.geojson == geojson else salvage_plan(geojson)

    def grid(self, plan: Plan | None) -> FloorGrid | None:
        """``FloorGrid.of``, kept: another anchor does not change the plan."""
        if plan is None:
            return None
        last = self._last
        if last is None or last.plan is not plan:
            last = self._last = _Prepared(plan.geojson, plan, FloorGrid.of(plan))
        return last.grid
