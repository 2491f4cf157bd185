"""The satellite fixes that were taken along a path, thinned and packed."""

from __future__ import annotations

import msgspec
import numpy as np

from base_station.fusion.path.moved import Moved
from base_station.fusion.path.packed import CHUNK, Packed, Records
from base_station.fusion.path.points import FIX_ROW, fix_row
from base_station.fusion.port import PlaceFix
from shared.clock import NS_PER_MS, NS_PER_S

APART_NS = 2 * NS_PER_S  # their errors are much the same meanwhile
_SEEN = "north_cm", "east_cm"


class PathFixes(msgspec.Struct, array_like=True):
    """``frame``: how the incident frame has moved since anything was packed."""

    packed: Packed = msgspec.field(default_factory=Packed)
    loose: bytes = b""  # rows, behind the packed ones

    def __bool__(self) -> bool:
        return bool(self.loose or self.packed)

    def note(self, fix: PlaceFix, t_ns: int, frame: Moved) -> None:
        """Others close by tell the same."""
        rows = self._loose()
        if len(rows) and abs(t_ns - int(rows["t_ms"][-1]) * NS_PER_MS) < APART_NS:
            return
        if len(rows) > CHUNK:
            self.packed.add(frame.undone().of(rows[:CHUNK], *_SEEN), lambda rows: rows[::2])
            self.loose = rows[CHUNK:].tobytes()
        self.loose += fix_row(fix, t_ns).tobytes()

    def trim(self, before_ms: int) -> None:
        self.packed.cut(before_ms, FIX_ROW)
        rows = self._loose()
        self.loose = rows[rows["t_ms"] >= before_ms].tobytes()

    def reframe(self, move: Moved) -> None:
        """The frame moves; what is packed stays as it is."""
        self.loose = move.of(self._loose(), *_SEEN).tobytes()

    def move(self, move: Moved, frame: Moved) -> None:
        """They lie elsewhere in the incident frame."""
        self.reframe(move)
        self.packed.change(
            FIX_ROW,
            lambda rows: frame.undone().of(move.of(frame.of(rows, *_SEEN), *_SEEN), *_SEEN),
        )

    def rows(self, frame: Moved) -> Records:
        """All of them, in any order."""
        return np.concatenate((frame.of(self.packed.rows(FIX_ROW), *_SEEN), self._loose()))

    def _loose(self) -> Records:
        return np.frombuffer(self.loose, FIX_ROW)
