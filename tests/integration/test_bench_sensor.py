"""``muster bench sensor`` measures an agent that takes every sample; how fast is not asserted."""

from __future__ import annotations

import pytest

from edge.app.jit_warmup import compile_trackers
from tests.bench.sensor import measure, raw_walk
from tests.rig.kernel_devices import has_umockdev


@pytest.mark.skipif(not has_umockdev(), reason="no umockdev: install the package umockdev")
def test_an_agent_is_measured_while_it_takes_every_sample() -> None:
    compile_trackers()
    row = measure("one device", "iio:bmi160", "eskf", 2.0, raw_walk())
    assert row.cores > 0.0
    assert row.rate_hz == pytest.approx(400.0, rel=0.01)
    assert row.longest_gap_ms == pytest.approx(2.5, abs=0.01)
