"""Events of gait against marked ones."""

from __future__ import annotations

import numpy as np
import pytest

from edge.activity.gait_events import GaitEvents
from tests.bench.tracker.several_sensors import event_errors

MARKED_S = np.array([(1.1, 1.5), (2.2, 2.6)])


def events(*swings_s):
    return GaitEvents(*np.array(swings_s).reshape(-1, 2).T)


def test_errors_are_those_of_toe_off_and_contact():
    errors_s = event_errors(events((1.0, 1.6), (2.0, 2.55)), MARKED_S)
    assert errors_s == pytest.approx(np.array([(-0.1, 0.1), (-0.2, -0.05)]))


@pytest.mark.parametrize("found", [events((1.0, 1.6)), events((1.0, 1.6), (3.2, 3.6))])
def test_marked_swing_without_events_near_it_is_missed(found):
    errors_s = event_errors(found, MARKED_S)
    assert np.isfinite(errors_s[0]).all()
    assert np.isnan(errors_s[1]).all()


def test_all_are_missed_where_nothing_was_found():
    assert np.isnan(event_errors(events(), MARKED_S)).all()
