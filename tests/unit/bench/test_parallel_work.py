"""Long work in parts, in several processes."""

from __future__ import annotations

import math
import os

import pytest

from tests.rig.parallel_work import side_by_side


def process_of(_: int) -> int:
    return os.getpid()


def test_results_come_in_the_order_of_the_parts() -> None:
    parts = range(20, 0, -1)
    assert list(side_by_side(math.factorial, parts, "")) == [math.factorial(one) for one in parts]


def test_work_runs_in_another_process() -> None:
    assert os.getpid() not in set(side_by_side(process_of, range(4), ""))


def test_exception_of_the_work_is_raised_here() -> None:
    with pytest.raises(ValueError, match="factorial"):
        list(side_by_side(math.factorial, [3, -1, 4], ""))
