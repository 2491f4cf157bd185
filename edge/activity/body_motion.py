"""Motion of the wearer, from the inertial samples alone.

A no-motion alarm must not depend on a tracker that may have lost its way, so this looks only
at how much the samples vary within short windows.  A unit on the foot sees steps, kicks and
shifting weight; it does not see arms.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from edge.samples import Floats, ImuBatch
from shared.clock import NS_PER_S

WINDOW_NS = NS_PER_S // 2
_ENOUGH_SAMPLES = 5

# Spread within a window, root of the summed variances of three axes: several times what
# MEMS sensors show at rest, far below what any step shows.
_MOVING_ACCEL_MPS2 = 0.4
_MOVING_GYRO_RADPS = 0.12
_ROTATED_COS = 0.99  # the mean specific force has turned by 8 degrees since the window before


@dataclass(frozen=True, slots=True, eq=False)
class BodyMotionWindow:
    """Summary of half a second of samples."""

    end_ns: int
    moving: bool
    force_mps2: Floats  # (3,) mean specific force, sensor axes
    peak_rate_radps: float


class BodyMotion:
    """Cuts the samples into windows of half a second, however they are batched.

    The accelerometer is enough: a gyroscope that fails must not hide that its wearer lies still.
    """

    def __init__(self) -> None:
        self._cell: int | None = None
        self._parts: list[Floats] = []  # (m, 6) accel, gyro of the window not yet full
        self._force_before_mps2: Floats | None = None
        self._still_ns = 0
        self._moving_ns = 0

    @property
    def motionless_s(self) -> float:
        """Time without motion; windows without usable samples do not count either way."""
        return self._still_ns / NS_PER_S

    @property
    def moving_s(self) -> float:
        """Time with motion, all in all."""
        return self._moving_ns / NS_PER_S

    def note_motion(self) -> None:
        """Begin the time without motion anew: the wearer has pressed the button."""
        self._still_ns = 0

    def push(self, imu: ImuBatch) -> list[BodyMotionWindow]:
        """Take samples; return the windows that they complete."""
        windows = []
        for part in by_window(imu):
            cell = int(part.t_ns[0]) // WINDOW_NS
            if cell != self._cell:
                window = self._close_window()
                if window is not None:
                    windows.append(window)
                self._cell = cell
            self._parts.append(np.hstack((part.accel_mps2, part.gyro_radps)))
        return windows

    def _close_window(self) -> BodyMotionWindow | None:
        if self._cell is None:
            return None
        samples = np.vstack(self._parts)
        self._parts = []
        accel_mps2, gyro_radps = _finite_rows(samples[:, :3]), _finite_rows(samples[:, 3:])
        if len(accel_mps2) < _ENOUGH_SAMPLES:
            return None
        force_mps2 = accel_mps2.mean(axis=0)
        moving = (
            _spread(accel_mps2) > _MOVING_ACCEL_MPS2
            or _spread(gyro_radps) > _MOVING_GYRO_RADPS
            or self._has_rotated(force_mps2)
        )
        self._force_before_mps2 = force_mps2
        self._still_ns = 0 if moving else self._still_ns + WINDOW_NS
        self._moving_ns += WINDOW_NS if moving else 0
        peak_radps = float(np.linalg.norm(gyro_radps, axis=1).max(initial=0.0))
        return BodyMotionWindow((self._cell + 1) * WINDOW_NS, moving, force_mps2, peak_radps)

    def _has_rotated(self, force_mps2: Floats) -> bool:
        before = self._force_before_mps2
        return before is not None and cosine(before, force_mps2) < _ROTATED_COS


def _finite_rows(vectors: Floats) -> Floats:
    """Return those (n, 3) that were not missed."""
    return np.asarray(vectors[np.isfinite(vectors).all(axis=1)])


def _spread(vectors: Floats) -> float:
    """Root of the summed variances; 0 of too few, as of a gyroscope that has failed."""
    return float(np.sqrt(vectors.var(axis=0).sum())) if len(vectors) >= _ENOUGH_SAMPLES else 0.0


def by_window(imu: ImuBatch) -> Iterator[ImuBatch]:
    """Yield the samples of each window by themselves; none is empty."""
    borders = np.flatnonzero(np.diff(imu.t_ns // WINDOW_NS)) + 1
    for start, stop in pairwise((0, *borders.tolist(), len(imu))):
        if start < stop:
            yield imu.part(slice(start, stop))


def cosine(first: Floats, second: Floats) -> float:
    """Return the cosine of the angle between two vectors (3,); 1 where one of them is zero."""
    lengths = float(np.linalg.norm(first) * np.linalg.norm(second))
    return float(first @ second) / lengths if lengths > 0.0 else 1.0
