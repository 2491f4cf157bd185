"""Facts that only the log has: radio gaps, temperatures, and outcomes of orders.

One pass over the messages; the kept data is bounded: gaps, doses, and series about alarms only.
"""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Callable, Collection, Iterable, Mapping, Sequence

import msgspec

from base_station.core.events import Received, event_of
from base_station.core.state.unit_heat import ExposureInterval
from base_station.core.units import thermal_dose
from base_station.replay.radio_contact import CONTACT_CHANNELS, GAP_NS, SentTimes
from base_station.report.contents import Interval, Series
from shared.channels import (
    COMMAND,
    REPLY,
    TEMPERATURE,
    backfilled_key,
    is_backfilled,
)
from shared.mcap_log import LogRecord
from shared.messages import (
    Command,
    CommandReply,
    CommandState,
    EventKind,
    Header,
    Status,
    Temperature,
    UnitEvent,
)

_LATE = (TEMPERATURE, REPLY)  # of the journal


class ReplyRecord(msgspec.Struct, frozen=True):
    t_ns: int  # when the unit sent it
    unit_id: str
    command_id: str
    state: CommandState
    detail: str


class UnitFacts(msgspec.Struct):
    """Facts of one unit; ``doses`` and ``hottest`` by index of the given wearings."""

    radio_gaps: list[Interval] = msgspec.field(default_factory=list)
    doses: dict[int, float] = msgspec.field(default_factory=dict)
    hottest: dict[int, tuple[int, float]] = msgspec.field(default_factory=dict)
    motionless_s: list[tuple[int, float]] = msgspec.field(default_factory=list)
    temperature_degc: list[tuple[int, float]] = msgspec.field(default_factory=list)
    received_ns: list[int] = msgspec.field(default_factory=list)
    battery: list[tuple[int, float]] = msgspec.field(default_factory=list)  # 0..1
    events: list[tuple[int, EventKind]] = msgspec.field(default_factory=list)


class LogFacts(msgspec.Struct):
    units: dict[str, UnitFacts]
    commands: dict[str, dict[str, int]]  # when each command went to each unit first
    replies: list[ReplyRecord]


def wanted_keys(unit_ids: Iterable[str]) -> Collection[str]:
    """Keys of the records that ``read_facts`` uses."""
    keys = set[str]()
    for unit_id in unit_ids:
        keys |= {channel.key(unit_id) for channel in (*CONTACT_CHANNELS, COMMAND)}
        keys |= {backfilled_key(unit_id, channel.suffix) for channel in _LATE}
    return keys


def read_facts(
    records: Iterable[LogRecord],
    during: Interval,
    wearings: Mapping[str, Sequence[Interval]],
    about: Mapping[str, Sequence[Interval]],
    on_progress: Callable[[float], None],
) -> LogFacts:
    """Read the facts.  ``wearings``: by unit, in time order; ``about``: times about which series
    are kept.
    """
    readers = {
        unit_id: _UnitReader(during, worn, about.get(unit_id, ()))
        for unit_id, worn in wearings.items()
    }
    facts = LogFacts({unit_id: one.facts for unit_id, one in readers.items()}, {}, [])
    span_ns = max(during.until_ns - during.from_ns, 1)
    for number, (t_ns, key, payload) in enumerate(records):
        if number % 10_000 == 0:
            on_progress(min(max((t_ns - during.from_ns) / span_ns, 0.0), 1.0))
        event = event_of(t_ns, key, payload)
        if isinstance(event, Received) and event.unit_id in readers:
            _take(facts, readers[event.unit_id], event, is_live=not is_backfilled(key))
    for reader in readers.values():
        reader.end()
    return facts


def series_within(series: Iterable[tuple[int, float]], part: Interval) -> Series:
    return tuple(one for one in series if part.from_ns <= one[0] <= part.until_ns)


def _take(facts: LogFacts, reader: _UnitReader, event: Received, *, is_live: bool) -> None:
    message = event.message
    if isinstance(message, Command):
        facts.commands.setdefault(message.command_id, {}).setdefault(event.unit_id, event.t_ns)
        return
    t_ns = reader.note_header(event.t_ns, message.header, is_live=is_live)
    match message:
        case Temperature():
            reader.take_temperature(t_ns, message, is_live=is_live)
        case Status():
            reader.take_status(t_ns, message)
        case UnitEvent():
            reader.take_event(t_ns, message)
        case CommandReply():
            facts.replies.append(
                ReplyRecord(t_ns, event.unit_id, message.command_id, message.state, message.detail)
            )


class _UnitReader:
    def __init__(
        self, during: Interval, wearings: Sequence[Interval], about: Sequence[Interval]
    ) -> None:
        self.facts = UnitFacts()
        self._during = during
        self._wearings = wearings
        self._begins_ns = [one.from_ns for one in wearings]
        self._about = about
        self._last_received_ns: int | None = None
        self._is_stopped = False
        self._sent_times = SentTimes()
        self._exposures: dict[int, list[ExposureInterval]] = {}

    def note_header(self, t_ns: int, header: Header, *, is_live: bool) -> int:
        """Note a message, and return the station time at which it was sent; one that came live is
        radio contact.
        """
        sent_ns = self._sent_times.sent_ns(t_ns, header, is_live=is_live)
        if is_live:
            self._note_gap(t_ns)
            self._last_received_ns, self._is_stopped = t_ns, False
            if self._is_about(t_ns):
                self.facts.received_ns.append(t_ns)
        return sent_ns

    def take_event(self, t_ns: int, message: UnitEvent) -> None:
        if message.is_stop_in_order:  # it was switched off: its silence is no radio gap
            self._is_stopped = True
        if self._is_about(t_ns):
            self.facts.events.append((t_ns, message.kind))

    def end(self) -> None:
        self._note_gap(self._during.until_ns)

    def take_temperature(self, t_ns: int, message: Temperature, *, is_live: bool) -> None:
        row = self._wearing_at(t_ns)
        if row is None:
            return
        facts, header, degc = self.facts, message.header, message.ambient_degc
        add = thermal_dose.add_live if is_live else thermal_dose.add_late
        exposures = self._exposures.setdefault(row, [])
        added = add(exposures, header.boot_id, header.t_mono_ns, degc)
        facts.doses[row] = facts.doses.get(row, 0.0) + added
        if row not in facts.hottest or degc > facts.hottest[row][1]:
            facts.hottest[row] = t_ns, degc
        if self._is_about(t_ns):
            facts.temperature_degc.append((t_ns, degc))

    def take_status(self, t_ns: int, message: Status) -> None:
        if self._is_about(t_ns):
            self.facts.motionless_s.append((t_ns, message.motionless_s))
            if message.battery is not None:
                self.facts.battery.append((t_ns, message.battery))

    def _note_gap(self, t_ns: int) -> None:
        last_ns = self._last_received_ns
        if last_ns is not None and not self._is_stopped and t_ns - last_ns > GAP_NS:
            self.facts.radio_gaps.append(Interval(last_ns, t_ns))

    def _wearing_at(self, t_ns: int) -> int | None:
        row = bisect_right(self._begins_ns, t_ns) - 1
        return row if row >= 0 and t_ns < self._wearings[row].until_ns else None

    def _is_about(self, t_ns: int) -> bool:
        return any(one.from_ns <= t_ns <= one.until_ns for one in self._about)
