"""Own path of a unit, thinned: the newest points as they came, older ones packed.

Small enough to be kept in the pipeline's state for days and enough to solve the whole past again:
what is older than some two minutes is packed (some 11 bytes a point).
"""

from __future__ import annotations

import msgspec
import numpy as np

from base_station.fusion.odometry.packed_rows import CHUNK, Packed, Records
from base_station.fusion.odometry.points import DOUBTFUL, POINT_ROW, Point, rows_of, thinned
from base_station.fusion.odometry.rigid_transform import RigidTransform2D
from base_station.fusion.odometry.start_correction import StartCorrection
from base_station.fusion.odometry.straight_segment import StraightnessTest
from shared.clock import NS_PER_MS, NS_PER_S
from shared.messages import Position

STEP_M = 1.0
CLIMB_M = 0.5
STEP_NS = 10 * NS_PER_S
STRIDE_NS = NS_PER_S  # a foot's speed changes within a stride: shorter bends are none of the path
MOVING_M = 0.05  # between two positions: the wearer moved
FILLED_NS = 30 * NS_PER_S  # a journal is being read: packed rows cannot be filled
MOST_LOOSE = 32 * CHUNK
_SHOWN = "shown_north_cm", "shown_east_cm", "shown_down_cm"


class ThinnedPath(msgspec.Struct, array_like=True):
    """Points come in order; the newest one follows the wearer until it is far enough away.

    ``frame``, where a method asks for it: how the incident frame has moved since anything was
    packed.
    """

    packed: Packed = msgspec.field(default_factory=Packed)
    points: list[Point] = msgspec.field(default_factory=list)  # behind the packed ones
    straight: StraightnessTest = msgspec.field(
        default_factory=StraightnessTest
    )  # since the last settled point
    filled_ns: int = 0  # where the path had come to when a position came late last

    @property
    def begin_ns(self) -> int | None:
        if self.packed:
            return self.packed.begin * NS_PER_MS
        return self.points[0].t_ns if self.points else None

    def apart_ns(self, t_ns: int) -> int:
        """Time of a new point, later than the last one by so much that they are apart when
        packed.
        """
        return max(t_ns, self.points[-1].t_ns + NS_PER_MS) if self.points else t_ns

    def append(
        self, position: Position, t_ns: int, flags: int, *, joins: bool, frame: RigidTransform2D
    ) -> None:
        """Append a position with the flags of its point; ``joins``: to the point before it."""
        if not self.points:
            self.points.append(Point.of(position, t_ns, flags))
            return
        tip = self.points[-1]
        before_ns, before_north_m, before_east_m = tip.t_ns, tip.north_m, tip.east_m
        if self._is_settled(tip, flags, joins=joins) or self._bends(tip, position, t_ns):
            tip = self._begin_point(tip, frame)
        tip.t_ns = t_ns
        tip.flags |= flags
        tip.follow(position)
        self._narrow_straight(tip)
        if joins:
            stepped_m = abs(tip.north_m - before_north_m) + abs(tip.east_m - before_east_m)
            if stepped_m > MOVING_M:
                tip.moving_ms += (tip.t_ns - before_ns) // NS_PER_MS

    def insert(self, row: int, late: Point) -> None:
        """Insert a late point before that row of the points that are not packed."""
        self.points.insert(row, late)
        self.straight, self.filled_ns = StraightnessTest(), self.points[-1].t_ns

    def cut(self, before_ms: int) -> None:
        """Drop points before a time."""
        self.packed.cut(before_ms, POINT_ROW)
        self.points = [point for point in self.points if point.t_ns // NS_PER_MS >= before_ms]

    def reframe(self, move: RigidTransform2D) -> None:
        """The incident frame was moved; what is packed stays as it is."""
        for point in self.points:
            point.shown_north_m, point.shown_east_m = move.apply(
                point.shown_north_m, point.shown_east_m
            )
            point.shown_down_m += move.down_m

    def correct_start(self, correction: StartCorrection, frame: RigidTransform2D) -> None:
        """Correct the live estimates of a run whose start position was set."""
        correction.points(self.points)
        self.packed.change(
            POINT_ROW,
            lambda rows: frame.inverse().apply_to_rows(
                correction.rows(frame.apply_to_rows(rows, *_SHOWN)), *_SHOWN
            ),
        )

    def drop_estimates(self) -> None:
        """Drop the live estimates of all points."""
        for point in self.points:
            point.shown_std_m = 0.0
        self.packed.change(POINT_ROW, _without_estimates)

    def rows(self, frame: RigidTransform2D) -> Records:
        """All points; packed ones are rounded to a centimetre and a millisecond."""
        shown = frame.apply_to_rows(self.packed.rows(POINT_ROW), *_SHOWN)
        return np.concatenate((shown, rows_of(self.points)))

    def _is_settled(self, tip: Point, flags: int, *, joins: bool) -> bool:
        """True where the newest point is kept and a new one, with these flags, begins."""
        if not joins or (flags ^ tip.flags) & DOUBTFUL:
            return True
        if len(self.points) == 1:
            return True
        before = self.points[-2]
        north_m, east_m = tip.north_m - before.north_m, tip.east_m - before.east_m
        return (
            north_m * north_m + east_m * east_m >= STEP_M**2
            or abs(tip.shown_down_m - before.shown_down_m) >= CLIMB_M
            or tip.t_ns - before.t_ns >= STEP_NS
        )

    def _bends(self, tip: Point, position: Position, t_ns: int) -> bool:
        """True where the wearer left the straight line or the pace since the last kept point."""
        before = self.points[-2]
        if tip.t_ns - before.t_ns < STRIDE_NS:
            return False
        after_s = (t_ns - before.t_ns) / NS_PER_S
        north_m, east_m = position.north_m - before.north_m, position.east_m - before.east_m
        return not self.straight.allows(north_m, east_m, after_s)

    def _narrow_straight(self, tip: Point) -> None:
        before = self.points[-2]
        after_s = (tip.t_ns - before.t_ns) / NS_PER_S
        self.straight.narrow(tip.north_m - before.north_m, tip.east_m - before.east_m, after_s)

    def _begin_point(self, tip: Point, frame: RigidTransform2D) -> Point:
        """A new tip; until it is estimated, it is shown where the last one was."""
        self.straight = StraightnessTest()
        begun = tip.continued()
        self.points.append(begun)
        is_filled = tip.t_ns - self.filled_ns < FILLED_NS and len(self.points) < MOST_LOOSE
        if len(self.points) >= 2 * CHUNK and not is_filled:
            rows = rows_of(self.points[:CHUNK])
            self.packed.add(frame.inverse().apply_to_rows(rows, *_SHOWN), thinned)
            del self.points[:CHUNK]
        return begun


def _without_estimates(rows: Records) -> Records:
    unknown = rows.copy()
    unknown["shown_std_cm"] = 0
    return unknown
