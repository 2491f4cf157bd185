"""Messages with random contents, and what becomes of their bytes on a bad day; all by a seed."""

from __future__ import annotations

import random
from collections import defaultdict, deque
from collections.abc import Callable, Sequence
from functools import cache
from typing import Any, TypeVar

from google.protobuf.descriptor import Descriptor, FieldDescriptor

from shared.channels import Channel
from shared.codec import WIRE_TYPES
from shared.messages import SCHEMA_REVISION
from shared.messages.muster.v1.header_pb2 import AnyMessage

# None: any other of the type.
_INTEGERS = (None, -1, 0, 1, 2, 7, 100, 35_999, 2**31 - 1, 2**32 - 1, 2**63 - 1)
_REALS = (None, 0.0, -1.0, 52.0, 1e-300, 1e300, float("nan"), float("inf"), -float("inf"))
_TEXTS = ("", "a", "FF-01", "Größe \0 \u2028", "x" * 300, "{}", "../../etc")
T = TypeVar("T")
Filling = Callable[[random.Random, Any, int], None]  # of one field, so many levels deep
_BOUNDS = {
    FieldDescriptor.CPPTYPE_INT32: (-(2**31), 2**31 - 1),
    FieldDescriptor.CPPTYPE_INT64: (-(2**63), 2**63 - 1),
    FieldDescriptor.CPPTYPE_UINT32: (0, 2**32 - 1),
    FieldDescriptor.CPPTYPE_UINT64: (0, 2**64 - 1),
    FieldDescriptor.CPPTYPE_ENUM: (0, 20),
}


def random_payload(chance: random.Random, channel: Channel, unit_id: str, seq: int) -> bytes:
    """A message of the channel that is well-formed; what its fields say may make no sense."""
    return _random_header(chance, unit_id, seq) + _random_contents(chance, channel)


class RandomPayloads:
    """``random_payload`` for very many: each has its own header, and the contents of one in eight
    are new; those of the others were in one of the channel's last 32 new ones.
    """

    def __init__(self, chance: random.Random) -> None:
        self._chance = chance
        self._recent: defaultdict[Channel, deque[bytes]] = defaultdict(lambda: deque(maxlen=32))

    def next(self, channel: Channel, unit_id: str, seq: int) -> bytes:
        recent = self._recent[channel]
        if not recent or self._chance.random() < 1 / 8:
            recent.append(_random_contents(self._chance, channel))
        return _random_header(self._chance, unit_id, seq) + _one_of(self._chance, recent)


def _random_header(chance: random.Random, unit_id: str, seq: int) -> bytes:
    """As the first field of any message."""
    wire = AnyMessage()
    header = wire.header
    _fill(chance, header, depth=0)
    header.unit_id, header.schema, header.seq = unit_id, SCHEMA_REVISION, seq
    header.boot_id = 0xB007 if chance.random() < 0.95 else chance.getrandbits(64)
    return wire.SerializeToString()


def _random_contents(chance: random.Random, channel: Channel) -> bytes:
    """All but the header."""
    wire = WIRE_TYPES[channel.message]()
    _fill(chance, wire, depth=3)
    wire.ClearField("header")
    return wire.SerializeToString()


def mutated(chance: random.Random, payload: bytes) -> bytes:
    """The payload as it is, or with something done to it."""
    data = bytearray(payload)
    match chance.randrange(8):
        case 0:
            return payload
        case 1:
            return chance.randbytes(chance.randrange(300))
        case 2:
            del data[chance.randrange(len(data) + 1) :]
        case 3:
            begin = chance.randrange(len(data) + 1)
            del data[begin : begin + chance.randrange(1, 9)]
        case 4:
            begin = chance.randrange(len(data) + 1)
            data[begin:begin] = chance.randbytes(chance.randrange(1, 9))
        case 5:
            begin = chance.randrange(len(data) + 1)
            data[begin:begin] = data[begin : begin + chance.randrange(1, 40)]
        case _:
            for _ in range(chance.choice((1, 1, 2, 8))):
                if data:
                    data[chance.randrange(len(data))] ^= 1 << chance.randrange(8)
    return bytes(data)


def _fill(chance: random.Random, wire: Any, depth: int) -> None:
    draw = chance.random
    for fill in _fillings(wire.DESCRIPTOR):
        if draw() >= 0.2:
            fill(chance, wire, depth)


@cache
def _fillings(message: Descriptor) -> tuple[Filling, ...]:
    """One for each field: what a field is takes longer to look up than to draw its value."""
    return tuple(_filling(field) for field in message.fields)


def _filling(field: FieldDescriptor) -> Filling:
    if field.cpp_type == FieldDescriptor.CPPTYPE_MESSAGE:
        return _filling_of_part(field)
    name, value = field.name, _values(field)
    if field.is_repeated:

        def fill(chance: random.Random, wire: Any, _depth: int) -> None:
            count = _one_of(chance, (0, 1, 6, 40))
            getattr(wire, name).extend(value(chance) for _ in range(count))

        return fill
    return lambda chance, wire, _depth: setattr(wire, name, value(chance))


def _filling_of_part(field: FieldDescriptor) -> Filling:
    name, part_type = field.name, field.message_type
    assert part_type is not None
    if part_type.GetOptions().map_entry:
        key, value = (_values(part_type.fields_by_name[one]) for one in ("key", "value"))

        def fill(chance: random.Random, wire: Any, depth: int) -> None:
            for _ in range(chance.randrange(3) if depth else 0):
                drawn = key(chance)
                getattr(wire, name)[drawn] = value(chance)

    elif field.is_repeated:

        def fill(chance: random.Random, wire: Any, depth: int) -> None:
            for _ in range(chance.randrange(3) if depth else 0):
                _fill(chance, getattr(wire, name).add(), depth - 1)

    else:

        def fill(chance: random.Random, wire: Any, depth: int) -> None:
            if depth:
                part = getattr(wire, name)
                part.SetInParent()
                _fill(chance, part, depth - 1)

    return fill


def _values(field: FieldDescriptor) -> Callable[[random.Random], Any]:
    """Draws a value of the field's type."""
    kind = field.cpp_type
    if kind in _BOUNDS:
        least, most = _BOUNDS[kind]
        within = [None if one is None else min(max(one, least), most) for one in _INTEGERS]

        def integer(chance: random.Random) -> int:
            number = _one_of(chance, within)
            return chance.randint(least, most) if number is None else number

        return integer
    if kind in (FieldDescriptor.CPPTYPE_DOUBLE, FieldDescriptor.CPPTYPE_FLOAT):

        def real(chance: random.Random) -> float:
            number = _one_of(chance, _REALS)
            return chance.uniform(-1e4, 1e4) if number is None else number

        return real
    if kind == FieldDescriptor.CPPTYPE_BOOL:
        return lambda chance: chance.random() < 0.5
    encoded = field.type == FieldDescriptor.TYPE_BYTES
    texts = [text.encode() if encoded else text for text in _TEXTS]
    return lambda chance: _one_of(chance, texts)


def _one_of(chance: random.Random, values: Sequence[T]) -> T:
    """As ``chance.choice``, in a third of its time."""
    return values[int(chance.random() * len(values))]
