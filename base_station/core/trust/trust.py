"""Trust light of a unit's position, with the reason as text."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterator
from typing import Literal

import msgspec

from base_station.core.pins.pin_registry import units_of
from base_station.core.state import StationState, UnitState
from base_station.core.state.trust_tally import LONGEST_S
from base_station.site.max_travel import RADII_95
from shared.clock import NS_PER_S
from shared.coded_text import Measure, coded, with_code
from shared.messages import FusedPosition
from shared.quality import Quality

Level = Literal["green", "amber", "red"]

AMBER_M = 5.0  # radius that holds the wearer with 95 % probability
RED_M = 20.0
AMBER_DOWN_M = 1.5  # half a storey
AMBER_FLOOR = 0.7  # probability of the floor shown
_AMBER_M2 = (AMBER_M / RADII_95) ** 2  # variance


class Trust(msgspec.Struct, frozen=True):
    level: Level
    reason: str = ""  # for a person, with its code; empty: green
    cause: str = ""  # the reason without figures, for statistics


_GREEN = Trust("green")


def trust_of(unit: UnitState, conflicts: int) -> Trust:
    """Worst reason against the shown position, where this many pins contradict the trail."""
    return next(_red_causes(unit), None) or next(_amber_causes(unit, conflicts), _GREEN)


def update_trust_tallies(state: StationState) -> None:
    """Add the time since the last call to the tallies of all units that are in an open incident
    and have a wearer or a position; a unit that was switched off in order has no light.
    """
    lasted_s = (state.t_ns - state.trust_ns) / NS_PER_S
    state.trust_ns = state.t_ns
    if not state.open_incidents or lasted_s > LONGEST_S:
        return
    conflicts = conflicts_of(state)
    for unit in state.units.values():
        if not unit.registered or unit.stopped_ns is not None or not state.open_incident_of(unit):
            continue
        if unit.place.fused is not None or unit.wearer.person is not None:
            trust = trust_of(unit, conflicts.get(unit.unit_id, 0))
            unit.trust.note(trust.level, trust.cause, lasted_s)


def conflicts_of(state: StationState) -> Counter[str]:
    """Number of pins that contradict each unit's trail."""
    return Counter(
        unit_id
        for site in state.sites.values()
        for pin_id, verdict in site.pin_verdicts.items()
        if verdict.state == "conflict" and pin_id in site.pins
        for unit_id in units_of(site.pins[pin_id])
    )


def _red_causes(unit: UnitState) -> Iterator[Trust]:
    if not unit.registered:
        text = coded("doubt-unregistered", "not a registered unit: not believed")
        yield Trust("red", text, "not a registered unit")
    fused = unit.place.fused
    if fused is None:
        text = coded("doubt-no-position", "no position yet")
        yield Trust("red", text, "no position yet")
        return
    if unit.link == "lost":
        yield _no_contact("red")
    if fused.quality is Quality.LOST:
        yield _of_quality("red", fused)
    within_m = _within_m(fused)
    if within_m > RED_M:
        yield _trust_of_imprecise("red", within_m)


def _amber_causes(unit: UnitState, conflicts: int) -> Iterator[Trust]:
    """Amber causes of a unit that has a position."""
    fused = unit.place.fused
    assert fused is not None
    if unit.link == "stale":
        yield _no_contact("amber")
    within_m = _within_m(fused)
    if within_m > AMBER_M:
        yield _trust_of_imprecise("amber", within_m)
    if conflicts:
        which = "a pin contradicts" if conflicts == 1 else f"{conflicts} pins contradict"
        text = coded("doubt-pins", "{count} the trail", count=Measure(conflicts, which))
        yield Trust("amber", text, "a pin contradicts the trail")
    if fused.quality is Quality.DEGRADED:
        yield _of_quality("amber", fused)
    if fused.floor_probability is not None and fused.floor_probability < AMBER_FLOOR:
        text = coded(
            "doubt-floor",
            "the floor is uncertain ({sure_fraction:.0%})",
            sure_fraction=round(fused.floor_probability, 2),
        )
        yield Trust("amber", text, "floor not sure")
    if fused.std_down_m > AMBER_DOWN_M:
        text = coded(
            "doubt-height",
            "height only known to {within_m:.0f} m",
            within_m=round(2.0 * fused.std_down_m),
        )
        yield Trust("amber", text, "height only roughly known")


def _no_contact(level: Level) -> Trust:
    text = coded("doubt-no-message", "no message: shown at its last known position")
    return Trust(level, text, "no message")


def _trust_of_imprecise(level: Level, within_m: float) -> Trust:
    text = coded("doubt-place", "only known to {within_m:.0f} m", within_m=round(within_m))
    return Trust(level, text, "place only roughly known")


def _of_quality(level: Level, fused: FusedPosition) -> Trust:
    text = with_code(fused.quality_reason, fused.quality_code)
    return Trust(level, text, _cause_of(fused.quality_reason))


def _within_m(fused: FusedPosition) -> float:
    """The radius that holds the wearer; 0 where that is near enough along any axis."""
    if fused.std_north_m**2 + fused.std_east_m**2 <= _AMBER_M2:
        return 0.0
    return RADII_95 * math.sqrt(_largest_var_m2(fused))


def _cause_of(reason: str) -> str:
    """Cause without its details: fusers add an amount, or a reason or advice behind a colon."""
    return "place only roughly known" if reason.startswith("within ") else reason.partition(":")[0]


def _largest_var_m2(fused: FusedPosition) -> float:
    """Variance along the longest axis of the region."""
    north_var, east_var = fused.std_north_m**2, fused.std_east_m**2
    product = fused.correlation_ne * fused.std_north_m * fused.std_east_m
    middle = (north_var + east_var) / 2.0
    return middle + math.hypot((north_var - east_var) / 2.0, product)
