"""A unit's own path as a test has it walked, position by position."""

from __future__ import annotations

from base_station.bench.rig import said
from base_station.fusion.path.history import PathHistory
from shared.clock import NS_PER_S
from shared.messages import Header, Position


def at(t_s: float, north_m: float, boot_id: int = 1, **changes: object) -> Position:
    """So far north at that time of the unit's clock."""
    header = Header("FF-01", boot_id, 1, round(t_s * NS_PER_S))
    return said.position(header, north_m=north_m, **changes)


def walked(seconds: int, mps: float = 1.0) -> PathHistory:
    """Straight to the north, at five positions a second."""
    history = PathHistory()
    for fifth in range(seconds * 5):
        history.note(at(fifth / 5, mps * fifth / 5), round(fifth / 5 * NS_PER_S), jumped=False)
    return history
