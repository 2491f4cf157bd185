"""Every registered tracker gives the committed results on recorded trials."""

from __future__ import annotations

import numpy as np
import pytest

from tests.golden.tracker_figures import (
    GOLDEN,
    NAMES,
    golden_path,
    measure,
    read_golden,
    trials_of,
)


@pytest.mark.parametrize("name", NAMES)
def test_trajectories_and_figures_equal_the_golden_files(name, hard_walks):
    expected = read_golden(name)
    assert expected, f"{golden_path(name)} is missing: python -m tests.golden.tracker_figures"
    measured = measure(hard_walks.parent, name)
    assert measured.keys() == expected.keys()
    for trial, walked in expected.items():
        # Another processor may round differently; a millimetre is no change of method.
        figures = pytest.approx(walked["figures"], abs=1e-3, rel=1e-3)
        assert measured[trial]["figures"] == figures, trial
        assert measured[trial]["steps"] == walked["steps"], trial
        assert measured[trial]["quality"] == walked["quality"], trial
        np.testing.assert_allclose(
            measured[trial]["path_n_m"], walked["path_n_m"], rtol=1e-3, atol=5e-3, err_msg=trial
        )


def test_each_golden_file_is_of_a_registered_tracker_and_has_every_trial():
    assert {path.stem for path in GOLDEN.glob("*.json")} == set(NAMES)
    assert all(list(read_golden(name)) == list(trials_of(name)) for name in NAMES)
