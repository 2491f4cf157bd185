"""Simulated units on a real bus, all in one thread, each with its own session."""

from __future__ import annotations

import math
import random
import secrets
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass, field
from threading import Event, Thread
from typing import NamedTuple

from shared.bus_zenoh import UnitEndpoint, ZenohBus
from shared.channels import POSITION, alive_key, channel_of
from shared.clock import NS_PER_S, Clock, SystemClock
from shared.codec import encode
from shared.header_factory import HeaderFactory
from shared.messages import (
    Activity,
    EventKind,
    Header,
    Message,
    Position,
    Status,
    Temperature,
    UnitEvent,
)
from shared.quality import Quality, Reason
from tests.rig import message_factory
from tests.rig.pacing import paced

_MESSAGES_A_TURN = 7  # one is a status and one a temperature: 1 Hz each beside positions at 5 Hz
_STATUS_AT, _TEMPERATURE_AT = 2, 5
_RADII_M = 5.0, 30.0


@dataclass(slots=True)
class Sent:
    """Messages of a unit."""

    messages: int = 0
    position_times_ns: list[int] = field(default_factory=list)  # sensor times, UTC


class Circle(NamedTuple):
    """A level circle about the start."""

    radius_m: float
    down_m: float = 0.0


class Wearer:
    """Walks round a circle at 1 m/s, and says so: of seven messages five are positions."""

    def __init__(self, unit_id: str, clock: Clock, circle: Circle | None = None) -> None:
        self.unit_id = unit_id
        self._header_factory = HeaderFactory(unit_id, secrets.randbits(63), clock)
        self._first_ns = clock.monotonic_ns()
        self._radius_m, self._down_m = circle or Circle(random.uniform(*_RADII_M))

    def introduction(self) -> Message:
        return message_factory.description(self._header_factory.header())

    def next_message(self) -> Message:
        """The next of its turn, captured now."""
        header = self._header_factory.header()
        turn = header.seq % _MESSAGES_A_TURN
        if turn == _STATUS_AT:
            return self._status(header)
        return Temperature(header, 21.5) if turn == _TEMPERATURE_AT else self._position(header)

    def mayday(self) -> Message:
        return UnitEvent(self._header_factory.header(), EventKind.MAYDAY)

    def _status(self, header: Header) -> Status:
        return Status(
            header=header,
            activity=Activity.WALKING,
            motionless_s=0.0,
            battery=0.9,
            mayday=False,
            steps=2 * self._walked_m(header),
            cadence_hz=1.8,
            floors_climbed=0,
            tracker_rows_dropped=0,
            journal_pending=0,
        )

    def _position(self, header: Header) -> Position:
        walked_m = (header.t_mono_ns - self._first_ns) / NS_PER_S
        turned_rad = walked_m / self._radius_m
        return Position(
            header=header,
            north_m=self._radius_m * math.sin(turned_rad),
            east_m=-self._radius_m * math.cos(turned_rad),
            down_m=self._down_m,
            velocity_north_mps=math.cos(turned_rad),
            velocity_east_mps=math.sin(turned_rad),
            velocity_down_mps=0.0,
            std_north_m=0.5,
            std_east_m=0.5,
            std_down_m=0.2,
            correlation_ne=0.0,
            heading_rad=math.remainder(turned_rad, math.tau),
            heading_std_rad=0.1,
            distance_m=walked_m,
            pressure_pa=101_325.0,
            stationary=False,
            quality=Quality.GOOD,
            reasons=Reason.NONE,
        )

    def _walked_m(self, header: Header) -> int:
        return (header.t_mono_ns - self._first_ns) // NS_PER_S


class BenchUnit:
    """A wearer with a session of its own on the bus."""

    def __init__(
        self,
        unit_id: str,
        endpoint: UnitEndpoint,
        closing: ExitStack,
        circle: Circle | None = None,
    ) -> None:
        self.unit_id = unit_id
        self.sent = Sent()
        self._wearer = Wearer(unit_id, SystemClock(), circle)
        self._bus = ZenohBus(endpoint)
        closing.callback(self._bus.close)
        self._token = self._bus.declare_alive(alive_key(unit_id))

    @property
    def is_received(self) -> bool:
        """The station listens."""
        return self._bus.has_subscriber(POSITION.key(self.unit_id))

    def introduce(self) -> None:
        self._publish(self._wearer.introduction())

    def speak(self) -> None:
        """The next message of its turn, captured now."""
        message = self._wearer.next_message()
        self._publish(message)
        if isinstance(message, Position):
            self.sent.position_times_ns.append(message.header.t_utc_ns)

    def press_mayday(self) -> None:
        self._publish(self._wearer.mayday())

    def _publish(self, message: Message) -> None:
        channel = channel_of(message)
        self._bus.publish(channel.key(self.unit_id), encode(message), channel.qos)
        self.sent.messages += 1


def unit_names(count: int) -> list[str]:
    return [f"bench-{number:04d}" for number in range(count)]


def speak_in_turn(
    units: Sequence[BenchUnit], rate_hz: float, seconds: float, on_second: Callable[[], None]
) -> float:
    """All units one after the other, ``rate_hz`` messages a second together; the rate reached."""
    began_s = time.perf_counter()
    for number in paced(rate_hz, seconds):
        units[number % len(units)].speak()
        if number % max(round(rate_hz), 1) == 0:
            on_second()
    return round(rate_hz * seconds) / (time.perf_counter() - began_s)


@contextmanager
def speaking(units: Sequence[BenchUnit], unit_rate_hz: float) -> Iterator[None]:
    """All units send meanwhile, from a thread of its own, so many messages a second each."""
    ending = Event()

    def speak() -> None:
        while not ending.is_set():
            speak_in_turn(units, unit_rate_hz * len(units), 1.0, lambda: None)

    thread = Thread(target=speak, name="simulated-units", daemon=True)
    thread.start()
    try:
        yield
    finally:
        ending.set()
        thread.join()
