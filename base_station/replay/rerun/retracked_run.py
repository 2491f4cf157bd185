"""Messages of one run as another tracker gives them, in the clock and in the frame of the run as it
was recorded.
"""

from __future__ import annotations

import math
from bisect import bisect_left, bisect_right
from collections.abc import Iterable, Sequence
from statistics import median

import msgspec

from base_station.replay.rerun.recorded_runs import RecordedRun
from shared.channels import parse_key
from shared.clock import NS_PER_S
from shared.codec import decode
from shared.errors import RecordingError
from shared.geo import rotate
from shared.mcap_log import LogRecord
from shared.messages import Message, Position, Status, UnitDescription

_SHIFT_ERROR_NS = 2 * NS_PER_S  # of a shift that is estimated by log times
_MATCHING_PART = 0.8  # of the statuses
_ALIGNED_M = 30.0  # of the way by which the two frames are laid over each other
_ALIGNED_LEAST_M = 3.0  # a shorter way gives no direction
_LATE_NS = 5 * NS_PER_S  # an older position of the tracker belongs to another time


class FrameShift(msgspec.Struct, frozen=True):
    """Turn about a place of the new frame, and that place in the recorded frame."""

    turn_rad: float
    new_m: tuple[float, float, float]  # north, east, down
    recorded_m: tuple[float, float, float]
    distance_m: float  # walked until then: recorded less new
    variance_m2: tuple[float, float, float]  # recorded less new, not below 0
    heading_variance_rad2: float

    def apply(self, position: Position) -> Position:
        """The position in the recorded frame."""
        north_m, east_m = rotate(
            position.north_m - self.new_m[0], position.east_m - self.new_m[1], self.turn_rad
        )
        velocity_mps = rotate(
            position.velocity_north_mps, position.velocity_east_mps, self.turn_rad
        )
        std_m, correlation = self._turned(position)
        magnetic = position.magnetic_north
        if magnetic is not None:
            heading_rad = (magnetic.heading_rad + self.turn_rad) % math.tau
            magnetic = msgspec.structs.replace(magnetic, heading_rad=heading_rad)
        return msgspec.structs.replace(
            position,
            north_m=self.recorded_m[0] + north_m,
            east_m=self.recorded_m[1] + east_m,
            down_m=self.recorded_m[2] + position.down_m - self.new_m[2],
            velocity_north_mps=velocity_mps[0],
            velocity_east_mps=velocity_mps[1],
            std_north_m=std_m[0],
            std_east_m=std_m[1],
            std_down_m=math.sqrt(position.std_down_m**2 + self.variance_m2[2]),
            correlation_ne=correlation,
            heading_rad=(position.heading_rad + self.turn_rad) % math.tau,
            heading_std_rad=min(
                math.hypot(position.heading_std_rad, math.sqrt(self.heading_variance_rad2)), math.pi
            ),
            distance_m=max(position.distance_m + self.distance_m, 0.0),
            magnetic_north=magnetic,
        )

    def _turned(self, position: Position) -> tuple[tuple[float, float], float]:
        """Standard deviations north and east, and their correlation."""
        cosine, sine = math.cos(self.turn_rad), math.sin(self.turn_rad)
        north_m2, east_m2 = position.std_north_m**2, position.std_east_m**2
        both_m2 = position.correlation_ne * position.std_north_m * position.std_east_m
        turned_north_m2 = cosine**2 * north_m2 + sine**2 * east_m2 - 2.0 * cosine * sine * both_m2
        turned_east_m2 = sine**2 * north_m2 + cosine**2 * east_m2 + 2.0 * cosine * sine * both_m2
        turned_both_m2 = (cosine**2 - sine**2) * both_m2 + cosine * sine * (north_m2 - east_m2)
        std_m = (
            math.sqrt(max(turned_north_m2, 0.0) + self.variance_m2[0]),
            math.sqrt(max(turned_east_m2, 0.0) + self.variance_m2[1]),
        )
        product_m2 = std_m[0] * std_m[1]
        correlation = turned_both_m2 / product_m2 if product_m2 > 0.0 else 0.0
        return std_m, max(-1.0, min(1.0, correlation))


class RetrackedRun:
    """Looks up the message of the new run in the place of a sent one."""

    def __init__(self, records: Iterable[LogRecord], recorded: RecordedRun) -> None:
        """``records``: as ``muster edge retrack`` writes them.

        Raises RecordingError where nothing came out, or where the times are of another run.
        """
        positions: list[Position] = []
        statuses: list[Status] = []
        self.description: UnitDescription | None = None
        log_less_sample_ns: list[int] = []
        for log_ns, message in _messages(records):
            match message:
                case Position():
                    positions.append(message)
                case Status():
                    statuses.append(message)
                    log_less_sample_ns.append(log_ns - message.header.t_mono_ns)
                case UnitDescription():
                    self.description = message
        if not positions or not statuses:
            raise RecordingError("the tracker gave no positions")
        utc_less_mono_ns = recorded.utc_less_mono_ns
        estimated_ns = 0  # as of a sensor that is read as time goes by
        if utc_less_mono_ns is not None:
            estimated_ns = round(median(log_less_sample_ns)) - utc_less_mono_ns
        self._shift_ns = _clock_shift_ns(
            [one.header.t_mono_ns for one in statuses], recorded.status_ns, estimated_ns
        )
        self._positions = positions
        self._position_ns = [one.header.t_mono_ns + self._shift_ns for one in positions]
        self._statuses = {one.header.t_mono_ns + self._shift_ns: one for one in statuses}
        self._frame = self._frame_shift(recorded.positions)

    @property
    def has_own_frame(self) -> bool:
        """True where its frame was laid over the recorded one by the first metres."""
        return self._frame is not None

    def position(self, recorded: Position) -> Position | None:
        """The newest position at that time, under the header of the recorded one; the recorded one
        before the recording begins; None where the tracker has none.
        """
        t_ns = recorded.header.t_mono_ns
        row = bisect_right(self._position_ns, t_ns) - 1
        if row < 0:
            return recorded
        if t_ns - self._position_ns[row] > _LATE_NS:
            return None
        new = self._positions[row]
        placed = new if self._frame is None else self._frame.apply(new)
        header = msgspec.structs.replace(
            recorded.header,
            t_mono_ns=self._position_ns[row],
            t_utc_ns=recorded.header.t_utc_ns - (t_ns - self._position_ns[row]),
        )
        return msgspec.structs.replace(placed, header=header)

    def status(self, recorded: Status) -> Status:
        """The status with the new values of sensors and tracker; the unit's own values stay."""
        new = self._statuses.get(recorded.header.t_mono_ns)
        if new is None:
            return recorded
        return msgspec.structs.replace(
            new,
            header=recorded.header,
            mayday=recorded.mayday,
            journal_pending=recorded.journal_pending,
        )

    def describe(self, recorded: UnitDescription) -> UnitDescription:
        """The description with the tracker and the calibrations of the re-run."""
        new = self.description
        if new is None:
            return recorded
        return msgspec.structs.replace(
            new,
            header=recorded.header,
            software_version=recorded.software_version,
            source=recorded.source,
            has_gps=recorded.has_gps,
            outputs=recorded.outputs,
            preflight=recorded.preflight,
        )

    def _frame_shift(self, recorded: Sequence[Position]) -> FrameShift | None:
        """None where both paths are in one frame: they are the same at the first common time."""
        pairs = [
            (one, self._positions[row])
            for one in recorded
            if (row := bisect_right(self._position_ns, one.header.t_mono_ns) - 1) >= 0
        ]
        if not pairs:
            return None
        then, new = pairs[0]
        is_same = math.dist(_place(then), _place(new)) == 0.0
        if is_same and then.header.t_mono_ns == new.header.t_mono_ns + self._shift_ns:
            return None
        return FrameShift(
            _turn_rad(pairs),
            _place(new),
            _place(then),
            then.distance_m - new.distance_m,
            (
                max(then.std_north_m**2 - new.std_north_m**2, 0.0),
                max(then.std_east_m**2 - new.std_east_m**2, 0.0),
                max(then.std_down_m**2 - new.std_down_m**2, 0.0),
            ),
            max(then.heading_std_rad**2 - new.heading_std_rad**2, 0.0),
        )


def _clock_shift_ns(sample_ns: Sequence[int], recorded_ns: Sequence[int], estimated_ns: int) -> int:
    """Monotonic time of the unit less the time of its samples.  Statuses come at the same samples
    whatever tracks; a sensor that is read as time goes by has none.

    Raises RecordingError where no shift lays the statuses over each other.
    """
    known = set(sample_ns)

    def is_match(shift_ns: int) -> bool:
        within = [one for one in recorded_ns if sample_ns[0] <= one - shift_ns <= sample_ns[-1]]
        matching = sum(one - shift_ns in known for one in within)
        return bool(within) and matching >= _MATCHING_PART * len(within)

    candidates = {0} if abs(estimated_ns) < _SHIFT_ERROR_NS else set[int]()
    for one in recorded_ns[:: max(len(recorded_ns) // 5, 1)]:
        row = bisect_left(sample_ns, one - estimated_ns)
        candidates |= {one - other for other in sample_ns[max(row - 2, 0) : row + 3]}
    near = sorted(candidates, key=lambda one: (abs(one - estimated_ns), one))
    for shift_ns in near:
        if abs(shift_ns - estimated_ns) <= _SHIFT_ERROR_NS and is_match(shift_ns):
            return shift_ns
    raise RecordingError("its times are not those of this run in the incident")


def _turn_rad(pairs: Sequence[tuple[Position, Position]]) -> float:
    """Turn of the new frame by the ways from the first place, until some metres are walked; 0 where
    the way is too short.  Least squares: the sum of rotated products has its angle.
    """
    (then, new), *_ = pairs
    cosine_m2 = sine_m2 = furthest_m = 0.0
    for then_later, new_later in pairs:
        if then_later.distance_m - then.distance_m > _ALIGNED_M:
            break
        north_m, east_m = then_later.north_m - then.north_m, then_later.east_m - then.east_m
        new_north_m, new_east_m = new_later.north_m - new.north_m, new_later.east_m - new.east_m
        cosine_m2 += new_north_m * north_m + new_east_m * east_m
        sine_m2 += new_north_m * east_m - new_east_m * north_m
        furthest_m = max(furthest_m, math.hypot(north_m, east_m))
    return math.atan2(sine_m2, cosine_m2) if furthest_m >= _ALIGNED_LEAST_M else 0.0


def _place(position: Position) -> tuple[float, float, float]:
    return position.north_m, position.east_m, position.down_m


def _messages(records: Iterable[LogRecord]) -> Iterable[tuple[int, Message]]:
    return ((log_ns, decode(parse_key(key)[1], payload)) for log_ns, key, payload in records)
