"""Lines to walk along."""

from __future__ import annotations

from math import atan2, cos, hypot, pi, remainder, sin

import numpy as np

from edge.simulation.legs import Point


def arc(middle: Point, radius_m: float, start_rad: float, end_rad: float) -> tuple[Point, ...]:
    """Points about half a metre apart after the first one, angles clockwise from north."""
    count = max(2, round(abs(end_rad - start_rad) * radius_m / 0.5))
    angles = (start_rad + (end_rad - start_rad) * k / count for k in range(1, count + 1))
    return tuple((middle[0] + radius_m * cos(a), middle[1] + radius_m * sin(a)) for a in angles)


class Polyline:
    """A line through points, by the distance along it."""

    def __init__(self, points: tuple[Point, ...]) -> None:
        self._points = np.array(points)
        steps_m = np.hypot(*np.diff(self._points, axis=0).T)
        self._along_m = np.concatenate(([0.0], np.cumsum(steps_m)))

    @property
    def length_m(self) -> float:
        return float(self._along_m[-1])

    def point(self, along_m: float) -> Point:
        return (
            float(np.interp(along_m, self._along_m, self._points[:, 0])),
            float(np.interp(along_m, self._along_m, self._points[:, 1])),
        )

    def heading_rad(self, along_m: float, reach_m: float) -> float:
        """Direction of the chord around a place, so that corners are rounded."""
        behind = self.point(max(0.0, along_m - reach_m))
        ahead = self.point(min(self.length_m, along_m + reach_m))
        return atan2(ahead[1] - behind[1], ahead[0] - behind[0])


def split_at_sharp_turns(
    start: Point, to: tuple[Point, ...], sharp_rad: float
) -> tuple[Polyline, ...]:
    """Lines that turn by less than ``sharp_rad``, each starting where the one before ended."""
    lines: list[tuple[Point, ...]] = []
    line: tuple[Point, ...] = (start,)
    heading_rad: float | None = None
    for point in to:
        north_m, east_m = point[0] - line[-1][0], point[1] - line[-1][1]
        if hypot(north_m, east_m) < 0.01:
            continue
        next_rad = atan2(east_m, north_m)
        if heading_rad is not None and (
            abs(remainder(next_rad - heading_rad, 2.0 * pi)) > sharp_rad
        ):
            lines.append(line)
            line = (line[-1],)
        line = (*line, point)
        heading_rad = next_rad
    return tuple(Polyline(points) for points in (*lines, line) if len(points) > 1)
