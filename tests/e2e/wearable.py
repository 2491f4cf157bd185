"""A unit of which a test decides what it says; it speaks over the real bus."""

from __future__ import annotations

import secrets
import threading
from collections import deque
from queue import SimpleQueue
from typing import Self

from edge.agent.command_handler import CommandHandler
from shared.bus_zenoh import UnitEndpoint, ZenohBus
from shared.channels import COMMAND, channel_of
from shared.clock import SystemClock
from shared.codec import decode, encode
from shared.header_factory import HeaderFactory
from shared.messages import (
    Command,
    CommandKind,
    EventKind,
    Heartbeat,
    Message,
    Position,
    Status,
    Temperature,
    UnitEvent,
    UnitSensor,
)
from tests.rig import message_factory

STEP_S = 0.2
REPEATED = 10
SPEED_MPS = 1.0
CLOCK_AHEAD_S = -75.0
SENSORS = (
    UnitSensor("foot", "left_foot", "x-IMU3", 400.0, None, None, False, False, mount="laces"),
    UnitSensor("back", "lower_back", "BMI270", 100.0, None, None, True, True, True),
)


class Wearable:
    """Walks north from its start at a metre a second, from ``with`` to its end."""

    def __init__(self, unit_id: str, station: str | UnitEndpoint) -> None:
        """``station``: its address, or the address with the unit's certificate."""
        self._bus = ZenohBus(UnitEndpoint((station,)) if isinstance(station, str) else station)
        self._header_factory = HeaderFactory(unit_id, secrets.randbits(63), SystemClock())
        self._handler = CommandHandler(self._header_factory, lambda _: None)
        self._repeated: deque[Message] = deque(maxlen=REPEATED)
        self._lock = threading.RLock()  # tests and the walk say things by turns
        self._commands: SimpleQueue[bytes] = SimpleQueue()
        self._hearing = self._bus.subscribe(
            COMMAND.key(unit_id), lambda _, payload: self._commands.put(payload)
        )
        self._last_command_id = ""
        self.texts: list[str] = []  # of messages to the wearer
        self.kinds: list[CommandKind] = []  # of all commands, as they came
        self._ended = threading.Event()
        self._thread = threading.Thread(target=self._walk, name=unit_id)

    def __enter__(self) -> Self:
        self._thread.start()
        return self

    def __exit__(self, *_: object) -> None:
        self._ended.set()
        self._thread.join()
        self._bus.close()

    def press_mayday(self) -> None:
        with self._lock:
            self._send_repeatedly(UnitEvent(self._header_factory.header(), EventKind.MAYDAY))

    def cancel_mayday(self) -> None:
        with self._lock:
            self._send_repeatedly(
                UnitEvent(self._header_factory.header(), EventKind.MAYDAY_CANCELLED)
            )

    def acknowledge(self) -> None:
        with self._lock:
            for reply in self._handler.acknowledge():
                self._send_repeatedly(reply)

    def describe(self, *outputs: str) -> None:
        """Say what sensors it has, and which outputs to notify its wearer with."""
        with self._lock:
            header = self._header_factory.header()
            self._say(
                message_factory.description(
                    header, outputs=outputs, tracker="foot_and_trunk", sensors=SENSORS
                )
            )

    def notify(self, signal: str = "") -> None:
        """An output has run for the command that came last."""
        with self._lock:
            reply = self._handler.note_notified(self._last_command_id, signal)
            assert reply is not None
            self._send_repeatedly(reply)

    def _walk(self) -> None:
        walked_m, steps = 0.0, 0
        while not self._ended.wait(STEP_S):
            walked_m += SPEED_MPS * STEP_S
            with self._lock:
                self._take_commands()
                self._say(self._position(walked_m))
                if steps % 5 == 0:
                    self._send_every_second(steps)
            steps += 1

    def _send_every_second(self, steps: int) -> None:
        self._say(self._status(steps))
        self._say(Temperature(self._header_factory.header(), ambient_degc=31.0))
        self._say(Heartbeat(self._header_factory.header(), 1, 1, CLOCK_AHEAD_S, clock_std_s=0.003))
        # The bus may drop a message; it has no journal from which the station could fetch it.
        for message in self._repeated:
            self._say(message)

    def _take_commands(self) -> None:
        while not self._commands.empty():
            command = decode(COMMAND, self._commands.get())
            assert isinstance(command, Command)
            if command.kind is CommandKind.TEXT and command.command_id != self._last_command_id:
                self.texts.append(command.text)
            self._last_command_id = command.command_id
            self.kinds.append(command.kind)
            self._send_repeatedly(self._handler.take(command))

    def _send_repeatedly(self, message: Message) -> None:
        self._repeated.append(message)
        self._say(message)

    def _say(self, message: Message) -> None:
        channel = channel_of(message)
        self._bus.publish(channel.key(self._header_factory.unit_id), encode(message), channel.qos)

    def _position(self, walked_m: float) -> Position:
        return message_factory.position(
            self._header_factory.header(),
            north_m=walked_m,
            velocity_north_mps=SPEED_MPS,
            std_north_m=0.4,
            std_east_m=0.2,
            distance_m=walked_m,
        )

    def _status(self, steps: int) -> Status:
        return message_factory.status(
            self._header_factory.header(), battery=0.83, steps=steps, cadence_hz=1.8
        )
