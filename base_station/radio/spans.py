"""Spans of a channel: when it was recorded, and when there was something on it."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from base_station.radio.opus import is_silence
from base_station.radio.packets import Packet
from shared.clock import NS_PER_MS

_JOINED_NS = 100 * NS_PER_MS  # a shorter gap is none: times of packets are corrected one by one

Span = tuple[int, int]  # station time (ns): from, until


@dataclass(frozen=True, slots=True)
class ChannelSpans:
    """Both in order, without overlap."""

    recorded: tuple[Span, ...] = ()
    voice: tuple[Span, ...] = ()

    def within(self, from_ns: int, until_ns: int) -> ChannelSpans:
        return ChannelSpans(
            tuple(_cut(self.recorded, from_ns, until_ns)),
            tuple(_cut(self.voice, from_ns, until_ns)),
        )


def spans_of(packets: Iterable[Packet]) -> ChannelSpans:
    recorded: list[Span] = []
    voice: list[Span] = []
    for packet in packets:
        span = (packet.t_ns, packet.end_ns)
        _add(recorded, span)
        if not is_silence(packet.data):
            _add(voice, span)
    return ChannelSpans(tuple(recorded), tuple(voice))


def joined(parts: Iterable[ChannelSpans]) -> ChannelSpans:
    """Spans of parts that follow each other in time."""
    recorded: list[Span] = []
    voice: list[Span] = []
    for part in parts:
        for span in part.recorded:
            _add(recorded, span)
        for span in part.voice:
            _add(voice, span)
    return ChannelSpans(tuple(recorded), tuple(voice))


def _add(spans: list[Span], span: Span) -> None:
    if spans and span[0] - spans[-1][1] <= _JOINED_NS:
        spans[-1] = (spans[-1][0], max(spans[-1][1], span[1]))
    else:
        spans.append(span)


def _cut(spans: Iterable[Span], from_ns: int, until_ns: int) -> Iterator[Span]:
    for begin_ns, end_ns in spans:
        cut = max(begin_ns, from_ns), min(end_ns, until_ns)
        if cut[0] < cut[1]:
            yield cut
