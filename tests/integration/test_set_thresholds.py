"""A department's own thresholds, in the settings of a running station."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from tests.rig import message_factory
from tests.rig.served_station import MakePosition, greet, prepare, snapshot
from tests.rig.station_command import Browser, Command, Unit
from tests.rig.waiting import until


def set_in(browser: Browser) -> list[dict[str, Any]]:
    """Audit entries of thresholds, oldest first."""
    entries = browser.call("GET", "/audit")
    reported = [json.loads(one["detail"]) for one in entries if one["action"] == "SetThresholds"]
    return reported[::-1]


def fusers_set_in(browser: Browser) -> list[str]:
    """Names of fusers in the audit, oldest first."""
    entries = browser.call("GET", "/audit")
    set_ = [json.loads(one["detail"])["name"] for one in entries if one["action"] == "SetFuser"]
    return set_[::-1]


def test_changed_thresholds_apply_and_are_audited_once(
    serve: Callable[..., Command],
    tmp_path: Path,
    data: Path,
    unit: Unit,
    make_position: MakePosition,
) -> None:
    settings = tmp_path / "station.toml"
    settings.write_text('[positioning]\nfuser = "gps-switching"\n[alarms.battery]\nlow = 0.6\n')
    ours: dict[str, Any] = {"thresholds": {"battery.low": 0.6}}
    station = serve("--config", str(settings))
    with Browser(station.wait_ready(), data) as browser:
        until(lambda: set_in(browser) == [ours], "the thresholds are in the audit")
        until(lambda: fusers_set_in(browser) == ["gps-switching"], "so is the fuser")
        prepare(browser)
        greet(browser, unit, make_position)
        unit.say(message_factory.status(unit.header_factory.header(), battery=0.5))
        until(lambda: snapshot(browser)["alarms"], "the battery is low")
        (alarm,) = snapshot(browser)["alarms"]
        assert (alarm["rule"], alarm["level"]) == ("battery", "low")
    assert station.stop() == 0

    again = serve("--config", str(settings))
    with Browser(again.wait_ready(), data) as browser:
        assert set_in(browser) == [ours]
        assert fusers_set_in(browser) == ["gps-switching"]
    assert again.stop() == 0

    settings.write_text("")
    default = serve("--config", str(settings))
    with Browser(default.wait_ready(), data) as browser:
        until(lambda: set_in(browser) == [ours, {"thresholds": {}}], "the usual ones hold again")
        both = ["gps-switching", "gps-inertial"]
        until(lambda: fusers_set_in(browser) == both, "and the usual fuser")
    assert default.stop() == 0


@pytest.mark.parametrize(
    ("toml", "problem"),
    [
        (
            "[alarms.no-motion]\nalarm_s = 0.5\n",
            "alarms.no-motion.alarm_s: Expected `float` >= 5.0",
        ),
        (
            '[positioning]\nfuser = "gps-inertia"\n',
            "positioning.fuser: there is no 'gps-inertia'; did you mean gps-inertial?",
        ),
    ],
)
def test_invalid_setting_is_refused_at_the_start(
    serve: Callable[..., Command], tmp_path: Path, data: Path, toml: str, problem: str
) -> None:
    settings = tmp_path / "station.toml"
    settings.write_text(toml)
    refused = serve("--config", str(settings))
    assert refused.wait() == 2
    assert problem in refused.output()
    assert "Traceback" not in refused.output()
    assert not data.exists()
