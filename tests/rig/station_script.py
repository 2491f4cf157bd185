"""Says what happens to a station, event by event, as log records that any pipeline can step."""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeVar

from base_station.core.alarms import ALARMS
from base_station.core.events import Output, Received, event_of
from base_station.core.pipeline import StationPipeline
from base_station.fusion import FUSERS
from shared.channels import COMMAND, OPERATOR, TICK, channel_of
from shared.clock import NS_PER_S
from shared.codec import encode
from shared.coded_text import code_of_text
from shared.messages import (
    STATION_ID,
    AlarmChange,
    Command,
    CommandKind,
    CommandReply,
    CommandState,
    EventKind,
    FusedPosition,
    Header,
    Message,
    OperatorAction,
    Temperature,
    Tick,
    UnitEvent,
)
from shared.messages.station import Action, RegisterUnit
from tests.rig import message_factory

START_NS = 1_700_000_000 * NS_PER_S
Record = tuple[int, str, bytes]
M = TypeVar("M", bound=Message)


def new_pipeline() -> StationPipeline:
    return StationPipeline(ALARMS, FUSERS[0])


class Script:
    """A pipeline, the records that stepped it, and what came out.

    Messages arrive at once; the units' monotonic clocks stand 1000 s ahead of the script's time.
    """

    def __init__(self, pipeline: StationPipeline | None = None) -> None:
        self.pipeline = pipeline or new_pipeline()
        self.records: list[Record] = []
        self.outputs: list[Output] = []
        self.now_s = 0.0
        self.boot_ids: dict[str, int] = {}
        self._seqs: dict[str, int] = {}
        self._actions = 0

    @property
    def t_ns(self) -> int:
        return START_NS + round(self.now_s * NS_PER_S)

    @property
    def alarms(self) -> list[AlarmChange]:
        return [output for output in self.outputs if isinstance(output, AlarmChange)]

    @property
    def fused(self) -> list[FusedPosition]:
        return [output for output in self.outputs if isinstance(output, FusedPosition)]

    def published(self, kind: type[M]) -> list[M]:
        """The messages of a kind that were stepped."""
        events = [event_of(*record) for record in self.records]
        messages = [event.message for event in events if isinstance(event, Received)]
        return [message for message in messages if isinstance(message, kind)]

    def header(self, unit_id: str, captured_s: float | None = None) -> Header:
        seq = self._seqs[unit_id] = self._seqs.get(unit_id, 0) + 1
        captured_s = self.now_s if captured_s is None else captured_s
        t_mono_ns = round((1000.0 + captured_s) * NS_PER_S)
        return Header(unit_id, self.boot_ids.get(unit_id, 7), seq, t_mono_ns)

    def record(self, key: str, payload: bytes) -> list[Output]:
        """Step a record that is what it is."""
        self.records.append((self.t_ns, key, payload))
        outputs = self.pipeline.step(event_of(self.t_ns, key, payload))
        self.outputs.extend(outputs)
        return outputs

    def say(self, message: Message) -> list[Output]:
        return self.record(channel_of(message).key(message.header.unit_id), encode(message))

    def act(self, action: Action, by: str = "chief") -> list[Output]:
        self._actions += 1
        message = OperatorAction(self.header(STATION_ID), f"a{self._actions}", by, action)
        return self.record(OPERATOR.key(STATION_ID), encode(message))

    def register(self, *unit_ids: str) -> None:
        for unit_id in unit_ids:
            self.act(RegisterUnit(unit_id, f"unit {unit_id}"))

    def tick(self) -> list[Output]:
        header = self.header(STATION_ID)
        return self.record(TICK.key(STATION_ID), encode(Tick(header, self.t_ns)))

    def wait(self, duration_s: float, each_s: Callable[[], object] | None = None) -> None:
        """Let time pass with a tick a second, after what happens ``each_s``."""
        for _ in range(round(duration_s)):
            self.now_s += 1.0
            if each_s is not None:
                each_s()
            self.tick()

    def status(self, unit_id: str, **changes: object) -> list[Output]:
        return self.say(message_factory.status(self.header(unit_id), **changes))

    def temperature(self, unit_id: str, ambient_degc: float) -> list[Output]:
        return self.say(Temperature(self.header(unit_id), ambient_degc))

    def event(self, unit_id: str, kind: EventKind, detail: str = "") -> list[Output]:
        return self.say(UnitEvent.of(self.header(unit_id), kind, detail))

    def command(self, unit_id: str, command_id: str) -> list[Output]:
        """The station hears itself say it."""
        sent = Command(self.header(STATION_ID), command_id, CommandKind.EVACUATE, "chief", 0)
        return self.record(COMMAND.key(unit_id), encode(sent))

    def reply(
        self, unit_id: str, command_id: str, state: CommandState, detail: str = ""
    ) -> list[Output]:
        return self.say(
            CommandReply(
                self.header(unit_id), command_id, state, str(detail), text_code=code_of_text(detail)
            )
        )

    def position(
        self, unit_id: str, north_m: float, east_m: float, **changes: object
    ) -> list[Output]:
        walked = {"north_m": north_m, "east_m": east_m, **changes}
        return self.say(message_factory.position(self.header(unit_id), **walked))

    def gps(self, unit_id: str, lat_deg: float, lon_deg: float, **changes: object) -> list[Output]:
        return self.say(message_factory.gps_fix(self.header(unit_id), lat_deg, lon_deg, **changes))
