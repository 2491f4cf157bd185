"""Frames of an IIO buffer: elements of any layout are read back."""

from __future__ import annotations

import ctypes
from dataclasses import dataclass

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from edge.sources.iio.attributes import UnusableDeviceError
from edge.sources.iio.scan_elements import FrameLayout, ScanElement, parse_type

_C_TYPES = {8: ctypes.c_uint8, 16: ctypes.c_uint16, 32: ctypes.c_uint32, 64: ctypes.c_uint64}


@dataclass(frozen=True)
class Element:
    big: bool
    signed: bool
    bits: int
    storage: int
    shift: int
    values: tuple[int, int]  # of two frames
    noise: int  # in the bits outside the value

    @property
    def type(self) -> str:
        endianness, sign = "be" if self.big else "le", "s" if self.signed else "u"
        return f"{endianness}:{sign}{self.bits}/{self.storage}>>{self.shift}"

    def stored(self, frame: int) -> bytes:
        mask = ((1 << self.bits) - 1) << self.shift
        word = (self.values[frame] << self.shift) & mask | self.noise & ~mask
        word &= (1 << self.storage) - 1
        return word.to_bytes(self.storage // 8, "big" if self.big else "little")


@st.composite
def elements(draw: st.DrawFn) -> Element:
    storage = draw(st.sampled_from(sorted(_C_TYPES)))
    bits = draw(st.integers(1, storage))
    signed = draw(st.booleans())
    if not signed:
        bits = min(bits, 63)  # greater values have no place in a signed number
    least, most = (-(1 << bits - 1), (1 << bits - 1) - 1) if signed else (0, (1 << bits) - 1)
    return Element(
        big=draw(st.booleans()),
        signed=signed,
        bits=bits,
        storage=storage,
        shift=draw(st.integers(0, storage - bits)),
        values=(draw(st.integers(least, most)), draw(st.integers(least, most))),
        noise=draw(st.integers(0, 2**64 - 1)),
    )


@given(st.lists(elements(), min_size=1, max_size=9), st.randoms(use_true_random=False))
def test_elements_are_read_from_compiler_alignment(frame, random) -> None:
    """The kernel aligns elements as a compiler aligns the fields of a structure."""
    names = [f"e{number}" for number in range(len(frame))]
    fields = [(name, _C_TYPES[one.storage]) for name, one in zip(names, frame, strict=True)]
    structure = type("Frame", (ctypes.Structure,), {"_fields_": fields})
    size = ctypes.sizeof(structure)
    data = bytearray(random.randbytes(2 * size))  # padding holds any bytes
    for number in range(2):
        for name, one in zip(names, frame, strict=True):
            begin = number * size + getattr(structure, name).offset
            data[begin : begin + one.storage // 8] = one.stored(number)

    scanned = [
        ScanElement(name, 3 * index, parse_type(one.type))
        for index, (name, one) in enumerate(zip(names, frame, strict=True))
    ]
    random.shuffle(scanned)
    layout = FrameLayout(scanned)
    assert layout.size == size
    decoded = layout.decode(bytes(data))
    for name, one in zip(names, frame, strict=True):
        assert decoded[name].dtype == np.int64
        assert tuple(decoded[name].tolist()) == one.values, one.type


@given(st.text(max_size=12))
def test_text_without_type_is_refused(text: str) -> None:
    with pytest.raises(UnusableDeviceError):
        parse_type(text)


@pytest.mark.parametrize(
    "text", ["le:s16/24>>0", "le:s17/16>>0", "le:s12/16>>5", "le:u0/16>>0", "s16/16>>0"]
)
def test_impossible_types_are_refused(text: str) -> None:
    with pytest.raises(UnusableDeviceError, match="type of a scan element"):
        parse_type(text)


@pytest.mark.parametrize("text", ["le:s16/16", "le:s16/16X1>>0", "le:s16/16>>0"])
def test_shift_and_repeat_may_be_left_out(text: str) -> None:
    assert parse_type(text) == parse_type("le:s16/16>>0")


def test_repeated_elements_take_their_place() -> None:
    quaternion = ScanElement("in_rot_quaternion", 0, parse_type("le:s16/16X4>>0"))
    after = ScanElement("in_accel_x", 1, parse_type("le:s16/16>>0"))
    layout = FrameLayout((quaternion, after))
    assert layout.size == 16
    assert layout.decode(bytes(8) + b"\x05\x00" + bytes(6))["in_accel_x"].tolist() == [5]
