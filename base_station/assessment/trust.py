"""A light for how far a unit's place can be trusted, with the reason in words."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Literal

import msgspec

from base_station.live_state import StationState, UnitState
from shared.messages import FusedPosition
from shared.quality import Quality

Level = Literal["green", "amber", "red"]

AMBER_M = 5.0  # radius that holds the wearer with 95 % probability
RED_M = 20.0
AMBER_DOWN_M = 1.5  # half a storey
AMBER_FLOOR = 0.7  # probability of the floor shown
_RADII_95 = math.sqrt(-2.0 * math.log(0.05))


class Trust(msgspec.Struct, frozen=True):
    level: Level
    reason: str = ""  # for a person; empty: green


_SURE = Trust("green")


def trust_of(state: StationState, unit: UnitState) -> Trust:
    """The worst of what speaks against believing where the unit is shown."""
    worst = _SURE
    for doubt in _doubts(state, unit):
        if doubt.level == "red":
            return doubt
        if worst is _SURE:
            worst = doubt
    return worst


def _doubts(state: StationState, unit: UnitState) -> Iterator[Trust]:
    if not unit.registered:
        yield Trust("red", "not a registered unit: not believed")
    fused = unit.fused
    if fused is None:
        yield Trust("red", "no position yet")
        return
    if unit.link in {"lost", "stale"}:
        yield Trust("red" if unit.link == "lost" else "amber", "not heard: shown where it last was")
    if fused.quality is Quality.LOST:
        yield Trust("red", fused.quality_reason)
    within_m = _RADII_95 * math.sqrt(_largest_var_m2(fused))
    if within_m > AMBER_M:
        yield Trust("red" if within_m > RED_M else "amber", f"only known to {within_m:.0f} m")
    conflicts = sum(
        state.pin_verdicts[pin.pin_id].state == "conflict"
        for pin in state.pins.values()
        if unit.unit_id in (pin.unit_id, pin.other_id) and pin.pin_id in state.pin_verdicts
    )
    if conflicts:
        which = "a pin contradicts" if conflicts == 1 else f"{conflicts} pins contradict"
        yield Trust("amber", f"{which} the trail")
    if fused.quality is Quality.DEGRADED:
        yield Trust("amber", fused.quality_reason)
    if fused.floor_probability is not None and fused.floor_probability < AMBER_FLOOR:
        yield Trust("amber", f"the floor is only {fused.floor_probability:.0%} sure")
    if fused.std_down_m > AMBER_DOWN_M:
        yield Trust("amber", f"height only known to {2.0 * fused.std_down_m:.0f} m")


def _largest_var_m2(fused: FusedPosition) -> float:
    """Variance along the longest axis of the region."""
    north_var, east_var = fused.std_north_m**2, fused.std_east_m**2
    product = fused.correlation_ne * fused.std_north_m * fused.std_east_m
    middle = (north_var + east_var) / 2.0
    return middle + math.hypot((north_var - east_var) / 2.0, product)
