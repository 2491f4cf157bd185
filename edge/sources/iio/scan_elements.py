"""Frames that an IIO device's buffer delivers, by what ``scan_elements`` says of them.

Elements stand in the order of their index, each at a multiple of its own length, and a frame ends
at a multiple of the longest.  Of an element's bits only some are the value: ``le:s12/16>>4`` is a
little-endian number of 16 bits, of which the upper 12 are the value, with a sign.
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from edge.sources.iio.attributes import UnusableDeviceError, is_one, read_number
from edge.sources.sysfs import read_text
from shared.coded_text import coded

_TYPE = re.compile(r"(be|le):([su])(\d+)/(\d+)(?:X(\d+))?(?:>>(\d+))?")
_STORAGE_BITS = (8, 16, 32, 64)
_WORD_BITS = 64
_ENABLED = "_en"


@dataclass(frozen=True, slots=True)
class ElementType:
    """Type of an element, as its attribute ``_type`` writes it."""

    is_big_endian: bool
    is_signed: bool
    bits: int
    storage_bits: int
    shift: int
    repeat: int

    @property
    def length(self) -> int:
        """Bytes that it takes."""
        return self.storage_bits // 8 * self.repeat

    @property
    def dtype(self) -> np.dtype[np.unsignedinteger]:
        return np.dtype(f"{'>' if self.is_big_endian else '<'}u{self.storage_bits // 8}")

    def values(self, stored: NDArray[np.unsignedinteger]) -> NDArray[np.int64]:
        """Return the values in what was stored."""
        words = stored.astype(np.uint64) << np.uint64(_WORD_BITS - self.bits - self.shift)
        unused = _WORD_BITS - self.bits
        if self.is_signed:
            return words.view(np.int64) >> unused
        return (words >> np.uint64(unused)).view(np.int64)


def parse_type(text: str) -> ElementType:
    """Raises UnusableDeviceError."""
    match = _TYPE.fullmatch(text)
    if match is None:
        raise UnusableDeviceError(
            coded("iio-no-type", "{text!r} is no type of a scan element", text=text)
        )
    endianness, sign, bits, storage_bits, repeat, shift = match.groups()
    of = ElementType(
        is_big_endian=endianness == "be",
        is_signed=sign == "s",
        bits=int(bits),
        storage_bits=int(storage_bits),
        shift=int(shift or 0),
        repeat=max(1, int(repeat or 1)),
    )
    if of.storage_bits not in _STORAGE_BITS or not 0 < of.bits <= of.storage_bits - of.shift:
        raise UnusableDeviceError(
            coded(
                "iio-other-type",
                "{text!r} is a type of a scan element that cannot be read",
                text=text,
            )
        )
    return of


@dataclass(frozen=True, slots=True)
class ScanElement:
    name: str  # of its channel, such as in_accel_x
    index: int
    type: ElementType


def read_element(folder: Path, name: str) -> ScanElement:
    """Return an element of the folder ``scan_elements``.  Raises OSError, UnusableDeviceError."""
    index = int(read_number(folder / f"{name}_index"))
    return ScanElement(name, index, parse_type(read_text(folder / f"{name}_type")))


def element_names(folder: Path) -> list[str]:
    """Return the elements that a buffer may have; none where the device has no buffer."""
    attributes = sorted(folder.glob(f"*{_ENABLED}")) if folder.is_dir() else []
    return [path.name.removesuffix(_ENABLED) for path in attributes]


def enabled_elements(folder: Path) -> list[ScanElement]:
    """Return the elements that are captured now.  Raises OSError and UnusableDeviceError."""
    names = [name for name in element_names(folder) if is_one(folder / f"{name}{_ENABLED}")]
    return [read_element(folder, name) for name in names]


class FrameLayout:
    """Layout of a frame of some elements; ``decode`` reads whole frames."""

    def __init__(self, elements: Iterable[ScanElement]) -> None:
        ordered = sorted(elements, key=lambda element: element.index)
        self._types = {element.name: element.type for element in ordered}
        self._offsets: dict[str, int] = {}
        end = 0
        for name, element_type in self._types.items():
            begin = _aligned(end, element_type.length)
            self._offsets[name] = begin
            end = begin + element_type.length
        self.size = _aligned(end, max((one.length for one in self._types.values()), default=1))

    @property
    def names(self) -> frozenset[str]:
        return frozenset(self._types)

    def decode(self, frames: bytes) -> dict[str, NDArray[np.int64]]:
        """Return the values of each element, one of each frame; of repeated ones the first."""
        return {name: self._column(frames, name) for name in self._types}

    def _column(self, frames: bytes, name: str) -> NDArray[np.int64]:
        element_type = self._types[name]
        stored = np.ndarray(
            shape=(len(frames) // self.size,),
            dtype=element_type.dtype,
            buffer=frames,
            offset=self._offsets[name],
            strides=(self.size,),
        )
        return element_type.values(stored)


def _aligned(position: int, length: int) -> int:
    return -(-position // length) * length
