"""Runs of a unit's program, each with its own frame, in the unit's path."""

from __future__ import annotations

import msgspec

from base_station.fusion.interface import Start
from base_station.fusion.odometry.rigid_transform import RigidTransform2D


class PathRuns(msgspec.Struct, array_like=True):
    """Running boot, the one before it, and from when on earlier runs are of use."""

    boot_id: int = 0
    begin_ns: int = 0  # of the running boot
    ended_boot_id: int = 0  # of the run before it
    since_ns: int = 0  # the path before is not wanted
    opened_ns: int = 0  # when the incident was opened

    def begin(self, boot_id: int, t_ns: int, *, follows: bool) -> None:
        """The unit's program was started; ``follows``: the path has points of the run before."""
        self.ended_boot_id = self.boot_id if follows else 0
        self.boot_id, self.begin_ns = boot_id, t_ns


class FrameStart(msgspec.Struct, array_like=True):
    """Start position that a person has set, and the own frame whose origin it is."""

    position: Start | None = None
    begin_ns: int = 0  # when that own frame began
    is_over: bool = False  # nothing of that own frame is in the path

    @property
    def in_path(self) -> Start | None:
        """Start position, where its own frame is part of the path."""
        return None if self.is_over else self.position

    def set(self, position: Start, begin_ns: int) -> None:
        """Set the start position of the own frame that began then."""
        self.position, self.begin_ns, self.is_over = position, begin_ns, False

    def reframe(self, move: RigidTransform2D) -> None:
        """The incident frame was moved: turned clockwise, then shifted."""
        start = self.position
        if start is None:
            return
        north_m, east_m = move.apply(start.north_m, start.east_m)
        self.position = msgspec.structs.replace(
            start,
            north_m=north_m,
            east_m=east_m,
            down_m=start.down_m + move.down_m,
            heading_rad=start.heading_rad + move.turn_rad,
        )
