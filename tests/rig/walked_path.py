"""A unit's own path as a test has it walked, position by position."""

from __future__ import annotations

from base_station.fusion.interface import Estimate
from base_station.fusion.odometry.path_history import PathHistory
from shared.clock import NS_PER_S
from shared.messages import Header, Position
from shared.quality import Quality
from tests.rig import message_factory


def at(t_s: float, north_m: float, boot_id: int = 1, **changes: object) -> Position:
    """So far north at that time of the unit's clock."""
    header = Header("FF-01", boot_id, 1, round(t_s * NS_PER_S))
    return message_factory.position(header, north_m=north_m, **changes)


def walked(seconds: int, mps: float = 1.0, east_mps: float = 0.0) -> PathHistory:
    """Straight on, to the north unless said otherwise, at five positions a second."""
    history = PathHistory()
    for fifth in range(seconds * 5):
        t_s = fifth / 5
        position = at(t_s, mps * t_s, east_m=east_mps * t_s)
        history.append(position, position.header.t_mono_ns, jumped=False)
    return history


def insert_late(history: PathHistory, position: Position) -> None:
    """A position comes late; the wearer climbed a metre a second."""
    t_ns = position.header.t_mono_ns
    down_m = -t_ns / NS_PER_S
    place = position.north_m, position.east_m, down_m, 0.5, 0.5, 0.5
    estimate = Estimate(t_ns, *place, 0.0, 0.0, 0.1, Quality.GOOD, "", None)
    history.insert_late(position, t_ns, estimate, 0)
