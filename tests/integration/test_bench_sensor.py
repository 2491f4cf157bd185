"""``muster bench sensor`` measures an agent that takes every sample; targets are not asserted."""

from __future__ import annotations

import pytest

from tests.bench.sensor import measure, raw_walk
from tests.bench.whole_unit import measure_whole_unit
from tests.rig.kernel_devices import has_umockdev

pytestmark = pytest.mark.skipif(
    not has_umockdev(), reason="no umockdev: install the package umockdev"
)


def test_an_agent_is_measured_while_it_takes_every_sample() -> None:
    row = measure("one device", "iio:bmi160", "eskf", 2.0, raw_walk())
    assert row.cores > 0.0
    assert row.rate_hz == pytest.approx(400.0, rel=0.01)
    assert row.longest_gap_ms == pytest.approx(2.5, abs=0.01)


def test_complete_unit_is_measured_with_its_temperatures(tmp_path_factory) -> None:
    machine = tmp_path_factory.mktemp("m", numbered=True)
    figures = measure_whole_unit(1.0, 2, machine, raw_walk())
    assert figures.cores > 0.0
    assert len(figures.temperature_s) == 2
    assert min(figures.temperature_s) > 0.0
