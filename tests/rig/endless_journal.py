"""A journal that never ends: it has whatever it is asked for."""

from __future__ import annotations

import secrets
from collections.abc import Callable, Iterable, Iterator

from google.protobuf.internal.encoder import TagBytes
from google.protobuf.internal.wire_format import WIRETYPE_LENGTH_DELIMITED

from shared.bus import QueryHandler
from shared.channels import EVENT, POSITION
from shared.codec import encode
from shared.messages import (
    EventKind,
    Header,
    JournalBoot,
    JournalChunk,
    JournalEntry,
    JournalIndex,
    UnitEvent,
)
from tests.rig.message_factory import position

LAST = 10**9  # its highest number
_ANSWERED = 40_000  # entries of one answer at most
_LARGE_BYTES = 2000
_UNKNOWN_FIELD = 1000


def _endless_journal(
    unit_id: str,
    boot_id: int,
    suffix: str,
    payload_of: Callable[[Header], bytes],
    *,
    entries: int = 400,
    most_asked: bool = False,
) -> QueryHandler:
    """Answers for the journal of ``unit_id``, all of it of one run of its program: ``entries`` in
    each reply, without end or, by ``most_asked``, as much as was asked for, of which all is kept.
    """

    def answer(key: str, parameters: str, _payload: bytes) -> Iterator[bytes]:
        asked = _asked(parameters)
        if key.endswith(("/index", "/acknowledge")):
            yield JournalIndex((JournalBoot(boot_id, 1, LAST, 0, 0),)).to_bytes()
            return
        first, last = int(asked["from"]), int(asked["to"])
        total = 0
        for begin in range(first, min(last, first + _ANSWERED) + 1, entries):
            end = min(last, begin + entries - 1)
            headers = (Header(unit_id, boot_id, number, number) for number in range(begin, end + 1))
            found = tuple(JournalEntry(one.seq, suffix, payload_of(one)) for one in headers)
            yield JournalChunk(boot_id, begin, end, found, key.endswith("/urgent")).to_bytes()
            total += sum(len(one.payload) for one in found)
            if most_asked and total >= int(asked.get("total", 0)):
                return

    return answer


def large_journal(unit_id: str, boot_id: int) -> QueryHandler:
    """Positions of 2 kB that nothing compresses, also where alerts alone are asked for."""
    return _endless_journal(
        unit_id,
        boot_id,
        POSITION.suffix,
        _large_position,
        entries=20,
        most_asked=True,
    )


def ordinary_large_journal(unit_id: str, boot_id: int) -> QueryHandler:
    """As ``large_journal``, and without alerts."""
    answer = large_journal(unit_id, boot_id)

    def ordinary(key: str, parameters: str, payload: bytes) -> Iterable[bytes]:
        if not key.endswith("/urgent"):
            return answer(key, parameters, payload)
        asked = _asked(parameters)
        chunk = JournalChunk(boot_id, int(asked["from"]), int(asked["to"]), (), urgent_only=True)
        return [chunk.to_bytes()]

    return ordinary


def mayday_journal(unit_id: str, boot_id: int) -> QueryHandler:
    """All that it ever had to say are maydays."""
    return _endless_journal(unit_id, boot_id, EVENT.suffix, _mayday)


def _asked(parameters: str) -> dict[str, str]:
    return dict(pair.split("=") for pair in parameters.split(";") if pair)


def _mayday(header: Header) -> bytes:
    return encode(UnitEvent(header, EventKind.MAYDAY))


def _large_position(header: Header) -> bytes:
    """With a field more, of a version to come, that nothing compresses."""
    filling = secrets.token_bytes(_LARGE_BYTES)
    length = bytes([_LARGE_BYTES & 0x7F | 0x80, _LARGE_BYTES >> 7])
    tag = TagBytes(_UNKNOWN_FIELD, WIRETYPE_LENGTH_DELIMITED)
    return encode(position(header)) + tag + length + filling
