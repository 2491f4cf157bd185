"""The example settings load, and name every setting."""

from __future__ import annotations

import dataclasses
import re
import tomllib
from pathlib import Path

import pytest

from base_station.config import ArchiveConfig, RetentionConfig, StationConfig
from base_station.core.alarms import ALARMS
from base_station.core.alarms.thresholds import limits_of
from base_station.department.config import DepartmentServerConfig
from base_station.forwarders.department.config import DepartmentConfig
from base_station.forwarders.tak.config import TakConfig
from base_station.radio.config import RadioConfig
from edge.config import EdgeConfig
from shared.config import load_config
from tests.conftest import PROJECT_ROOT

EXAMPLES = PROJECT_ROOT / "deploy" / "examples"
# Explained in a comment rather than set, or for the command line alone.
LEFT_OUT = {
    "archive",  # the last test
    "calibration",
    "database_password_file",
    "department",  # the last test
    "dispatch.types",
    "dispatch.units",
    "enrolment",
    "gain_std",
    "gyro_bias_std_radps",
    "http.certificate",
    "http.private_key",
    "place",
    "sensors",
    "speed",
    "radio",  # the last test
    "retention",  # the last test
    "tak",  # the last test
    "wearer.height_m",
    "wearer.leg_length_m",
    "wearer.person",
}
_COMMENTED = re.compile(r"^# (\[[\w.-]+\]|\w+ = .*)$", re.MULTILINE)


def keys_of(config_class: type, prefix: str = "") -> set[str]:
    keys = set()
    for each in dataclasses.fields(config_class):
        default = each.default_factory() if callable(each.default_factory) else None
        if dataclasses.is_dataclass(default):
            keys |= keys_of(type(default), f"{prefix}{each.name}.")
        else:
            keys.add(f"{prefix}{each.name}")
    return keys


def keys_in(table: dict[str, object], prefix: str = "") -> set[str]:
    keys: set[str] = set()
    for name, value in table.items():
        if isinstance(value, dict):
            keys |= keys_in(value, f"{prefix}{name}.")
        else:
            keys.add(f"{prefix}{name}")
    return keys


@pytest.mark.parametrize(
    ("path", "config_class"),
    [
        (EXAMPLES / "station.toml", StationConfig),
        (EXAMPLES / "unit.toml", EdgeConfig),
        (EXAMPLES / "department.toml", DepartmentServerConfig),
    ],
    ids=["station", "unit", "department"],
)
def test_an_example_loads_and_names_every_setting(path: Path, config_class: type):
    load_config(path, config_class)
    settings = tomllib.loads(path.read_text())
    if "alarms" in settings:
        settings["alarms"] = ...  # the test below
    assert keys_in(settings) == keys_of(config_class) - LEFT_OUT


def test_the_example_names_every_threshold_with_its_default():
    alarms = load_config(EXAMPLES / "station.toml", StationConfig).alarms
    assert alarms == {
        rule.name: {name: getattr(rule, name) for name in limits}
        for rule in ALARMS
        if (limits := limits_of(rule))
    }


def test_examples_of_connections_name_every_setting_with_its_default(tmp_path: Path):
    """They are comments: the other end of a connection is on another machine."""
    text = (EXAMPLES / "station.toml").read_text()
    file = tmp_path / "connections.toml"
    file.write_text("\n".join(_COMMENTED.findall(text[text.index("# [tak.") :])))
    settings, named = load_config(file, StationConfig), tomllib.loads(file.read_text())
    assert_names_defaults(settings.tak["county"], TakConfig, named["tak"]["county"])
    assert_names_defaults(settings.radio["Tac-1"], RadioConfig, named["radio"]["Tac-1"])
    assert_names_defaults(settings.archive, ArchiveConfig, named["archive"])
    assert_names_defaults(settings.retention, RetentionConfig, named["retention"])
    assert_names_defaults(settings.department, DepartmentConfig, named["department"])


def assert_names_defaults(loaded: object, config_class: type, named: dict[str, object]) -> None:
    assert named.keys() == {each.name for each in dataclasses.fields(config_class)}
    for each in dataclasses.fields(config_class):
        if each.default not in (None, "", dataclasses.MISSING):
            assert getattr(loaded, each.name) == each.default
