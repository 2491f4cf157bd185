"""Configuration that the other datasets would have chosen."""

from __future__ import annotations

import pytest

from edge.tracker.foot.config import EskfConfig
from tests.bench.tracker.cross_validation import candidates, leave_one_out


def test_each_dataset_is_judged_by_the_choice_of_the_others():
    errors_m = {
        "default": {"a": [1.0, 1.0], "b": [1.0], "c": [1.0]},
        "good for a": {"a": [0.1, 0.1], "b": [2.0], "c": [2.0]},
        "good for b": {"a": [1.1, 1.3], "b": [0.1], "c": [1.1]},
    }
    by_dataset = {entry.dataset: entry for entry in leave_one_out(errors_m)}
    assert by_dataset["a"].chosen == "good for b"
    assert by_dataset["a"].chosen_mean_m == pytest.approx(1.2)
    assert by_dataset["a"].default_mean_m == pytest.approx(1.0)
    assert by_dataset["b"].chosen == "good for a"


def test_candidates_change_one_parameter_each():
    default = EskfConfig()
    for name, config in candidates().items():
        changed = sum(
            a != b
            for part, of_default in zip(config[1:], default[1:], strict=True)
            for a, b in zip(part, of_default, strict=True)
        )
        assert changed == (0 if name == "default" else 1), name
