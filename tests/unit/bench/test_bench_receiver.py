"""The simulated receiver of walks has the errors that it states, for the time that is set."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from tests.bench.fusion.simulated_walks import Errors, Receiver

MINUTE_S = 60.0


def errors_m(errors: Errors, at_s: tuple[float, ...]) -> NDArray[np.float64]:
    """Errors of many receivers (n, times, 2)."""
    rng, drawn = np.random.default_rng(5), []
    for _ in range(2000):
        receiver = Receiver(rng, errors)
        fixes = [receiver.fix(t_s, np.zeros(2)) for t_s in at_s]
        drawn.append([(fix.north_m, fix.east_m) for fix in fixes])
    return np.array(drawn)


@pytest.mark.parametrize("common_m", [0.0, 1.5])
def test_errors_have_the_stated_size(common_m: float) -> None:
    errors = Errors(common_m=common_m)
    off_m = errors_m(errors, (0.0, MINUTE_S))
    assert off_m.std(axis=0) == pytest.approx(np.full((2, 2), errors.fix_std_m), rel=0.05)


def test_common_error_remains_without_own_errors() -> None:
    for common_m in (0.0, 1.5):
        before_m, after_m = errors_m(Errors(common_m=common_m), (0.0, 5.0 * MINUTE_S)).swapaxes(
            0, 1
        )
        left_m2 = float((before_m * after_m).mean())
        assert left_m2 == pytest.approx(common_m**2 * np.exp(-300.0 / 1200.0), abs=0.4)
