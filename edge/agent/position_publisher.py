"""Publisher of positions: tracker rows as Position messages, at the configured rate."""

from __future__ import annotations

import math
from bisect import bisect_right

import numpy as np

from edge.agent.decimation import Decimator
from edge.agent.uncorrected_path import UncorrectedPath
from edge.clocks.timeline import Timeline
from edge.samples import ImuBatch
from edge.tracker.interface import Quality, Reason, TrackBatch
from shared.clock import NS_PER_S
from shared.header_factory import HeaderFactory
from shared.messages import MagneticNorth, Position
from shared.path_noise import PathNoise

_PRESSURE_KEPT_NS = 3 * NS_PER_S  # longer than a tracker delays rows
_HEADING_BASE_M = 0.5  # over a shorter distance the direction is inaccurate
_STOREY_M = 3.0
_NORTH_STD_MAX_RAD = 0.8  # of magnetic north; beyond that it is not published
_STOREY_HYSTERESIS_M = 0.5


class PositionPublisher:
    """Publisher that decimates rows by their own time, so that batching changes nothing."""

    def __init__(self, header_factory: HeaderFactory, rate_hz: float) -> None:
        self._header_factory = header_factory
        self._times = Decimator(rate_hz)
        self._uncorrected = UncorrectedPath()
        self._pressures: list[tuple[int, float]] = []
        self._heading_from_m = (0.0, 0.0)
        self._heading_rad = 0.0
        self._quality = Quality.UNKNOWN
        self._reasons = Reason.NONE
        self._is_on_foot = True
        self._path_noise: PathNoise | None = None
        self.rows_dropped = 0  # rows that were no numbers
        self.floors_climbed = 0

    def set_rate(self, rate_hz: float) -> None:
        self._times.set_rate(rate_hz)

    def set_mounting(self, *, is_on_foot: bool) -> None:
        """Set whether the unit is worn where its tracker needs it: if not, positions are lost."""
        self._is_on_foot = is_on_foot

    def set_path_noise(self, noise: PathNoise | None) -> None:
        """Set the process noise that the tracker states of the rows to come."""
        self._path_noise = noise

    def take_pressure(self, imu: ImuBatch) -> None:
        if imu.pressure_pa is None or not len(imu):
            return
        for pair in zip(imu.t_ns.tolist(), imu.pressure_pa.tolist(), strict=True):
            if math.isfinite(pair[1]):
                while self._pressures and pair[0] <= self._pressures[-1][0]:
                    self._pressures.pop()  # the clock was set back
                self._pressures.append(pair)

    def push(self, track: TrackBatch, timeline: Timeline) -> list[Position]:
        """Return the positions to publish among these rows."""
        usable = np.isfinite(track.position_n_m).all(axis=1)
        usable &= np.isfinite(track.velocity_n_mps).all(axis=1)
        usable &= np.isfinite(track.position_cov_m2).all(axis=(1, 2))
        self.rows_dropped += int(len(track) - usable.sum())
        kept = np.flatnonzero(usable)
        rows = self._uncorrected.take(track.part(kept))
        picked = self._times.picks(rows.t_ns)
        qualities = self._worst_quality(track, kept[picked].tolist())
        positions = [
            self._position(rows, row, timeline, quality)
            for row, quality in zip(picked, qualities, strict=True)
        ]
        if self._pressures:
            oldest_ns = self._pressures[-1][0] - _PRESSURE_KEPT_NS
            self._pressures = [pair for pair in self._pressures if pair[0] >= oldest_ns]
        return positions

    def _worst_quality(self, track: TrackBatch, picked: list[int]) -> list[tuple[Quality, Reason]]:
        """Return for each picked row the worst quality and all reasons since the one picked
        before it.

        Otherwise a fault of a few samples would be lost between two positions.
        """
        qualities = []
        start = 0
        for stop in [*(row + 1 for row in picked), len(track)]:
            rows = slice(start, stop)
            worst = int(track.quality[rows].max(initial=int(Quality.UNKNOWN)))
            quality = max(self._quality, Quality(worst))
            reasons = self._reasons | Reason(int(np.bitwise_or.reduce(track.reasons[rows])))
            if not self._is_on_foot:
                quality, reasons = Quality.LOST, reasons | Reason.NOT_ON_FOOT
            qualities.append((quality, reasons))
            self._quality, self._reasons = Quality.UNKNOWN, Reason.NONE
            start = stop
        self._quality, self._reasons = qualities.pop()  # goes with the next position
        return qualities

    def _position(
        self, track: TrackBatch, row: int, timeline: Timeline, quality: tuple[Quality, Reason]
    ) -> Position:
        t_ns = int(track.t_ns[row])
        north_m, east_m, down_m = track.position_n_m[row].tolist()
        velocity_mps = track.velocity_n_mps[row].tolist()
        covariance = track.position_cov_m2[row]
        std_m = np.sqrt(np.maximum(np.diag(covariance), 0.0)).tolist()
        self._turn(north_m, east_m)
        self._climb(-down_m)
        heading_std_rad = float(track.heading_std_rad[row])
        return Position(
            header=self._header_factory.header(timeline.to_mono_ns(t_ns)),
            north_m=north_m,
            east_m=east_m,
            down_m=down_m,
            velocity_north_mps=velocity_mps[0],
            velocity_east_mps=velocity_mps[1],
            velocity_down_mps=velocity_mps[2],
            std_north_m=std_m[0],
            std_east_m=std_m[1],
            std_down_m=std_m[2],
            correlation_ne=_correlation(float(covariance[0, 1]), std_m[0] * std_m[1]),
            heading_rad=self._heading_rad,
            heading_std_rad=heading_std_rad if math.isfinite(heading_std_rad) else math.pi,
            distance_m=float(track.distance_m[row]),
            pressure_pa=self._pressure_at(t_ns),
            stationary=bool(track.stationary[row]),
            quality=quality[0],
            reasons=quality[1],
            magnetic_north=_magnetic_north(track, row),
            path_noise=self._path_noise,
        )

    def _turn(self, north_m: float, east_m: float) -> None:
        """Update the heading of travel, which is that of the last half metre."""
        moved_north_m = north_m - self._heading_from_m[0]
        moved_east_m = east_m - self._heading_from_m[1]
        if math.hypot(moved_north_m, moved_east_m) >= _HEADING_BASE_M:
            self._heading_rad = math.atan2(moved_east_m, moved_north_m) % math.tau
            self._heading_from_m = (north_m, east_m)

    def _climb(self, height_m: float) -> None:
        """Count storeys, with a hysteresis so that a landing counts once."""
        off_m = height_m - self.floors_climbed * _STOREY_M
        if abs(off_m) > 0.5 * _STOREY_M + _STOREY_HYSTERESIS_M:
            self.floors_climbed = round(height_m / _STOREY_M)

    def _pressure_at(self, t_ns: int) -> float | None:
        """Return the last reading, unless it is too old: a barometer may fail."""
        after = bisect_right(self._pressures, (t_ns, math.inf))
        if not after:
            return None
        read_ns, pressure_pa = self._pressures[after - 1]
        return pressure_pa if t_ns - read_ns <= _PRESSURE_KEPT_NS else None


def _magnetic_north(track: TrackBatch, row: int) -> MagneticNorth | None:
    std_rad = float(track.magnetic_north_std_rad[row])
    if not std_rad < _NORTH_STD_MAX_RAD:
        return None
    return MagneticNorth(float(track.magnetic_north_rad[row]), std_rad)


def _correlation(covariance: float, product: float) -> float:
    return max(-1.0, min(1.0, covariance / product)) if product > 0.0 else 0.0
