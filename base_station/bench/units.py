"""Simulated units on a real bus, all in one thread, each with its own session."""

from __future__ import annotations

import secrets
import time
from collections.abc import Callable, Sequence
from contextlib import ExitStack
from dataclasses import dataclass, field

from shared.bus_zenoh import UnitEndpoint, ZenohBus
from shared.channels import POSITION, alive_key, channel_of
from shared.clock import NS_PER_S, SystemClock
from shared.codec import encode
from shared.envelope import Stamper
from shared.messages import Activity, Message, Position, Status, Temperature, UnitDescription
from shared.quality import Quality, Reason

_SLOW_EVERY = 10  # of so many messages one is a status and one a temperature


@dataclass(slots=True)
class Sent:
    """What a unit said."""

    messages: int = 0
    position_times_ns: list[int] = field(default_factory=list)  # sensor times, UTC


class BenchUnit:
    """One unit: walks north at 1 m/s and says so."""

    def __init__(self, unit_id: str, endpoint: UnitEndpoint, closing: ExitStack) -> None:
        self.unit_id = unit_id
        self.sent = Sent()
        self._stamper = Stamper(unit_id, secrets.randbits(63), SystemClock())
        self._bus = ZenohBus(endpoint)
        closing.callback(self._bus.close)
        self._token = self._bus.declare_alive(alive_key(unit_id))

    @property
    def is_heard(self) -> bool:
        """The station listens."""
        return self._bus.is_heard(POSITION.key(self.unit_id))

    def introduce(self) -> None:
        header = self._stamper.header()
        self._publish(
            UnitDescription(
                header=header,
                software_version="bench",
                source="simulated",
                sensor_name="none",
                rate_hz=100.0,
                accel_full_scale_mps2=None,
                gyro_full_scale_radps=None,
                tracker="none",
                calibration="",
                has_magnetometer=False,
                has_barometer=False,
                has_gps=False,
            )
        )

    def speak(self) -> None:
        """The next message of its turn, captured now."""
        turn = self.sent.messages % _SLOW_EVERY
        if turn == 1:
            self._publish(self._status())
        elif turn == _SLOW_EVERY // 2 + 1:
            self._publish(Temperature(self._stamper.header(), 21.5))
        else:
            position = self._position()
            self._publish(position)
            self.sent.position_times_ns.append(position.header.t_utc_ns)

    def _publish(self, message: Message) -> None:
        channel = channel_of(message)
        self._bus.publish(channel.key(self.unit_id), encode(message), channel.qos)
        self.sent.messages += 1

    def _status(self) -> Status:
        return Status(
            header=self._stamper.header(),
            activity=Activity.WALKING,
            motionless_s=0.0,
            battery=0.9,
            mayday=False,
            steps=self.sent.messages,
            cadence_hz=1.8,
            floors_climbed=0,
            tracker_rows_dropped=0,
            journal_pending=0,
        )

    def _position(self) -> Position:
        header = self._stamper.header()
        return Position(
            header=header,
            north_m=header.t_mono_ns % (1000 * NS_PER_S) * 1e-9,
            east_m=0.0,
            down_m=0.0,
            velocity_north_mps=1.0,
            velocity_east_mps=0.0,
            velocity_down_mps=0.0,
            std_north_m=0.5,
            std_east_m=0.5,
            std_down_m=0.2,
            correlation_ne=0.0,
            heading_rad=0.0,
            heading_std_rad=0.1,
            distance_m=self.sent.messages * 0.1,
            pressure_pa=101_325.0,
            stationary=False,
            quality=Quality.GOOD,
            reasons=Reason.NONE,
        )


def unit_names(count: int) -> list[str]:
    return [f"bench-{number:04d}" for number in range(count)]


def speak_in_turn(
    units: Sequence[BenchUnit], rate_hz: float, seconds: float, on_second: Callable[[], None]
) -> float:
    """All units one after the other, ``rate_hz`` messages a second together; the rate reached."""
    began = time.perf_counter()
    count = round(rate_hz * seconds)
    for number in range(count):
        wait_s = began + number / rate_hz - time.perf_counter()
        if wait_s > 0.0:
            time.sleep(wait_s)
        units[number % len(units)].speak()
        if number % max(round(rate_hz), 1) == 0:
            on_second()
    return count / (time.perf_counter() - began)
