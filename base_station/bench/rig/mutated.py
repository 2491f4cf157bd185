"""Messages with random contents, and what becomes of their bytes on a bad day; all by a seed."""

from __future__ import annotations

import random
from typing import Any

from google.protobuf.descriptor import FieldDescriptor

from shared.channels import Channel
from shared.codec import WIRE_TYPES
from shared.messages import SCHEMA_REVISION

_INTEGERS = (0, 1, 2, 7, 100, 35_999, 2**31 - 1, 2**32 - 1, 2**63 - 1)
_REALS = (0.0, -1.0, 52.0, 1e-300, 1e300, float("nan"), float("inf"), -float("inf"))
_TEXTS = ("", "a", "FF-01", "Größe \0 \u2028", "x" * 300, "{}", "../../etc")
_BOUNDS = {
    FieldDescriptor.CPPTYPE_INT32: (-(2**31), 2**31 - 1),
    FieldDescriptor.CPPTYPE_INT64: (-(2**63), 2**63 - 1),
    FieldDescriptor.CPPTYPE_UINT32: (0, 2**32 - 1),
    FieldDescriptor.CPPTYPE_UINT64: (0, 2**64 - 1),
    FieldDescriptor.CPPTYPE_ENUM: (0, 20),
}


def random_payload(chance: random.Random, channel: Channel, unit_id: str, seq: int) -> bytes:
    """A message of the channel that is well-formed; what its fields say may make no sense."""
    wire = WIRE_TYPES[channel.message]()
    _fill(chance, wire, depth=3)
    header = wire.header  # type: ignore[attr-defined]  # every message has one
    header.unit_id, header.schema, header.seq = unit_id, SCHEMA_REVISION, seq
    header.boot_id = chance.choice((0xB007, 0xB007, 0xB007, chance.getrandbits(64)))
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
    for field in wire.DESCRIPTOR.fields:
        if chance.random() < 0.2:
            continue
        if field.cpp_type == FieldDescriptor.CPPTYPE_MESSAGE:
            if depth == 0:
                continue
            if field.message_type.GetOptions().map_entry:
                of_entry = field.message_type.fields_by_name
                for _ in range(chance.randrange(3)):
                    key, value = (_value(chance, of_entry[name]) for name in ("key", "value"))
                    getattr(wire, field.name)[key] = value
            elif field.is_repeated:
                for _ in range(chance.randrange(3)):
                    _fill(chance, getattr(wire, field.name).add(), depth - 1)
            else:
                part = getattr(wire, field.name)
                part.SetInParent()
                _fill(chance, part, depth - 1)
        elif field.is_repeated:
            count = chance.choice((0, 1, 6, 40))
            getattr(wire, field.name).extend(_value(chance, field) for _ in range(count))
        else:
            setattr(wire, field.name, _value(chance, field))


def _value(chance: random.Random, field: FieldDescriptor) -> Any:
    kind = field.cpp_type
    if kind in _BOUNDS:
        least, most = _BOUNDS[kind]
        number = chance.choice((*_INTEGERS, -1, chance.randint(least, most)))
        return min(max(number, least), most)
    if kind in (FieldDescriptor.CPPTYPE_DOUBLE, FieldDescriptor.CPPTYPE_FLOAT):
        return chance.choice((*_REALS, chance.uniform(-1e4, 1e4)))
    if kind == FieldDescriptor.CPPTYPE_BOOL:
        return chance.random() < 0.5
    text = chance.choice(_TEXTS)
    return text.encode() if field.type == FieldDescriptor.TYPE_BYTES else text
