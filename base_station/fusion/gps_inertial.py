"""GPS and inertial path in one linear Kalman filter, whatever the initial heading.

The unit's path is known up to a turn, a scale and a shift.  With the complex number
``c + i s = k exp(i psi)`` (scale k, heading correction psi) an increment ``(dn, de)`` of the
unit's own path moves the wearer by

    north += c dn - s de        east += s dn + c de

which is *linear* in the state ``[north, east, c, s, b_n, b_e]``.  So an unknown heading needs
no bank of hypotheses and no linearisation: it starts as mean 0 with variance 1/2 (the moments
of a unit vector that points anywhere), the position then spreads as far as was walked, and the
first metres with satellite fixes turn the path into place.

``b`` is the slowly wandering part of the satellite fixes' error in units of their stated
standard deviation (first-order Gauss-Markov), so that a minute of fixes is not believed to
average it away.  A fix that comes late is an observation of the present state less the path
walked since: ``p(t) = p(now) - (walked since) (c, s)``.  Height is a filter of its own.
"""

from __future__ import annotations

import cmath
import math
from dataclasses import dataclass

import msgspec
import numpy as np
from filterpy.kalman import KalmanFilter
from numpy.typing import NDArray

from base_station.fusion.path_memory import PathMemory
from base_station.fusion.port import Estimate, FixVerdict, PlaceFix, Start
from shared.clock import NS_PER_S
from shared.geo import wrap_pi
from shared.messages import Position
from shared.quality import Quality

Floats = NDArray[np.float64]

_UNKNOWN_VAR_M2 = 1e8
_NAME = "gps-inertial"


@dataclass(frozen=True, slots=True)
class GpsInertial:
    """Parameters, and the kind that makes fusers of them."""

    name: str = _NAME
    walk_m_per_sqrt_m: float = 0.06  # the own path's error by distance, each axis
    turn_rad_per_sqrt_m: float = 0.004  # its heading's wander by distance
    turn_part: float = 0.004  # and by turning
    scale_std: float = 0.03
    climb_part: float = 0.03  # height error by height climbed
    climb_m_per_sqrt_m: float = 0.02  # and by distance
    wander_part: float = 0.7  # of a fix's variance that wanders slowly
    wander_s: float = 30.0  # with this correlation time
    gate: float = 13.8  # chi-square of 2 degrees of freedom, 99.9 %
    aligned_rad: float = 0.35  # heading standard deviation from which the heading is given
    scaled_rad: float = 0.12  # and from which the scale is tied down: linear only about there
    height_std_floor_m: float = 5.0
    fastest_mps: float = 12.0
    unguided_mps: float = 1.5  # how fast a wearer gets away while nothing is heard of the path
    stuck_fixes: int = 5
    stuck_m: float = 8.0
    distrust_most: int = 20
    return_fixes: int = 20  # so many that contradict the path but draw its shape are believed
    return_spread_m: float = 7.0  # root mean square of that stretch of path
    return_unlike: float = 0.25  # part of their variance that is not the shape of the walk

    def new(self) -> GpsInertialFuser:
        return GpsInertialFuser(self, _Memory())

    def restore(self, saved: bytes) -> GpsInertialFuser:
        return GpsInertialFuser(self, msgspec.msgpack.decode(saved, type=_Memory))


class _Outlier(msgspec.Struct, frozen=True, array_like=True):
    """A fix that the gate turned away: where it was, and where the own path was."""

    north_m: float
    east_m: float
    own_north_m: float
    own_east_m: float


class _Memory(msgspec.Struct):
    """Everything beside the two filters' numbers, and those when written out."""

    horizontal_x: list[float] = msgspec.field(default_factory=list)
    horizontal_p: list[list[float]] = msgspec.field(default_factory=list)
    vertical_x: list[float] = msgspec.field(default_factory=list)
    vertical_p: list[list[float]] = msgspec.field(default_factory=list)
    assumed: bool = True  # nothing but the own frame is known: shown about the unit's start
    aligned_once: bool = False
    restarted: bool = False
    last: Position | None = None
    last_step_rad: float | None = None  # direction of the last increment, own frame
    path: PathMemory = msgspec.field(default_factory=PathMemory)
    fix_t_mono_ns: int | None = None  # the newest accepted fix
    wander_t_mono_ns: int | None = None
    last_fix_m: tuple[float, float] | None = None
    same_fixes: int = 0
    same_since_m: float = 0.0  # distance walked when the fix last changed
    distrust: int = 0  # grows by one with a fix that does not fit, falls by two with one that does
    outliers: list[_Outlier] = msgspec.field(default_factory=list)
    surprise: float = 1.0  # how much worse fixes fit than they claim


class GpsInertialFuser:
    """One unit's filter; see the module's text."""

    def __init__(self, kind: GpsInertial, memory: _Memory) -> None:
        self._kind = kind
        self._memory = memory
        self._horizontal = KalmanFilter(dim_x=6, dim_z=2)
        self._vertical = KalmanFilter(dim_x=2, dim_z=1)
        if memory.horizontal_x:
            self._horizontal.x = np.array(memory.horizontal_x).reshape(6, 1)
            self._horizontal.P = np.array(memory.horizontal_p)
            self._vertical.x = np.array(memory.vertical_x).reshape(2, 1)
            self._vertical.P = np.array(memory.vertical_p)
        else:
            self._horizontal.x = np.array([[0.0], [0.0], [1.0], [0.0], [0.0], [0.0]])
            self._horizontal.P = np.diag([0.0, 0.0, 0.0, 0.0, 1.0, 1.0])
            self._vertical.x = np.zeros((2, 1))
            self._vertical.P = np.diag([1.0, 1.0])

    def save(self) -> bytes:
        memory = self._memory
        memory.horizontal_x = self._horizontal.x.ravel().tolist()
        memory.horizontal_p = self._horizontal.P.tolist()
        memory.vertical_x = self._vertical.x.ravel().tolist()
        memory.vertical_p = self._vertical.P.tolist()
        return msgspec.msgpack.encode(memory)

    def start(self, start: Start) -> None:
        x, covariance = self._horizontal.x, self._horizontal.P
        x[:4, 0] = start.north_m, start.east_m, *_mean_heading(start)
        covariance[:4, :] = 0.0
        covariance[:, :4] = 0.0
        covariance[0, 0] = covariance[1, 1] = start.std_m**2
        covariance[2:4, 2:4] = _heading_covariance(start, self._kind.scale_std)
        self._vertical.x[0, 0] = start.down_m
        self._vertical.P[:] = np.diag([start.std_m**2, 1.0])
        memory = self._memory
        memory.assumed = False
        memory.aligned_once = start.heading_std_rad < self._kind.scaled_rad
        memory.outliers.clear()
        if memory.last is not None:
            self._walk(memory.last.north_m, memory.last.east_m, memory.last.down_m, 0.0)

    def advance(self, position: Position) -> str:
        memory, last = self._memory, self._memory.last
        t_ns = position.header.t_mono_ns
        if last is None:
            self._walk(position.north_m, position.east_m, position.down_m, 0.0)
        elif last.header.boot_id != position.header.boot_id:
            self._restart(position)
        else:
            duration_s = (t_ns - last.header.t_mono_ns) / NS_PER_S
            if duration_s < 0.0:
                return "older than the last position"
            north_m, east_m = position.north_m - last.north_m, position.east_m - last.east_m
            if math.hypot(north_m, east_m) > self._kind.fastest_mps * max(duration_s, 0.2) + 1.0:
                self._spread(self._kind.unguided_mps * duration_s)
                memory.last, memory.path = position, PathMemory()
                return "the unit's own path jumped"
            extra_m2 = max(0.0, _variance(position) - _variance(last))
            doubtful = position.quality is not Quality.GOOD
            self._walk(
                north_m, east_m, position.down_m - last.down_m, extra_m2 if doubtful else 0.0
            )
        memory.last = position
        memory.path.note(t_ns, position.north_m, position.east_m)
        return ""

    def correct(self, fix: PlaceFix) -> FixVerdict:
        if self._is_stuck(fix):
            return FixVerdict(False, "the receiver is stuck")
        then = self._memory.path.at(fix.t_mono_ns)
        if isinstance(then, str):
            return FixVerdict(False, then)
        if self._memory.assumed:
            self._leave_own_frame()
        own_north_m, own_east_m = self._own()
        since_north_m, since_east_m = own_north_m - then[0], own_east_m - then[1]
        std_m = fix.horizontal_std_m
        wander = std_m * math.sqrt(self._kind.wander_part)
        self._let_wander(fix.t_mono_ns)
        observe = np.array(
            [
                [1.0, 0.0, -since_north_m, since_east_m, wander, 0.0],
                [0.0, 1.0, -since_east_m, -since_north_m, 0.0, wander],
            ]
        )
        white_m2 = self._memory.surprise * std_m**2 * (1.0 - self._kind.wander_part)
        white_m2 += self._unguided_m2(fix.t_mono_ns)
        noise = np.eye(2) * white_m2
        place = np.array([[fix.north_m], [fix.east_m]])
        innovation = place - observe @ self._horizontal.x
        spread = observe @ self._horizontal.P @ observe.T + noise
        distance2 = float((innovation.T @ np.linalg.solve(spread, innovation))[0, 0])
        if distance2 > self._kind.gate:
            return self._turned_away(fix, then)
        if self._memory.distrust > 0:
            self._memory.distrust -= 2
            return FixVerdict(False, "fits, but the receiver was wrong just before")
        self._memory.outliers.clear()
        surprise = self._memory.surprise * (1.0 + 0.05 * (distance2 / 2.0 - 1.0))
        self._memory.surprise = min(4.0, max(1.0, surprise))
        self._horizontal.update(place, R=noise, H=observe)
        self._correct_height(fix)
        self._note_alignment()
        self._memory.fix_t_mono_ns = max(fix.t_mono_ns, self._memory.fix_t_mono_ns or 0)
        return FixVerdict(True)

    def reframe(self, turn_rad: float, north_m: float, east_m: float, down_m: float) -> None:
        cosine, sine = math.cos(turn_rad), math.sin(turn_rad)
        turn = np.array([[cosine, -sine], [sine, cosine]])
        whole = np.kron(np.eye(3), turn)
        self._horizontal.x = whole @ self._horizontal.x
        self._horizontal.x[:2, 0] += north_m, east_m
        self._horizontal.P = whole @ self._horizontal.P @ whole.T
        self._vertical.x[0, 0] += down_m
        self._memory.outliers.clear()

    def estimate(self) -> Estimate | None:
        memory = self._memory
        if memory.last is None and memory.fix_t_mono_ns is None:
            return None
        last = memory.last
        t_mono_ns = max(last.header.t_mono_ns if last else 0, memory.fix_t_mono_ns or 0)
        return self._estimate_at(
            t_mono_ns,
            last.heading_rad if last else 0.0,
            self._horizontal.x[:2, 0],
            self._horizontal.P[:2, :2],
            float(self._vertical.x[0, 0]),
            float(self._vertical.P[0, 0]),
        )

    def recall(self, position: Position) -> Estimate | None:
        """The path from then to now is taken back from the present place, with the heading and
        scale that are believed now.
        """
        last, kind = self._memory.last, self._kind
        if last is None or last.header.boot_id != position.header.boot_id:
            return None
        north_m, east_m = last.north_m - position.north_m, last.east_m - position.east_m
        back = np.array(
            [
                [1.0, 0.0, -north_m, east_m, 0.0, 0.0],
                [0.0, 1.0, -east_m, -north_m, 0.0, 0.0],
            ]
        )
        walked_m = abs(last.distance_m - position.distance_m)
        climbed_m = last.down_m - position.down_m
        climbed_m2 = kind.climb_part**2 * abs(climbed_m) + kind.climb_m_per_sqrt_m**2 * walked_m
        return self._estimate_at(
            position.header.t_mono_ns,
            position.heading_rad,
            (back @ self._horizontal.x)[:, 0],
            back @ self._horizontal.P @ back.T + np.eye(2) * kind.walk_m_per_sqrt_m**2 * walked_m,
            float(self._vertical.x[0, 0]) - climbed_m,
            float(self._vertical.P[0, 0]) + climbed_m2,
        )

    def _estimate_at(
        self,
        t_mono_ns: int,
        own_heading_rad: float,
        place_m: Floats,
        variances: Floats,
        down_m: float,
        down_var_m2: float,
    ) -> Estimate:
        memory = self._memory
        std_north_m, std_east_m = math.sqrt(variances[0, 0]), math.sqrt(variances[1, 1])
        product = std_north_m * std_east_m
        turn_rad, turn_std_rad = self._turn()
        since_s = None
        if memory.fix_t_mono_ns is not None:
            since_s = max(0.0, (t_mono_ns - memory.fix_t_mono_ns) / NS_PER_S)
        quality, reason = self._quality(math.hypot(std_north_m, std_east_m), turn_std_rad)
        return Estimate(
            t_mono_ns=t_mono_ns,
            north_m=float(place_m[0]),
            east_m=float(place_m[1]),
            down_m=down_m,
            std_north_m=std_north_m,
            std_east_m=std_east_m,
            std_down_m=math.sqrt(down_var_m2),
            correlation_ne=float(variances[0, 1]) / product if product > 0.0 else 0.0,
            heading_rad=(turn_rad + own_heading_rad) % (2.0 * math.pi),
            heading_std_rad=turn_std_rad,
            quality=quality,
            quality_reason=reason,
            since_gps_s=since_s,
        )

    def _walk(self, north_m: float, east_m: float, down_m: float, extra_m2: float) -> None:
        """Predict: the own path went on by this much."""
        kind = self._kind
        length_m = math.hypot(north_m, east_m)
        move = np.eye(6)
        move[0, 2], move[0, 3] = north_m, -east_m
        move[1, 2], move[1, 3] = east_m, north_m
        noise = np.zeros((6, 6))
        noise[0, 0] = noise[1, 1] = kind.walk_m_per_sqrt_m**2 * length_m + extra_m2
        c, s = float(self._horizontal.x[2, 0]), float(self._horizontal.x[3, 0])
        turn_var = kind.turn_rad_per_sqrt_m**2 * length_m
        turn_var += (kind.turn_part * self._turned(north_m, east_m, length_m)) ** 2
        noise[2, 2], noise[3, 3] = turn_var * s * s, turn_var * c * c
        noise[2, 3] = noise[3, 2] = -turn_var * c * s
        self._horizontal.predict(F=move, Q=noise)
        self._vertical.x[0, 0] += down_m
        climbed_m2 = (kind.climb_part**2) * abs(down_m) + kind.climb_m_per_sqrt_m**2 * length_m
        self._vertical.P[0, 0] += climbed_m2

    def _turned(self, north_m: float, east_m: float, length_m: float) -> float:
        if length_m < 0.1:
            return 0.0
        step_rad = math.atan2(east_m, north_m)
        last_rad = self._memory.last_step_rad
        self._memory.last_step_rad = step_rad
        return 0.0 if last_rad is None else abs(wrap_pi(step_rad - last_rad))

    def _restart(self, position: Position) -> None:
        """The unit began anew: its frame starts where the wearer got to since, heading unknown."""
        memory = self._memory
        self._spread(5.0)
        self._forget_heading()
        memory.path = PathMemory()
        memory.restarted = True
        self._walk(position.north_m, position.east_m, position.down_m, 0.0)

    def _leave_own_frame(self) -> None:
        """The first thing known of the incident frame: position and heading are open."""
        self._memory.assumed = False
        self._forget_position()
        self._forget_heading()

    def _forget_position(self) -> None:
        covariance = self._horizontal.P
        covariance[:2, :] = 0.0
        covariance[:, :2] = 0.0
        covariance[0, 0] = covariance[1, 1] = _UNKNOWN_VAR_M2

    def _forget_heading(self) -> None:
        x, covariance = self._horizontal.x, self._horizontal.P
        x[2:4, 0] = 0.0
        covariance[2:4, :] = 0.0
        covariance[:, 2:4] = 0.0
        covariance[2, 2] = covariance[3, 3] = 0.5
        self._memory.aligned_once = False

    def _spread(self, std_m: float) -> None:
        self._horizontal.P[0, 0] += std_m**2
        self._horizontal.P[1, 1] += std_m**2

    def _own(self) -> tuple[float, float]:
        last = self._memory.last
        return (0.0, 0.0) if last is None else (last.north_m, last.east_m)

    def _unguided_m2(self, t_mono_ns: int) -> float:
        """How far a wearer may have got since the last word of the own path."""
        last = self._memory.last
        heard_ns = last.header.t_mono_ns if last else self._memory.fix_t_mono_ns
        if heard_ns is None or t_mono_ns - heard_ns < NS_PER_S:
            return 0.0
        return (self._kind.unguided_mps * (t_mono_ns - heard_ns) / NS_PER_S) ** 2

    def _let_wander(self, t_mono_ns: int) -> None:
        """Predict the fixes' slow error up to the time of this one."""
        before_ns = self._memory.wander_t_mono_ns
        self._memory.wander_t_mono_ns = max(t_mono_ns, before_ns or t_mono_ns)
        if before_ns is None or t_mono_ns <= before_ns:
            return
        keep = math.exp(-(t_mono_ns - before_ns) / NS_PER_S / self._kind.wander_s)
        for one, states in ((self._horizontal, [4, 5]), (self._vertical, [1])):
            one.x[states] *= keep
            one.P[states, :] *= keep
            one.P[:, states] *= keep
            one.P[states, states] += 1.0 - keep**2

    def _correct_height(self, fix: PlaceFix) -> None:
        if fix.vertical_std_m is None:
            return
        std_m = max(fix.vertical_std_m, self._kind.height_std_floor_m)
        observe = np.array([[1.0, std_m * math.sqrt(self._kind.wander_part)]])
        noise = np.array([[std_m**2 * (1.0 - self._kind.wander_part)]])
        innovation_m = fix.down_m - float((observe @ self._vertical.x)[0, 0])
        spread_m2 = float((observe @ self._vertical.P @ observe.T + noise)[0, 0])
        if innovation_m**2 <= 9.0 * spread_m2:
            self._vertical.update(np.array([[fix.down_m]]), R=noise, H=observe)

    def _is_stuck(self, fix: PlaceFix) -> bool:
        """The very same place again and again while the wearer walks on."""
        memory = self._memory
        walked_m = memory.last.distance_m if memory.last else 0.0
        place = (fix.north_m, fix.east_m)
        if memory.last_fix_m != place:
            memory.last_fix_m, memory.same_fixes, memory.same_since_m = place, 1, walked_m
            return False
        memory.same_fixes += 1
        kind = self._kind
        return (
            memory.same_fixes >= kind.stuck_fixes and walked_m - memory.same_since_m > kind.stuck_m
        )

    def _turned_away(self, fix: PlaceFix, then: tuple[float, float]) -> FixVerdict:
        """Outside the gate; but fixes that draw the shape of the walk are right after all.

        Least squares of ``seen = shift + a own`` over complex numbers (east the imaginary part);
        a receiver that wanders or hangs has no walk in it.
        """
        memory, kind = self._memory, self._kind
        memory.distrust = min(memory.distrust + 1, kind.distrust_most)
        memory.outliers.append(_Outlier(fix.north_m, fix.east_m, *then))
        del memory.outliers[: -kind.return_fixes]
        own = np.array([complex(o.own_north_m, o.own_east_m) for o in memory.outliers])
        seen = np.array([complex(o.north_m, o.east_m) for o in memory.outliers])
        own, seen = own - own.mean(), seen - seen.mean()
        walked_m2, seen_m2 = np.vdot(own, own).real, np.vdot(seen, seen).real
        if len(own) < kind.return_fixes or walked_m2 < len(own) * kind.return_spread_m**2:
            return FixVerdict(False, "does not fit the path walked")
        turn = complex(np.vdot(own, seen) / walked_m2)
        unlike = 1.0 - abs(turn) ** 2 * walked_m2 / seen_m2
        if unlike > kind.return_unlike or not 0.75 < abs(turn) < 1.33:
            return FixVerdict(False, "does not fit the path walked")
        memory.outliers.clear()
        memory.distrust = 0
        self._forget_position()
        held_rad, std_rad = self._turn()
        fit_rad = fix.horizontal_std_m / math.sqrt(walked_m2 / 4.0)
        if abs(wrap_pi(cmath.phase(turn) - held_rad)) > 3.0 * math.hypot(std_rad, fit_rad):
            self._forget_heading()
        return FixVerdict(False, "contradicts the path, and agrees with others: going there")

    def _note_alignment(self) -> None:
        """Once the heading is known, so is that a metre walked is about a metre."""
        if self._memory.aligned_once:
            return
        turn_std_rad = self._turn()[1]
        c, s = float(self._horizontal.x[2, 0]), float(self._horizontal.x[3, 0])
        scale = math.hypot(c, s)
        if turn_std_rad >= self._kind.scaled_rad or scale < 0.5:
            return
        self._memory.aligned_once = True
        observe = np.array([[0.0, 0.0, c / scale, s / scale, 0.0, 0.0]])
        self._horizontal.update(
            np.array([[1.0]]), R=np.array([[self._kind.scale_std**2]]), H=observe
        )

    def _turn(self) -> tuple[float, float]:
        """Heading correction and its standard deviation, pi where it is not known."""
        c, s = float(self._horizontal.x[2, 0]), float(self._horizontal.x[3, 0])
        scale2 = c * c + s * s
        if scale2 < 0.05:
            return 0.0, math.pi
        across = np.array([-s, c]) / scale2
        variance = float(across @ self._horizontal.P[2:4, 2:4] @ across)
        return math.atan2(s, c), min(math.sqrt(max(variance, 0.0)), math.pi)

    def _quality(self, std_m: float, turn_std_rad: float) -> tuple[Quality, str]:
        memory = self._memory
        tracker = memory.last.quality if memory.last is not None else Quality.GOOD
        within = f"within {2.0 * std_m:.0f} m"
        causes = (
            (tracker is Quality.LOST, Quality.LOST, "the unit's tracker is lost"),
            (memory.assumed, Quality.DEGRADED, "start not known: shown about the unit's own start"),
            (std_m > 30.0, Quality.LOST, within),
            (turn_std_rad > self._kind.aligned_rad, Quality.DEGRADED, "heading not known yet"),
            (std_m > 5.0, Quality.DEGRADED, within),
            (tracker is Quality.DEGRADED, Quality.DEGRADED, "the unit's tracker is unsure"),
        )
        return next(((quality, why) for holds, quality, why in causes if holds), (Quality.GOOD, ""))


def _variance(position: Position) -> float:
    return max(position.std_north_m, position.std_east_m) ** 2


def _mean_heading(start: Start) -> tuple[float, float]:
    """Mean of a unit vector whose direction is normal about the heading, wrapped."""
    shrink = math.exp(-0.5 * start.heading_std_rad**2)
    return shrink * math.cos(start.heading_rad), shrink * math.sin(start.heading_rad)


def _heading_covariance(start: Start, scale_std: float) -> Floats:
    """Covariance of that vector (Mardia & Jupp, Directional Statistics, 3.5.7), with a scale."""
    variance = start.heading_std_rad**2
    along = np.array([math.cos(start.heading_rad), math.sin(start.heading_rad)])
    across = np.array([-along[1], along[0]])
    along_var = 0.5 * (1.0 - math.exp(-variance)) ** 2 + scale_std**2
    across_var = 0.5 * (1.0 - math.exp(-2.0 * variance))
    return along_var * np.outer(along, along) + across_var * np.outer(across, across)
