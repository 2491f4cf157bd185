"""Updates of filterpy, with the rest of its functions, though its statistics are loaded late."""

from __future__ import annotations

import subprocess
import sys

import pytest

PROGRAM = """
import sys
from base_station.fusion.kalman_update import update
assert "scipy.stats" not in sys.modules
import numpy as np
from filterpy import kalman, stats
assert update is kalman.update
first = np.array([[1.0, 0.0]])
mean, covariance = update(np.zeros(2), np.eye(2), np.array([1.0]), np.eye(1), first)
assert mean.tolist() == [0.5, 0.0]
assert covariance.tolist() == [[0.5, 0.0], [0.0, 1.0]]
assert "scipy.stats" not in sys.modules
deferred = stats.logpdf(1.0, 2.0, 3.0), stats.norm_cdf((1.0, 2.0), 0.0)
from scipy.stats import multivariate_normal, norm
assert deferred == (multivariate_normal.logpdf(1.0, 2.0, 3.0), norm.cdf(2.0) - norm.cdf(1.0))
assert stats.plot_gaussian_cdf.__globals__["norm"](1.0, 2.0).mean() == 1.0
"""


@pytest.mark.slow
def test_statistics_are_loaded_when_filterpy_first_uses_them() -> None:
    subprocess.run([sys.executable, "-c", PROGRAM], check=True)


@pytest.mark.slow
def test_statistics_loaded_before_are_those_of_filterpy() -> None:
    program = "import scipy.stats\nfrom base_station.fusion import kalman_update\n"
    program += "from filterpy.stats import stats\nassert stats.norm is scipy.stats.norm\n"
    subprocess.run([sys.executable, "-c", program], check=True)
