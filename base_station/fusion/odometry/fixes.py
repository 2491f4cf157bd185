"""The satellite fixes that were taken along a path, thinned and packed."""

from __future__ import annotations

from bisect import bisect_left

import msgspec
import numpy as np

from base_station.fusion.interface import MAX_FIX_DISTANCE_M, PlaceFix
from base_station.fusion.odometry.packed_rows import CHUNK, Packed, Records
from base_station.fusion.odometry.points import FIX_ROW, fix_row
from base_station.fusion.odometry.rigid_transform import RigidTransform2D
from shared.clock import NS_PER_MS

APART_MS = 2000  # their errors are much the same meanwhile
_SEEN = "north_cm", "east_cm"


class PathFixes(msgspec.Struct, array_like=True):
    """``frame``: how the incident frame has moved since anything was packed."""

    packed: Packed = msgspec.field(default_factory=Packed)
    loose: bytes = b""  # rows by time: late fixes, out of a journal, come between live ones

    def __bool__(self) -> bool:
        return bool(self.loose or self.packed)

    def append(self, fix: PlaceFix, t_ns: int, frame: RigidTransform2D) -> None:
        """Append a fix, unless there is one close in time."""
        times_ms, t_ms = self._loose()["t_ms"].tolist(), t_ns // NS_PER_MS
        at = bisect_left(times_ms, t_ms)
        if any(abs(near_ms - t_ms) < APART_MS for near_ms in times_ms[max(at - 1, 0) : at + 1]):
            return
        before, behind = self.loose[: at * FIX_ROW.itemsize], self.loose[at * FIX_ROW.itemsize :]
        self.loose = before + fix_row(fix, t_ns).tobytes() + behind
        rows = self._loose()
        if len(rows) > CHUNK:
            self.packed.add(
                frame.inverse().apply_to_rows(rows[:CHUNK], *_SEEN), lambda rows: rows[::2]
            )
            self.loose = rows[CHUNK:].tobytes()

    def trim(self, before_ms: int) -> None:
        self.packed.cut(before_ms, FIX_ROW)
        rows = self._loose()
        self.loose = rows[rows["t_ms"] >= before_ms].tobytes()

    def reframe(self, move: RigidTransform2D) -> None:
        """The frame moves; what is packed stays as it is."""
        self.loose = move.apply_to_rows(self._loose(), *_SEEN).tobytes()

    def move(self, move: RigidTransform2D, frame: RigidTransform2D) -> None:
        """Move all fixes in the incident frame."""
        self.reframe(move)
        self.packed.change(
            FIX_ROW,
            lambda rows: frame.inverse().apply_to_rows(
                move.apply_to_rows(frame.apply_to_rows(rows, *_SEEN), *_SEEN), *_SEEN
            ),
        )

    def rows(self, frame: RigidTransform2D) -> Records:
        """Rows by time, thinned, as late ones may lie beside packed ones. Without those that the
        present anchor puts too far away; another anchor may correct them.
        """
        rows = np.concatenate(
            (frame.apply_to_rows(self.packed.rows(FIX_ROW), *_SEEN), self._loose())
        )
        off_m = np.hypot(*(rows[axis] / 100.0 for axis in _SEEN))
        rows = rows[off_m <= MAX_FIX_DISTANCE_M]
        rows = rows[np.argsort(rows["t_ms"], kind="stable")]
        kept, last_ms = [], -APART_MS
        for row, t_ms in enumerate(rows["t_ms"].tolist()):
            if t_ms - last_ms >= APART_MS:
                kept.append(row)
                last_ms = t_ms
        return rows[kept]

    def _loose(self) -> Records:
        return np.frombuffer(self.loose, FIX_ROW)
