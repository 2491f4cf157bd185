"""Thresholds to rehearse, as a person types them."""

from __future__ import annotations

import pytest

from base_station.replay.rehearsal.changes import changes_of, sweep_of
from shared.errors import ConfigError, UserError


def test_names_may_have_underscores() -> None:
    assert changes_of(["no_motion.alarm_s=25", "heat.warning_degc = 150"]) == {
        "no-motion.alarm_s": 25.0,
        "heat.warning_degc": 150.0,
    }


def test_sweep_has_both_ends() -> None:
    assert sweep_of("no_motion.alarm_s=15:60:5") == (
        "no-motion.alarm_s",
        [15.0, 20.0, 25.0, 30.0, 35.0, 40.0, 45.0, 50.0, 55.0, 60.0],
    )
    assert sweep_of("battery.low=0.1:0.3:0.1")[1] == [0.1, 0.2, 0.3]


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("no_motin.alarm_s=25", "did you mean no-motion"),
        ("no_motion.alarm=25", "did you mean alarm_s"),
        ("no_motion.alarm_s=2", "5.0"),
        ("mayday.alarm_s=2", "mayday has none"),
    ],
)
def test_unknown_or_impossible_threshold_is_named(text: str, message: str) -> None:
    with pytest.raises(ConfigError, match=message):
        changes_of([text])


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("no_motion", "no-motion.alarm_s=25"),
        ("no_motion.alarm_s", "no-motion.alarm_s=25"),
        ("no_motion.alarm_s=soon", "'soon' is no number"),
        ("no_motion.alarm_s=nan", "'nan'"),
        ("no_motion.rearm_after_s=20", "people did"),
    ],
)
def test_threshold_that_cannot_be_rehearsed_is_refused(text: str, message: str) -> None:
    with pytest.raises(UserError, match=message):
        changes_of([text])


@pytest.mark.parametrize("values", ["15:60", "60:15:5", "15:60:0", "15:60:-1", "15:60:0.001"])
def test_impossible_sweep_is_refused(values: str) -> None:
    with pytest.raises(UserError, match=r"no-motion\.alarm_s"):
        sweep_of(f"no-motion.alarm_s={values}")


def test_one_threshold_has_one_value() -> None:
    with pytest.raises(UserError, match="twice"):
        changes_of(["no_motion.alarm_s=25", "no-motion.alarm_s=40"])
