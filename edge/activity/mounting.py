"""Mounting check: whether the inertial samples are those of a sensor on a foot.

A foot rests on the ground once a stride while the wearer walks, and swings faster than any other
part of the body.  A unit in a pocket, on the hip, the chest or the back, in a hand or loose in a
vehicle moves without either.
"""

from __future__ import annotations

import numpy as np

from edge.samples import Floats, ImuBatch
from shared.clock import NS_PER_S

WINDOW_NS = 6 * NS_PER_S // 5  # a stride of a slow walk
WINDOWS_TO_DECIDE = 6  # of motion: 14 steps at two steps a second
_ENOUGH_SAMPLES = 20
_MOTION_MPS2 = 1.0  # spread of the specific force's magnitude within a window
_SWING_RADPS = 5.0  # 95th percentile of a window; thighs reach 4 in a walk, feet pass 6
_SWING_PERCENTILE = 95.0
_REST_RADPS = 0.2  # a foot on the ground turns more slowly
_REST_S = 0.16  # the shortest stance of a walk


class MountingCheck:
    """Counts windows of motion for and against a foot, however the samples are batched.

    Windows without a swing and without a rest count against it, others for it, up to
    ``WINDOWS_TO_DECIDE``: so many change the verdict in either direction.
    """

    def __init__(self) -> None:
        self._cell: int | None = None
        self._parts: list[Floats] = []  # (m, 3) time in s, |force|, |rate| of the open window
        self._against = 0
        self._is_on_foot = True

    @property
    def is_on_foot(self) -> bool:
        """True until enough motion has contradicted it."""
        return self._is_on_foot

    def push(self, imu: ImuBatch) -> None:
        """Take samples in order."""
        cells = imu.t_ns // WINDOW_NS
        rows = np.column_stack(
            (
                imu.t_ns / NS_PER_S,
                np.linalg.norm(imu.accel_mps2, axis=1),
                np.linalg.norm(imu.gyro_radps, axis=1),
            )
        )
        for part in np.split(np.arange(len(imu)), np.flatnonzero(np.diff(cells)) + 1):
            if not len(part):
                continue
            cell = int(cells[part[0]])
            if cell != self._cell:
                self._close_window()
                self._cell = cell
            self._parts.append(rows[part])

    def _close_window(self) -> None:
        if not self._parts:
            return
        rows = np.vstack(self._parts)
        self._parts = []
        rows = rows[np.isfinite(rows).all(axis=1)]
        if len(rows) < _ENOUGH_SAMPLES or rows[:, 1].std() < _MOTION_MPS2:
            return
        self._against += -1 if _shows_foot(rows[:, 0], rows[:, 2]) else 1
        self._against = min(max(self._against, 0), WINDOWS_TO_DECIDE)
        if self._against in (0, WINDOWS_TO_DECIDE):
            self._is_on_foot = self._against == 0


def _shows_foot(t_s: Floats, rate_radps: Floats) -> bool:
    """Return True where a window (n,) of motion has a swing or a rest of a foot."""
    if np.percentile(rate_radps, _SWING_PERCENTILE) >= _SWING_RADPS:
        return True
    resting = np.concatenate(([False], rate_radps < _REST_RADPS, [False]))
    borders = np.flatnonzero(np.diff(resting))
    starts, stops = borders[::2], borders[1::2] - 1
    return bool((t_s[stops] - t_s[starts]).max(initial=0.0) >= _REST_S)
