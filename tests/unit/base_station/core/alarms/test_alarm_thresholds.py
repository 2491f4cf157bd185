"""Thresholds of a station's settings: refusals, and the time from which they apply."""

from __future__ import annotations

import math
from pathlib import Path

import pytest

from base_station.config import StationConfig
from base_station.core.alarms import ALARMS
from base_station.core.alarms.no_motion import NoMotion
from base_station.core.alarms.thresholds import thresholds_of, with_thresholds
from base_station.core.checkpoint import read_checkpoint
from base_station.core.pipeline import StationPipeline
from base_station.fusion import FUSERS
from shared.channels import OPERATOR
from shared.codec import decode, encode
from shared.config import load_config
from shared.errors import ConfigError
from shared.messages import STATION_ID, Header, OperatorAction
from shared.messages.station import SetThresholds
from tests.rig.station_script import Script

UNIT = "FF-01"
LATER = {"no-motion.pre_alert_s": 40.0, "no-motion.alarm_s": 60.0}


def set_by(tmp_path: Path, toml: str) -> dict[str, float]:
    path = tmp_path / "station.toml"
    path.write_text(toml)
    return thresholds_of(ALARMS, load_config(path, StationConfig).alarms)


def standing(script: Script) -> list[tuple[str, str]]:
    alarms = script.pipeline.state.alarms.values()
    return [(alarm.rule, alarm.level) for alarm in alarms if alarm.is_open]


def motionless(script: Script, motionless_s: float) -> None:
    script.now_s += 1.0
    script.status(UNIT, motionless_s=motionless_s)


@pytest.fixture
def script() -> Script:
    script = Script()
    script.register(UNIT)
    return script


@pytest.mark.parametrize(
    ("toml", "reported"),
    [
        ("[alarms.no_motion]\nalarm_s = 25\n", "did you mean no-motion?"),
        ("[alarms.no-motion]\nalarm = 25\n", "did you mean alarm_s?"),
        ("[alarms.no-motion]\nalarm_ms = 25\n", "its unit is another: alarm_s"),
        ("[alarms.no-motion]\nname = 25\n", "alarms.no-motion.name is not a setting"),
        ("[alarms.no-motion]\nalarm_s = 0\n", "alarms.no-motion.alarm_s: Expected `float` >= 5.0"),
        ("[alarms.battery]\nlow = nan\n", "alarms.battery.low"),
        ("[alarms.no-motion]\nalarm_s = 15\n", "alarms.no-motion: pre_alert_s comes"),
        ("[alarms.heat]\ncaution_degc = 200\n", "must rise"),
        ("[alarms.battery]\nlow = 0.6\nhysteresis = 0.5\n", "more than a full one"),
        (
            "[alarms.mayday]\nafter_s = 3\n",
            "is not a setting; mayday has none",
        ),
        ("[alarms]\nbattery = 0.2\n", "Expected `object`"),
    ],
)
def test_setting_without_rule_is_refused(tmp_path: Path, toml: str, reported: str) -> None:
    with pytest.raises(ConfigError) as error:
        set_by(tmp_path, toml)
    assert reported in str(error.value)


def test_only_changed_thresholds_are_listed(tmp_path: Path) -> None:
    toml = "[alarms.no-motion]\npre_alert_s = 20.0\nalarm_s = 25\n[alarms.battery]\nlow = 0.2\n"
    assert set_by(tmp_path, toml) == {"no-motion.alarm_s": 25.0, "battery.low": 0.2}


def test_message_is_the_same_after_encoding() -> None:
    reported = OperatorAction(Header(STATION_ID, 1, 1, 0), "a", STATION_ID, SetThresholds(LATER))
    assert decode(OPERATOR, encode(reported)) == reported


def test_new_thresholds_apply_from_their_time(script: Script) -> None:
    script.act(SetThresholds(LATER))
    motionless(script, 39.0)
    assert standing(script) == []
    motionless(script, 59.0)
    assert standing(script) == [("no-motion", "pre-alert")]
    motionless(script, 60.0)
    assert standing(script) == [("no-motion", "alarm")]


def test_open_alarms_are_judged_again_at_once(script: Script) -> None:
    script.act(SetThresholds(LATER))
    motionless(script, 35.0)
    assert standing(script) == []
    script.act(SetThresholds({}))
    assert standing(script) == [("no-motion", "alarm")]


def test_other_rules_and_thresholds_are_unchanged(script: Script) -> None:
    script.act(SetThresholds({"no-motion.alarm_s": 60.0}))
    motionless(script, 21.0)
    assert standing(script) == [("no-motion", "pre-alert")]
    script.status(UNIT, battery=0.09)
    assert ("battery", "low") in standing(script)


def test_restarted_station_applies_them(script: Script) -> None:
    script.act(SetThresholds(LATER))
    saved = read_checkpoint(script.pipeline.checkpoint())
    script.pipeline = StationPipeline(ALARMS, FUSERS[0], saved)
    motionless(script, 39.0)
    assert standing(script) == []


@pytest.mark.parametrize(
    "thresholds",
    [
        {"no-motion.since_s": 3.0, "wet-feet.alarm_s": 5.0},
        {"no-motion.pre_alert_s": 100.0},
        {"no-motion.name": 3.0},
        {"no-motion.pre_alert_s": math.nan},
        {"no-motion.alarm_s": math.inf},
        {"no-motion.pre_alert_s": 1.0},
    ],
)
def test_log_of_another_version_leaves_a_rule_unchanged(thresholds: dict[str, float]) -> None:
    assert with_thresholds((NoMotion(),), thresholds) == (NoMotion(),)
