"""Recorded walks give the figures they gave when somebody last looked."""

from __future__ import annotations

import json

import pytest

from tests.golden.tracker_figures import GOLDEN, measure


def test_figures_change_only_on_purpose(walks):
    expected = json.loads(GOLDEN.read_text())
    measured = measure(walks)
    assert measured.keys() == expected.keys()
    for trial, figures in expected.items():
        # Another processor may round differently; a millimetre is no change of method.
        assert measured[trial] == pytest.approx(figures, abs=1e-3, rel=1e-3), trial
