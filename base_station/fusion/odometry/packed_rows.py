"""Compressed rows of whole numbers in order of time.

A wearer who walks evenly makes columns with small second differences, most of whose bytes are zero.
A chunk of rows is compressed column by column and byte by byte, without loss.

The number of chunks of each detail is bounded: older rows are thinned again and again, so that the
size grows with the logarithm of time.
"""

from __future__ import annotations

from collections.abc import Callable

import msgspec
import numpy as np
import zstandard
from numpy.typing import NDArray

CHUNK = 128  # rows
MOST_CHUNKS = 32  # of one detail: of rows as they came, 4,096
_BYTES = 8  # of a number
_LEVEL = 3

Records = NDArray[np.void]  # every column "<i8", the first one the time


class RowChunk(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """Times are as in the rows."""

    first: int  # the earliest time
    last: int  # the latest
    thinned: int  # number of times that rows were thinned
    columns: bytes


class Packed(msgspec.Struct, array_like=True):
    """Chunks in the order in which their rows came."""

    chunks: list[RowChunk] = msgspec.field(default_factory=list)

    def __bool__(self) -> bool:
        return bool(self.chunks)

    @property
    def begin(self) -> int:
        """The earliest time of what came first; there is some."""
        return self.chunks[0].first

    def rows(self, row: np.dtype[np.void]) -> Records:
        if not self.chunks:
            return np.empty(0, row)
        return np.concatenate([_rows(chunk, row) for chunk in self.chunks])

    def add(self, rows: Records, thin: Callable[[Records], Records]) -> None:
        """``thin`` leaves out about half of the rows it is given."""
        self.chunks.append(_chunk(rows))
        thinned, two = 0, self._oldest(0)
        while two is not None:
            rows = np.concatenate([_rows(chunk, rows.dtype) for chunk in self.chunks[two]])
            thinned += 1
            self.chunks[two] = [_chunk(thin(rows), thinned)]
            two = self._oldest(thinned)

    def change(self, row: np.dtype[np.void], change: Callable[[Records], Records]) -> None:
        """Every row is what ``change`` makes of it."""
        self.chunks = [_chunk(change(_rows(one, row)), one.thinned) for one in self.chunks]

    def cut(self, before: int, row: np.dtype[np.void]) -> None:
        """Drop rows before a time."""
        kept = []
        for chunk in self.chunks:
            if chunk.first >= before:
                kept.append(chunk)
            elif chunk.last >= before:
                rows = _rows(chunk, row)
                kept.append(_chunk(rows[_times(rows) >= before], chunk.thinned))
        self.chunks = kept

    def _oldest(self, thinned: int) -> slice | None:
        """The two oldest chunks of a detail, where there are too many of them."""
        alike = [at for at, chunk in enumerate(self.chunks) if chunk.thinned == thinned]
        return slice(alike[0], alike[0] + 2) if len(alike) > MOST_CHUNKS else None


def _chunk(rows: Records, thinned: int = 0) -> RowChunk:
    times = _times(rows)
    return RowChunk(int(times.min()), int(times.max()), thinned, _compressed(_columns(rows)))


def _rows(chunk: RowChunk, row: np.dtype[np.void]) -> Records:
    columns = _decompressed(chunk.columns, len(row.names or ()))
    rows: Records = np.ascontiguousarray(columns.T).view(row)
    return rows.ravel()


def _columns(rows: Records) -> NDArray[np.int64]:
    numbers: NDArray[np.int64] = np.ascontiguousarray(rows).view(np.int64)
    return numbers.reshape(len(rows), -1).T


def _times(rows: Records) -> NDArray[np.int64]:
    times: NDArray[np.int64] = _columns(rows)[0]
    return times


def _compressed(columns: NDArray[np.int64]) -> bytes:
    """Second differences with the sign at the lowest bit, so that small ones are mostly zeros."""
    steps = np.diff(columns, n=2, prepend=np.zeros((len(columns), 2), np.int64))
    small = (steps << 1) ^ (steps >> 63)
    planes = small.view(np.uint8).reshape(*small.shape, _BYTES).transpose(0, 2, 1)
    compressed = zstandard.ZstdCompressor(_LEVEL).compress(planes.tobytes())
    return bytes(memoryview(compressed))  # it holds the room that it might have needed


def _decompressed(packed: bytes, columns: int) -> NDArray[np.int64]:
    planes = np.frombuffer(zstandard.ZstdDecompressor().decompress(packed), np.uint8)
    numbers = planes.reshape(columns, _BYTES, -1).transpose(0, 2, 1)
    small = np.ascontiguousarray(numbers).view(np.uint64)[..., 0]
    steps = (small >> np.uint64(1)).view(np.int64) ^ -(small & np.uint64(1)).view(np.int64)
    values: NDArray[np.int64] = steps.cumsum(axis=1).cumsum(axis=1)
    return values
