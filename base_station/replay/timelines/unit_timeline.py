"""Timeline of one unit over a span: positions from the database, everything else from the log.

Memory is bounded by the buckets, whatever the span: each record goes into its bucket at once.
"""

from __future__ import annotations

import math
from collections.abc import Collection, Iterator, Sequence
from dataclasses import dataclass

import msgspec

from base_station.core.events import Received, event_of
from base_station.engine.log_feed import RecordSource
from base_station.replay.radio_contact import CONTACT_CHANNELS, GAP_NS, SentTimes
from base_station.replay.timelines.downsampling import Column, MinMaxBuckets
from base_station.storage.db.records import Records
from base_station.storage.db.window import Window
from base_station.views.wire import TextCodeView
from shared.channels import STATUS, TEMPERATURE, backfilled_key, is_backfilled
from shared.clock import NS_PER_MS, NS_PER_S
from shared.mcap_log import LogRecord
from shared.messages import Command, Status, Temperature

MAX_SPAN_NS = 24 * 3600 * NS_PER_S
_LATE_NS = 3600 * NS_PER_S  # so long after the span, a journal may still bring messages of it
_READ_AT_ONCE_NS = 3600 * NS_PER_S  # of a track
_JOURNALED = (STATUS, TEMPERATURE)


class UnitTimeline(msgspec.Struct, frozen=True):
    """Columns of one unit; station time."""

    temperature_degc: Column  # of the air around the equipment
    height_m: Column  # above the origin of the incident frame
    floor: Column
    activity: Column  # as numbers of ``shared.messages.Activity``
    battery: Column  # 0 empty ... 1 full
    position_error_m: Column  # as stated: root of the summed variances north and east (DRMS)
    silence_s: Column  # before each message that came live
    radio_gaps_ms: tuple[tuple[int, int], ...] = ()  # without a message for longer than 10 s
    defects: tuple[str, ...] = ()  # of the log, in words
    defect_codes: tuple[TextCodeView, ...] = ()  # of ``defects``, in their order


@dataclass(frozen=True)
class TimelineRequest:
    """``window``: at most ``MAX_SPAN_NS``; ``buckets``: of each column."""

    unit_id: str
    window: Window
    buckets: int


def read_timeline(records: Records, log: RecordSource, request: TimelineRequest) -> UnitTimeline:
    """Raises LogError where a segment of the log cannot be opened."""
    timeline = _Timeline(request)
    for record in _of_unit(log, request):
        timeline.take_record(*record)
    timeline.end_contact()
    for part in _parts(request.window):
        for point in records.track(request.unit_id, part):
            timeline.height_m.add(point.t_ns, -point.down_m)
            drms_m = math.hypot(point.std_north_m, point.std_east_m)
            timeline.position_error_m.add(point.t_ns, drms_m)
            if point.floor is not None:
                timeline.floor.add(point.t_ns, point.floor)
    return timeline.result()


def _of_unit(log: RecordSource, request: TimelineRequest) -> Iterator[LogRecord]:
    """Messages of the span, then those that a journal brought later."""
    unit_id, window = request.unit_id, request.window
    late = [backfilled_key(unit_id, channel.suffix) for channel in _JOURNALED]
    live = [channel.key(unit_id) for channel in CONTACT_CHANNELS]
    yield from log.records(window.from_ns, window.until_ns, _keys(live, late))
    yield from log.records(window.until_ns, window.until_ns + _LATE_NS, _keys(late))


def _keys(*groups: Sequence[str]) -> Collection[str]:
    return {key for group in groups for key in group}


def _parts(window: Window) -> Iterator[Window]:
    for from_ns in range(window.from_ns, window.until_ns, _READ_AT_ONCE_NS):
        yield Window(from_ns, min(from_ns + _READ_AT_ONCE_NS, window.until_ns))


class _Timeline:
    def __init__(self, request: TimelineRequest) -> None:
        window = request.window

        def series(gap_ns: int = GAP_NS) -> MinMaxBuckets:
            return MinMaxBuckets(window.from_ns, window.until_ns, request.buckets, gap_ns)

        self._unit_id = request.unit_id
        self._window = window
        self._sent_times = SentTimes()
        self._last_received_ns = window.from_ns  # nothing is known of before
        self._radio_gaps_ms: list[tuple[int, int]] = []
        self.height_m, self.floor, self.position_error_m = series(), series(), series()
        self._temperature_degc, self._activity = series(), series()
        self._battery = series()
        self._silence_s = series(gap_ns=MAX_SPAN_NS)  # one line: its peaks are the gaps

    def take_record(self, t_ns: int, key: str, payload: bytes) -> None:
        event = event_of(t_ns, key, payload)
        if not isinstance(event, Received) or isinstance(event.message, Command):
            return  # it cannot be decoded
        is_live, message = not is_backfilled(key), event.message
        sent_ns = self._sent_times.sent_ns(t_ns, message.header, is_live=is_live)
        if is_live:
            self._note_contact(t_ns)
        match message:
            case Temperature():
                self._temperature_degc.add(sent_ns, message.ambient_degc)
            case Status():
                self._activity.add(sent_ns, float(message.activity))
                if message.battery is not None:
                    self._battery.add(sent_ns, message.battery)

    def end_contact(self) -> None:
        self._note_gap(self._window.until_ns)

    def result(self) -> UnitTimeline:
        return UnitTimeline(
            temperature_degc=self._temperature_degc.column(),
            height_m=self.height_m.column(),
            floor=self.floor.column(),
            activity=self._activity.column(),
            battery=self._battery.column(),
            position_error_m=self.position_error_m.column(),
            silence_s=self._silence_s.column(),
            radio_gaps_ms=tuple(self._radio_gaps_ms),
        )

    def _note_contact(self, t_ns: int) -> None:
        self._silence_s.add(t_ns, (t_ns - self._last_received_ns) / NS_PER_S)
        self._note_gap(t_ns)
        self._last_received_ns = t_ns

    def _note_gap(self, t_ns: int) -> None:
        if t_ns - self._last_received_ns > GAP_NS:
            self._radio_gaps_ms.append((self._last_received_ns // NS_PER_MS, t_ns // NS_PER_MS))
