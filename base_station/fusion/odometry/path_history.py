"""One unit's own path since an incident began, thinned, with the satellite fixes that were taken.

Times are the station's, so that a unit that starts again, or whose clock is judged better later,
goes on in the same history.
"""

from __future__ import annotations

import msgspec
import numpy as np

from base_station.fusion.interface import Estimate, PlaceFix, Start
from base_station.fusion.odometry.fixes import PathFixes
from base_station.fusion.odometry.late_points import insert_late
from base_station.fusion.odometry.noise_runs import NoiseRun, cut_runs, end_run
from base_station.fusion.odometry.packed_rows import Records
from base_station.fusion.odometry.path_runs import FrameStart, PathRuns
from base_station.fusion.odometry.points import BREAK, DOUBTFUL, RESTART, PathArrays, arrays_of
from base_station.fusion.odometry.rigid_transform import RigidTransform2D
from base_station.fusion.odometry.start_correction import StartCorrection
from base_station.fusion.odometry.thinned_path import ThinnedPath
from shared.clock import NS_PER_MS
from shared.messages import Position
from shared.path_noise import PathNoise
from shared.quality import GOOD

FIX_NEAR_MS = 1000  # a fix so near to where a path begins or breaks was taken there


class LatestEstimate(msgspec.Struct, array_like=True):
    """Parts of the newest estimate without pins that no point keeps."""

    since_gps_s: float | None = None
    floor: int | None = None
    height_assumed: bool = False  # nothing has shown how high the path begins


class PathHistory(msgspec.Struct):
    """Path of a unit with its runs, its fixes and its start, and what is to be solved again."""

    own: ThinnedPath = msgspec.field(default_factory=ThinnedPath)
    runs: PathRuns = msgspec.field(default_factory=PathRuns)
    fixes: PathFixes = msgspec.field(default_factory=PathFixes)
    start: FrameStart = msgspec.field(default_factory=FrameStart)
    path_noise: PathNoise | None = None  # as the unit's tracker states it last
    noise_runs: list[NoiseRun] = msgspec.field(default_factory=list)  # before, as it stated then
    latest: LatestEstimate = msgspec.field(default_factory=LatestEstimate)
    moved: RigidTransform2D = RigidTransform2D()  # the frame, since anything was packed
    awaited_ns: int | None = None  # a pin waits for the path to come to this time
    is_refixed: bool = False  # fixes were moved: the unit is to be placed again
    is_renumbered: bool = False  # storeys have other numbers: those of the trail are to follow

    @property
    def begin_ns(self) -> int | None:
        return self.own.begin_ns

    @property
    def end_ns(self) -> int | None:
        points = self.own.points
        return points[-1].t_ns if points else None

    @property
    def shown_m(self) -> tuple[float, float] | None:
        """North and east as last estimated without any pin."""
        points = self.own.points
        return (points[-1].shown_north_m, points[-1].shown_east_m) if points else None

    @property
    def is_awaited(self) -> bool:
        """The path has come to where a pin waits for it."""
        return self.awaited_ns is not None and (self.end_ns or 0) >= self.awaited_ns

    @property
    def is_before_incident(self) -> bool:
        """True where no point is newer than the opening of the incident."""
        return self.end_ns is not None and self.end_ns < self.runs.opened_ns

    def for_next_boot(self) -> PathHistory:
        """Empty history for the next run, after the known run is over."""
        runs = self.runs
        return PathHistory(runs=PathRuns(since_ns=runs.since_ns, opened_ns=runs.opened_ns))

    def append(self, position: Position, t_ns: int, jumped: bool) -> bool:
        """Append a position; ``jumped``: it does not join the path. True where the path begins with
        it.
        """
        own, boot_id = self.own, position.header.boot_id
        t_ns = own.apart_ns(t_ns)
        self._set_path_noise(position.path_noise)
        restarted = False
        if boot_id != self.runs.boot_id:
            restarted = self._begin_run(boot_id, t_ns)
        flags = RESTART if restarted else BREAK * jumped
        joins, begins = not flags, not own.points
        if position.path_quality is not GOOD:
            flags |= DOUBTFUL
        own.append(position, t_ns, flags, joins=joins, frame=self.moved)
        return begins

    def insert_late(
        self, position: Position, t_ns: int, estimate: Estimate, floor: int | None
    ) -> None:
        """Insert a late position with its estimate without pins, where no point is near."""
        running_ns = self.runs.begin_ns
        insert_late(self.own, self.runs, position, t_ns, estimate, floor)
        if self.start.begin_ns == running_ns:
            self.start.begin_ns = self.runs.begin_ns  # an earlier point may have come late

    def set_live_estimate(self, estimate: Estimate, floor: int | None) -> None:
        """Set the estimate without pins at the newest point."""
        latest, points = self.latest, self.own.points
        latest.since_gps_s, latest.floor = estimate.since_gps_s, floor
        latest.height_assumed = estimate.height_assumed
        if points:
            points[-1].set_live_estimate(estimate, floor)

    def set_start(self, start: Start) -> None:
        """Set the start position of the running boot's own frame."""
        self.start.set(start, self.runs.begin_ns)
        self.latest.height_assumed = False

    def drop_fixes(self) -> None:
        """Drop all fixes, and the runs before the running boot."""
        self._cut(self.runs.begin_ns)
        self.fixes, self.latest.since_gps_s, self.is_refixed = PathFixes(), None, False

    def apply_start_correction(self, correction: StartCorrection) -> None:
        """Correct the live estimates of a run whose start position was set."""
        self.own.correct_start(correction, self.moved)

    def begin_incident(self, opened_ns: int, since_ns: int) -> None:
        """Keep only the run that goes on in the incident, from ``since_ns`` on: earlier runs do not
        show where it began.
        """
        runs = self.runs
        runs.opened_ns, runs.since_ns = opened_ns, since_ns
        self._cut(max(since_ns, runs.begin_ns))
        self.start.is_over |= self.start.begin_ns < runs.begin_ns

    def fix(self, fix: PlaceFix, t_ns: int) -> None:
        """Add an accepted fix, unless there is one close in time."""
        self.fixes.append(fix, t_ns, self.moved)

    def reframe(self, turn_rad: float, north_m: float, east_m: float, down_m: float) -> None:
        """The incident frame was moved: turned clockwise, then shifted."""
        move = RigidTransform2D(turn_rad, north_m, east_m, down_m)
        self.moved = self.moved.followed_by(move)
        self.fixes.reframe(move)
        self.own.reframe(move)
        self.start.reframe(move)

    def move_fixes(self, turn_rad: float, north_m: float, east_m: float) -> bool:
        """Move the fixes in the incident frame and drop live estimates made with them; False
        without fixes.
        """
        if not self.fixes:
            return False
        self.fixes.move(RigidTransform2D(turn_rad, north_m, east_m), self.moved)
        self.own.drop_estimates()
        self.is_refixed = True
        return True

    def arrays(self) -> PathArrays:
        """Path and fixes in SI units; packed points are rounded to a centimetre and a
        millisecond.
        """
        rows = self.own.rows(self.moved)
        return arrays_of(rows, _fixes_on_path(rows, self.fixes.rows(self.moved)))

    def _set_path_noise(self, noise: PathNoise | None) -> None:
        """The unit states this noise of its path from now on."""
        if noise != self.path_noise and self.end_ns is not None:
            end_run(self.noise_runs, self.end_ns, self.path_noise)
        self.path_noise = noise

    def _begin_run(self, boot_id: int, t_ns: int) -> bool:
        """The unit's program was started; in an incident, runs that were over before go. True where
        the path goes on from a run before.
        """
        own, runs, is_first = self.own, self.runs, not self.runs.boot_id
        if is_first:
            self.start.begin_ns = t_ns
        elif own.points and own.points[-1].t_ns < runs.opened_ns:
            self._cut(runs.opened_ns)
        follows = bool(own.points)
        self.start.is_over |= not is_first and not follows
        runs.begin(boot_id, t_ns, follows=follows)
        return follows

    def _cut(self, before_ns: int) -> None:
        """Drop points before a time, to the millisecond as they are packed: a run that began then
        stays whole.
        """
        before_ms = before_ns // NS_PER_MS
        self.noise_runs = cut_runs(self.noise_runs, before_ms * NS_PER_MS)
        self.own.cut(before_ms)
        self.fixes.trim(before_ms)


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
