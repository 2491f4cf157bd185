"""One unit's own path since an incident began, thinned, with the satellite fixes that were taken.

Small enough to be kept in the pipeline's state for days and enough to solve the whole past again:
what is older than some two minutes is packed (some 11 bytes a point).  Times are the station's, so
that a unit that starts again, or whose clock is judged better later, goes on in the same history.
"""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Callable

import msgspec
import numpy as np

from base_station.fusion.interface import Estimate, PlaceFix, Start
from base_station.fusion.odometry.fixes import PathFixes
from base_station.fusion.odometry.packed_rows import CHUNK, Packed, Records
from base_station.fusion.odometry.points import (
    BREAK,
    DOUBTFUL,
    NO_FLOOR,
    POINT_ROW,
    RESTART,
    PathArrays,
    Point,
    arrays_of,
    rows_of,
    thinned,
)
from base_station.fusion.odometry.rigid_transform import RigidTransform2D
from base_station.fusion.odometry.start_correction import StartCorrection
from base_station.fusion.odometry.straight_segment import StraightnessTest
from shared.clock import NS_PER_MS, NS_PER_S
from shared.messages import Position
from shared.quality import GOOD

STEP_M = 1.0
CLIMB_M = 0.5
STEP_NS = 10 * NS_PER_S
STRIDE_NS = NS_PER_S  # a foot goes by fits and starts: shorter ones are no bends
MOVING_M = 0.05  # between two positions: the wearer moved
FILL_NS = 3 * NS_PER_S // 2  # a position that came late is wanted where none is nearer
FILLED_NS = 30 * NS_PER_S  # a journal is being read: what is packed cannot be filled
FIX_NEAR_MS = 1000  # a fix so near to where a path begins or breaks was taken there
MOST_LOOSE = 32 * CHUNK
_SHOWN = "shown_north_cm", "shown_east_cm", "shown_down_cm"


class PathHistory(msgspec.Struct):
    """Points come in order; the newest one follows the wearer until it is far enough away."""

    boot_id: int = 0
    boot_begin_ns: int = 0
    ended_boot_id: int = 0  # of the run before it
    packed: Packed = msgspec.field(default_factory=Packed)
    points: list[Point] = msgspec.field(default_factory=list)  # behind the packed ones
    fixes: PathFixes = msgspec.field(default_factory=PathFixes)
    moved: RigidTransform2D = RigidTransform2D()  # the frame, since anything was packed
    start: Start | None = None  # as a person said
    start_ns: int = 0  # when the own frame began that it is about
    is_start_over: bool = False  # nothing of that own frame is in the path
    straight: StraightnessTest = msgspec.field(
        default_factory=StraightnessTest
    )  # since the last settled point
    awaited_ns: int | None = None  # a pin waits for the path to come to this time
    since_ns: int = 0  # what was before is not wanted
    opened_ns: int = 0  # when the incident was opened
    is_refixed: bool = False  # fixes were moved: the unit is to be placed again
    is_renumbered: bool = False  # storeys have other numbers: the trail's are to be said anew
    filled_ns: int = 0  # where the path had come to when a position came late last
    since_gps_s: float | None = None  # as last estimated without any pin
    floor: int | None = None
    height_assumed: bool = False  # nothing has told how high the path begins

    @property
    def begin_ns(self) -> int | None:
        if self.packed:
            return self.packed.begin * NS_PER_MS
        return self.points[0].t_ns if self.points else None

    @property
    def end_ns(self) -> int | None:
        return self.points[-1].t_ns if self.points else None

    @property
    def shown_m(self) -> tuple[float, float] | None:
        """North and east as last estimated without any pin."""
        if not self.points:
            return None
        return self.points[-1].shown_north_m, self.points[-1].shown_east_m

    @property
    def is_awaited(self) -> bool:
        """The path has come to where a pin waits for it."""
        return self.awaited_ns is not None and (self.end_ns or 0) >= self.awaited_ns

    @property
    def is_before_incident(self) -> bool:
        """True where no point is newer than the opening of the incident."""
        return self.end_ns is not None and self.end_ns < self.opened_ns

    def for_next_boot(self) -> PathHistory:
        """Empty history for the next run, after the known run is over."""
        return PathHistory(since_ns=self.since_ns, opened_ns=self.opened_ns)

    def append(self, position: Position, t_ns: int, jumped: bool) -> bool:
        """Append a position; ``jumped``: it does not join the path. True where the path begins with
        it.
        """
        if self.points:
            t_ns = max(t_ns, self.points[-1].t_ns + NS_PER_MS)  # packed, they still are apart
        begins_run = position.header.boot_id != self.boot_id
        if begins_run:
            self._begin_run(position.header.boot_id, t_ns)
        restarted = bool(self.points) and begins_run
        flags = 0 if position.path_quality is GOOD else DOUBTFUL
        flags |= RESTART * restarted | BREAK * (jumped and not restarted)
        if not self.points:
            self.points.append(_point_of(position, t_ns, flags))
            return True
        tip = self.points[-1]
        before_ns, before_north_m, before_east_m = tip.t_ns, tip.north_m, tip.east_m
        if self._is_settled(tip, flags) or self._bends(tip, position, t_ns):
            tip = self._begin_point(tip)
        tip.t_ns = t_ns
        tip.flags |= flags
        _follow(tip, position)
        self._narrow_straight(tip)
        if not flags & (BREAK | RESTART):
            stepped_m = abs(tip.north_m - before_north_m) + abs(tip.east_m - before_east_m)
            if stepped_m > MOVING_M:
                tip.moving_ms += (tip.t_ns - before_ns) // NS_PER_MS
        return False

    def insert_late(
        self, position: Position, t_ns: int, estimate: Estimate, floor: int | None
    ) -> None:
        """Insert a late position with its estimate without pins, where no point is near: in a gap,
        before the first point of the running boot, or behind the last one of the boot before.
        """
        points = self.points
        row = bisect_left(points, t_ns, key=lambda point: point.t_ns)
        if row == len(points):
            return
        joins = self._joining(position.header.boot_id, t_ns, row)
        if joins is None:
            return
        near = points[max(row - 1, 0) : row + 1]
        if min(abs(point.t_ns - t_ns) for point in near) < FILL_NS:
            return
        late = _point_of(position, t_ns, 0 if position.path_quality is GOOD else DOUBTFUL)
        _set_live_estimate(late, estimate, floor)
        if joins(late, row):
            points.insert(row, late)
            self.straight, self.filled_ns = StraightnessTest(), points[-1].t_ns

    def set_live_estimate(self, estimate: Estimate, floor: int | None) -> None:
        """Set the estimate without pins at the newest point."""
        self.since_gps_s, self.floor = estimate.since_gps_s, floor
        self.height_assumed = estimate.height_assumed
        if self.points:
            _set_live_estimate(self.points[-1], estimate, floor)

    def set_start(self, start: Start) -> None:
        """Set the start position of the running boot's own frame."""
        self.start, self.start_ns, self.is_start_over = start, self.boot_begin_ns, False
        self.height_assumed = False

    @property
    def start_in_path(self) -> Start | None:
        """Start position, where its own frame is part of the path."""
        return None if self.is_start_over else self.start

    def drop_fixes(self) -> None:
        """Drop all fixes, and the runs before the running boot."""
        self._cut(self.boot_begin_ns)
        self.fixes, self.since_gps_s, self.is_refixed = PathFixes(), None, False

    def apply_start_correction(self, correction: StartCorrection) -> None:
        """Correct the live estimates of a run whose start position was set."""
        correction.points(self.points)
        self.packed.change(
            POINT_ROW,
            lambda rows: self.moved.inverse().apply_to_rows(
                correction.rows(self.moved.apply_to_rows(rows, *_SHOWN)), *_SHOWN
            ),
        )

    def begin_incident(self, opened_ns: int, since_ns: int) -> None:
        """Keep only the run that goes on in the incident, from ``since_ns`` on: earlier runs do not
        show where it began.
        """
        self.opened_ns, self.since_ns = opened_ns, since_ns
        self._cut(max(since_ns, self.boot_begin_ns))
        self.is_start_over |= self.start_ns < self.boot_begin_ns

    def fix(self, fix: PlaceFix, t_ns: int) -> None:
        """Add an accepted fix, unless there is one close in time."""
        self.fixes.append(fix, t_ns, self.moved)

    def reframe(self, turn_rad: float, north_m: float, east_m: float, down_m: float) -> None:
        """The incident frame was moved: turned clockwise, then shifted."""
        move = RigidTransform2D(turn_rad, north_m, east_m, down_m)
        self.moved = self.moved.followed_by(move)
        self.fixes.reframe(move)
        for point in self.points:
            point.shown_north_m, point.shown_east_m = move.apply(
                point.shown_north_m, point.shown_east_m
            )
            point.shown_down_m += down_m
        if self.start is not None:
            north_m, east_m = move.apply(self.start.north_m, self.start.east_m)
            self.start = msgspec.structs.replace(
                self.start,
                north_m=north_m,
                east_m=east_m,
                down_m=self.start.down_m + down_m,
                heading_rad=self.start.heading_rad + turn_rad,
            )

    def move_fixes(self, turn_rad: float, north_m: float, east_m: float) -> bool:
        """Move the fixes in the incident frame and drop live estimates made with them; False
        without fixes.
        """
        if not self.fixes:
            return False
        self.fixes.move(RigidTransform2D(turn_rad, north_m, east_m), self.moved)
        for point in self.points:
            point.shown_std_m = 0.0
        self.packed.change(POINT_ROW, _without_estimates)
        self.is_refixed = True
        return True

    def arrays(self) -> PathArrays:
        """Path and fixes in SI units; packed points are rounded to a centimetre and a
        millisecond.
        """
        shown = self.moved.apply_to_rows(self.packed.rows(POINT_ROW), *_SHOWN)
        rows = np.concatenate((shown, rows_of(self.points)))
        return arrays_of(rows, _fixes_on_path(rows, self.fixes.rows(self.moved)))

    def _begin_run(self, boot_id: int, t_ns: int) -> None:
        """The unit's program was started; in an incident, runs that were over before go."""
        if not self.boot_id:
            self.start_ns = t_ns
        elif self.points and self.points[-1].t_ns < self.opened_ns:
            self._cut(self.opened_ns)
        self.is_start_over |= bool(self.boot_id) and not self.points
        self.ended_boot_id = self.boot_id if self.points else 0
        self.boot_id, self.boot_begin_ns = boot_id, t_ns

    def _cut(self, before_ns: int) -> None:
        """Drop points before a time, to the millisecond as they are packed: a run that began then
        stays whole.
        """
        before_ms = before_ns // NS_PER_MS
        self.packed.cut(before_ms, POINT_ROW)
        self.points = [point for point in self.points if point.t_ns // NS_PER_MS >= before_ms]
        self.fixes.trim(before_ms)

    def _joining(self, boot_id: int, t_ns: int, row: int) -> Callable[[Point, int], bool] | None:
        """Method that joins a late position to the path; None where it has no place in it."""
        is_before = t_ns < self.boot_begin_ns
        if boot_id == self.boot_id:
            return self._begin_earlier if is_before else self._fill_gap
        if boot_id == self.ended_boot_id and is_before:
            is_last = self.points[row].t_ns >= self.boot_begin_ns
            return self._end_later if is_last else self._fill_gap
        return None

    def _fill_gap(self, late: Point, row: int) -> bool:
        after = self.points[row]
        if row == 0 or after.flags & (BREAK | RESTART):
            return False
        before_ns = self.points[row - 1].t_ns
        part = (late.t_ns - before_ns) / (after.t_ns - before_ns)
        late.moving_ms = round(after.moving_ms * part)
        after.moving_ms -= late.moving_ms
        return True

    def _begin_earlier(self, late: Point, row: int) -> bool:
        """The running boot's own frame."""
        first = self.points[row]
        if row > 0 and not first.flags & RESTART:
            return False
        if row == 0 and (self.packed or late.t_ns < self.since_ns):
            return False
        late.flags |= first.flags & RESTART
        first.flags &= ~RESTART
        if abs(first.north_m - late.north_m) + abs(first.east_m - late.east_m) > MOVING_M:
            first.moving_ms += (first.t_ns - late.t_ns) // NS_PER_MS
        if self.start_ns == self.boot_begin_ns:
            self.start_ns = late.t_ns
        self.boot_begin_ns = late.t_ns
        return True

    def _end_later(self, late: Point, row: int) -> bool:
        """The own frame of the boot before."""
        if row == 0:
            return False
        last = self.points[row - 1]
        if abs(last.north_m - late.north_m) + abs(last.east_m - late.east_m) > MOVING_M:
            late.moving_ms = (late.t_ns - last.t_ns) // NS_PER_MS
        return True

    def _is_settled(self, tip: Point, flags: int) -> bool:
        """True where the newest point is kept and a new one, with these flags, begins."""
        if flags & (BREAK | RESTART) or (flags ^ tip.flags) & DOUBTFUL:
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

    def _begin_point(self, tip: Point) -> Point:
        """A new tip; until it is estimated, it is shown where the last one was."""
        self.straight = StraightnessTest()
        begun = _continued(tip)
        self.points.append(begun)
        is_filled = tip.t_ns - self.filled_ns < FILLED_NS and len(self.points) < MOST_LOOSE
        if len(self.points) >= 2 * CHUNK and not is_filled:
            rows = rows_of(self.points[:CHUNK])
            self.packed.add(self.moved.inverse().apply_to_rows(rows, *_SHOWN), thinned)
            del self.points[:CHUNK]
        return begun


def _fixes_on_path(rows: Records, fixes: Records) -> Records:
    """Fixes of times at which the own path is known.  Others are of before it, whose beginning a
    journal may still bring, or of where it breaks.
    """
    if not len(rows):
        return fixes
    after = np.searchsorted(rows["t_ms"], fixes["t_ms"], side="right")
    near_ms = fixes["t_ms"] - rows["t_ms"][np.maximum(after - 1, 0)]
    breaks = np.append(rows["flags"] & (BREAK | RESTART), 0) != 0
    breaks[0] = True
    along: Records = fixes[~breaks[after] | (np.abs(near_ms) <= FIX_NEAR_MS)]
    return along


def _without_estimates(rows: Records) -> Records:
    unsaid = rows.copy()
    unsaid["shown_std_cm"] = 0
    return unsaid


def _point_of(position: Position, t_ns: int, flags: int) -> Point:
    point = Point(t_ns, flags=flags)
    _follow(point, position)
    return point


def _follow(point: Point, position: Position) -> None:
    """The point is where the own path is now."""
    point.north_m, point.east_m = position.north_m, position.east_m
    point.std_m = max(position.std_north_m, position.std_east_m)
    point.heading_rad = position.heading_rad


def _set_live_estimate(point: Point, estimate: Estimate, floor: int | None) -> None:
    """Set the live estimate of a point; a place that is only assumed counts as unknown."""
    point.shown_north_m, point.shown_east_m = estimate.north_m, estimate.east_m
    stated_m = max(estimate.std_north_m, estimate.std_east_m)
    point.shown_std_m = 0.0 if estimate.assumed else stated_m
    point.shown_down_m, point.shown_down_std_m = estimate.down_m, estimate.std_down_m
    point.floor = NO_FLOOR if floor is None else floor


def _continued(point: Point) -> Point:
    """A point about which nothing is known but where a neighbour was shown."""
    return Point(
        shown_north_m=point.shown_north_m,
        shown_east_m=point.shown_east_m,
        shown_std_m=point.shown_std_m,
        shown_down_m=point.shown_down_m,
        shown_down_std_m=point.shown_down_std_m,
        floor=point.floor,
    )
