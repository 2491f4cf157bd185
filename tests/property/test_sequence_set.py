"""A set of sequence numbers kept as runs behaves as a set."""

from __future__ import annotations

from itertools import pairwise

import msgspec
from hypothesis import given
from hypothesis import strategies as st

from shared.sequence_set import Run, SequenceSet

NUMBERS = st.lists(st.integers(0, 60))


def filled(numbers: list[int]) -> SequenceSet:
    held = SequenceSet()
    for number in numbers:
        held.add(number)
    return held


@given(NUMBERS)
def test_set_holds_added_numbers_and_returns_new_ones(numbers):
    held, plain = SequenceSet(), set()
    for number in numbers:
        assert held.add(number) == (number not in plain)
        plain.add(number)
    assert {number for number in range(-1, 62) if number in held} == plain


@given(NUMBERS, NUMBERS)
def test_discarded_number_is_not_in_the_set(numbers, gone):
    held = filled(numbers)
    for number in gone:
        held.discard(number)
    left = set(numbers) - set(gone)
    assert {number for number in range(-1, 62) if number in held} == left
    assert held == filled(sorted(left))


@given(NUMBERS)
def test_runs_are_sorted_and_apart(numbers):
    runs = list(filled(numbers).runs())
    assert all(run.first <= run.last for run in runs)
    assert all(a.last + 1 < b.first for a, b in pairwise(runs))


@given(NUMBERS, st.integers(0, 60), st.integers(0, 60))
def test_missing_numbers_are_the_complement(numbers, first, last):
    missing = [
        number
        for run in filled(numbers).missing(first, last)
        for number in range(run.first, run.last + 1)
    ]
    assert missing == [n for n in range(first, last + 1) if n not in set(numbers)]


@given(NUMBERS, st.integers(0, 60), st.integers(0, 60))
def test_newest_missing_number_is_the_last(numbers, first, last):
    held = filled(numbers)
    assert held.newest_missing(first, last) == ([None, *held.missing(first, last)][-1])


@given(NUMBERS, st.integers(0, 60))
def test_complete_to_is_the_begin_of_the_first_gap(numbers, first):
    expected = first - 1
    while expected + 1 in set(numbers):
        expected += 1
    assert filled(numbers).complete_to(first) == expected


@given(NUMBERS, st.integers(0, 60), st.integers(0, 60))
def test_run_equals_its_numbers(numbers, one, other):
    first, last = sorted((one, other))
    at_once = filled(numbers)
    at_once.add_run(Run(first, last))
    assert at_once == filled([*numbers, *range(first, last + 1)])


@given(NUMBERS)
def test_set_survives_serialisation(numbers):
    held = filled(numbers)
    assert msgspec.msgpack.decode(msgspec.msgpack.encode(held), type=SequenceSet) == held
