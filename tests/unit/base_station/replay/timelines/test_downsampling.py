from __future__ import annotations

import random

import pytest

from base_station.replay.timelines.downsampling import Column, MinMaxBuckets
from shared.clock import NS_PER_MS, NS_PER_S

GAP_NS = 10 * NS_PER_S


def downsampled(
    values: list[tuple[float, float]], until_s: float, buckets: int, from_s: float = 0.0
) -> Column:
    kept = MinMaxBuckets(round(from_s * NS_PER_S), round(until_s * NS_PER_S), buckets, GAP_NS)
    for t_s, value in values:
        kept.add(round(t_s * NS_PER_S), value)
    return kept.column()


def test_peak_of_one_sample_keeps_its_place_in_any_downsampling():
    calm = [(float(second), 20.0 + second % 7 / 100) for second in range(36_000)]
    calm[17_777] = (17_777.0, 180.0)
    calm[30_001] = (30_001.0, -40.0)
    column = downsampled(calm, 36_000.0, 200)
    assert len(column.values) <= 400
    of = dict(zip(column.t_ms, column.values, strict=True))
    assert (of[17_777_000], of[30_001_000]) == (180.0, -40.0)
    assert list(column.t_ms) == sorted(column.t_ms)
    assert None not in column.values


def test_short_series_is_returned_unchanged():
    assert downsampled([(1.0, 5.0), (2.0, 7.0), (3.0, 6.0)], 10.0, 100) == Column(
        (1000, 2000, 3000), (5.0, 7.0, 6.0)
    )


@pytest.mark.parametrize("buckets", [10, 1000])
def test_values_further_apart_than_the_limit_have_a_gap(buckets: int):
    before = [(float(second), 1.0) for second in range(100)]
    after = [(float(second), 2.0) for second in range(200, 300)]
    column = downsampled(before + after, 300.0, buckets)
    assert column.values.count(None) == 1
    at = column.values.index(None)
    assert column.t_ms[at] == 99_001
    assert set(column.values[:at]) == {1.0}
    assert set(column.values[at + 1 :]) == {2.0}


def test_pause_up_to_the_limit_is_no_gap():
    assert None not in downsampled([(0.0, 1.0), (10.0, 1.0)], 20.0, 20).values


def test_order_of_values_does_not_matter():
    values = [(float(second), float(second * 37 % 101)) for second in range(500)]
    shuffled = values.copy()
    random.Random(3).shuffle(shuffled)  # no secret: an order
    assert downsampled(shuffled, 500.0, 50) == downsampled(values, 500.0, 50)


def test_values_outside_the_span_are_left_out_and_an_empty_span_has_none():
    values = [(4.0, 1.0), (5.0, 2.0), (9.999, 3.0), (10.0, 4.0)]
    assert downsampled(values, 10.0, 20, from_s=5.0).values == (2.0, 3.0)
    assert downsampled(values, 5.0, 20, from_s=5.0) == Column()
    assert downsampled(values, 4.0, 20, from_s=5.0) == Column()
    kept = MinMaxBuckets(0, NS_PER_MS, 10, GAP_NS)
    assert kept.column() == Column()
