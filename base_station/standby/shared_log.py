"""The log of a station that another one follows, or that follows another: it knows its place."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Sequence
from threading import Condition

from base_station.core.log_position import START, LogPosition, Record, is_event
from base_station.engine.ports import Log
from shared.channels import OPERATOR
from shared.clock import Clock
from shared.codec import decode
from shared.errors import WireError
from shared.messages import STATION_ID, OperatorAction
from shared.messages.station import BeginErasure, ForgetWearers, TakeOver

_RECENT_BYTES = 16 * 1024 * 1024
_OPERATOR_KEY = OPERATOR.key(STATION_ID)


class SharedLog:
    """A ``Log`` that counts events and keeps the newest at hand.  From any thread.

    What the disk refused is in no log.  One that follows another's has no holes: it ends there.
    """

    def __init__(self, log: Log, clock: Clock) -> None:
        self._log = log
        self._clock = clock
        self.written_ns = clock.monotonic_ns()  # when something was last taken
        self.follows = False  # it is to be the same as another station's
        self.is_cut_short = False  # and is not, until this station starts again
        self._changed = Condition()
        self._first: LogPosition = START  # events at hand begin behind it
        self._places: list[LogPosition] = []
        self._recent: list[Record] = []
        self._bytes = 0
        self._durable = START
        self._offered = START
        self._take_overs: list[TakeOver] = []
        self._log_id = 0

    def begin(self, place: LogPosition, log_id: int, take_overs: Sequence[TakeOver]) -> None:
        """State of the log so far, before anything is written."""
        self._first = self._durable = self._offered = place
        self._log_id = log_id
        self._take_overs = list(take_overs)

    # ---- a log

    @property
    def problem(self) -> str:
        return self._log.problem

    @property
    def low_disk_space(self) -> str:
        return self._log.low_disk_space

    @property
    def is_behind(self) -> bool:
        return self._log.is_behind

    @property
    def refuses(self) -> bool:
        return self._log.refuses

    def write(self, t_ns: int, key: str, payload: bytes) -> bool:
        with self._changed:  # in one order here and there
            kept = not self.is_cut_short and self._log.write(t_ns, key, payload)
            if is_event(key):
                self._offered = self._offered.next(t_ns)
                self._changed.notify_all()
            if kept:
                self.written_ns = self._clock.monotonic_ns()
                if is_event(key):
                    self._note(t_ns, key, payload)
            elif self.follows:
                self.is_cut_short = True
        return kept

    def flush(self) -> bool:
        place = self.place
        done = self._log.flush()
        if done:
            with self._changed:
                self._durable = max(self._durable, place)
                self._changed.notify_all()
        return done

    # ---- for two stations

    @property
    def place(self) -> LogPosition:
        """Behind the last event written."""
        with self._changed:
            return self._place()

    @property
    def offered(self) -> LogPosition:
        """Behind the last event that was to be written, whether or not the disk took it."""
        return self._offered

    @property
    def durable(self) -> LogPosition:
        """Up to here it is on the disk."""
        return self._durable

    @property
    def log_id(self) -> int:
        return self._log_id

    @property
    def take_overs(self) -> tuple[TakeOver, ...]:
        with self._changed:
            return tuple(self._take_overs)

    @property
    def term(self) -> int:
        with self._changed:
            return self._take_overs[-1].term if self._take_overs else 0

    def wait_beyond(self, place: LogPosition, timeout_s: float) -> bool:
        """Until something is written behind ``place``."""
        with self._changed:
            return self._changed.wait_for(lambda: self._place() > place, timeout_s)

    def wait_reached(self, place: LogPosition, timeout_s: float) -> bool:
        with self._changed:
            return self._changed.wait_for(lambda: self._place() >= place, timeout_s)

    def wait_offered(self, place: LogPosition, timeout_s: float) -> bool:
        """As ``wait_reached``, though the log has a hole or ends before."""
        with self._changed:
            return self._changed.wait_for(lambda: self._offered >= place, timeout_s)

    def behind(self, place: LogPosition, max_bytes: int) -> list[Record] | None:
        """The events behind ``place``, as many as that; None: they are no longer at hand."""
        with self._changed:
            if place < self._first:
                return None
            found: list[Record] = []
            for record in self._recent[bisect_right(self._places, place) :]:
                found.append(record)
                max_bytes -= len(record[2])
                if max_bytes <= 0:
                    break
            return found

    def _place(self) -> LogPosition:
        return self._places[-1] if self._places else self._first

    def _note(self, t_ns: int, key: str, payload: bytes) -> None:
        self._log_id = self._log_id or t_ns
        self._places.append(self._place().next(t_ns))
        self._recent.append((t_ns, key, payload))
        self._bytes += len(payload)
        if self._bytes > 2 * _RECENT_BYTES:
            self._forget_oldest()
        if key == _OPERATOR_KEY:
            self._note_action(payload)

    def _forget_oldest(self) -> None:
        dropped = 0
        while self._bytes > _RECENT_BYTES:
            self._bytes -= len(self._recent[dropped][2])
            dropped += 1
        self._first = self._places[dropped - 1]
        del self._places[:dropped], self._recent[:dropped]

    def _note_action(self, payload: bytes) -> None:
        try:
            message = decode(OPERATOR, payload)
        except WireError:
            return
        match message:
            case OperatorAction(action=TakeOver() as take_over):
                self._take_overs.append(take_over)
            case OperatorAction(
                action=ForgetWearers() | BeginErasure()
            ):  # the log will be written anew
                self._first = self._place()
                self._places.clear()
                self._recent.clear()
                self._bytes = 0
            case _:
                pass
