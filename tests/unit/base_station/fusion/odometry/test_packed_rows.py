"""Rows of integers in chunks: no number is changed, and old rows are thinned."""

from __future__ import annotations

import tracemalloc
from collections import Counter

import msgspec
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from base_station.fusion.odometry.packed_rows import CHUNK, MOST_CHUNKS, Packed, Records

ROW = np.dtype([("t", "<i8"), ("one", "<i8"), ("other", "<i8")])
ANY = st.integers(-(2**63), 2**63 - 1)


def as_they_are(rows: Records) -> Records:
    return rows


def every_other(rows: Records) -> Records:
    return rows[::2]


def chunk(begin: int) -> Records:
    rows = np.zeros(CHUNK, ROW)
    rows["t"] = begin * CHUNK + np.arange(CHUNK)
    return rows


@pytest.mark.slow
@given(st.lists(st.tuples(ANY, ANY, ANY), min_size=1, max_size=40))
def test_every_number_comes_back(numbers: list[tuple[int, int, int]]) -> None:
    rows, packed = np.array(numbers, ROW), Packed()
    packed.add(rows, as_they_are)
    packed.add(rows[:1], as_they_are)
    again = msgspec.msgpack.decode(msgspec.msgpack.encode(packed), type=Packed)
    assert again.rows(ROW).tolist() == [*numbers, numbers[0]]
    assert packed.begin == min(number[0] for number in numbers)


def test_no_rows_stay_no_rows() -> None:
    assert not Packed()
    assert len(Packed().rows(ROW)) == 0


def test_even_rows_take_hardly_a_byte() -> None:
    rows = chunk(0)
    rows["one"] = -7 * rows["t"]
    packed = Packed()
    packed.add(rows, as_they_are)
    assert sum(len(one.columns) for one in packed.chunks) < 0.5 * CHUNK


def test_packed_rows_hold_little_more_than_their_packed_size() -> None:
    packed = Packed()
    packed.add(chunk(0), as_they_are)
    tracemalloc.start()
    try:
        for number in range(1, 33):
            packed.add(chunk(number), as_they_are)
        held_bytes, _ = tracemalloc.get_traced_memory()
    finally:
        tracemalloc.stop()
    assert held_bytes < 3.0 * 32 * CHUNK


def test_number_of_chunks_of_each_detail_is_bounded() -> None:
    packed, added = Packed(), 20 * MOST_CHUNKS
    for number in range(added):
        packed.add(chunk(number), every_other)
    alike = Counter(one.thinned for one in packed.chunks)
    assert max(alike.values()) <= MOST_CHUNKS
    assert len(alike) < 7  # twenty times as long is not twenty times as much
    times = packed.rows(ROW)["t"]
    assert times[0] == 0
    assert (np.diff(times) > 0).all()
    assert times[-MOST_CHUNKS * CHUNK :].tolist() == list(
        range((added - MOST_CHUNKS) * CHUNK, added * CHUNK)
    )


@pytest.mark.parametrize("before", [0, 1, CHUNK, CHUNK + 1, 4 * CHUNK - 1, 4 * CHUNK])
def test_cut_rows_begin_at_the_cut(before: int) -> None:
    packed = Packed()
    for number in range(4):
        packed.add(chunk(number), as_they_are)
    packed.cut(before, ROW)
    assert packed.rows(ROW)["t"].tolist() == list(range(before, 4 * CHUNK))


def test_unordered_rows_are_cut_by_their_own_times() -> None:
    rows, packed = chunk(0), Packed()
    packed.add(rows[::-1], as_they_are)
    packed.add(rows[:2], as_they_are)
    packed.cut(CHUNK - 2, ROW)
    assert packed.rows(ROW)["t"].tolist() == [CHUNK - 1, CHUNK - 2]
