"""Wrong input on the command line is answered with one sentence and exit code 2."""

from __future__ import annotations

import subprocess
import sys
from datetime import UTC, datetime
from pathlib import Path
from threading import Event

import pytest

from edge.app.run import run_agent
from edge.calibration.file import write_calibration
from edge.calibration.model import Calibration
from edge.config import EdgeConfig
from shared.config import load_config
from shared.errors import ConfigError, MusterError

MAIN = """
import sys
from shared.errors import MusterError
from edge.cli import app
try:
    app(prog_name="muster edge")
except MusterError as error:
    print(f"muster: {error}", file=sys.stderr)
    sys.exit(2)
"""
WALK = "simulated:straight"


def muster_edge(*arguments: str, cwd: Path) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [sys.executable, "-c", MAIN, *arguments],
        capture_output=True,
        text=True,
        cwd=cwd,
        timeout=60,
        check=False,
    )


@pytest.mark.parametrize(
    ("flags", "reported"),
    [
        ({}, "the unit has no name"),
        ({"unit": "all"}, "unit id 'all' cannot be used"),
        ({"unit": "a/b"}, "unit id 'a/b' cannot be used"),
        ({"unit": "u1", "source": "recording:nothing/here"}, "nothing/here"),
        ({"unit": "u1", "source": "simulatd:x"}, "did you mean simulated:"),
        ({"unit": "u1", "connect": ["tcp/host"]}, "tcp/HOST:PORT"),
        ({"unit": "u1", "connect": ["tcp/host:70000"]}, "tcp/HOST:PORT"),
        ({"unit": "u1", "connect": ["tcp/no..name:7447"]}, "tcp/HOST:PORT"),
        ({"unit": "u1", "source": "ximu3:tcp://no..name"}, "names no server"),
        ({"unit": "u1", "connect": ["tls/host:7447"]}, "needs the unit's enrolment"),
        ({"unit": "u1", "tracker": "esfk"}, "eskf"),
        ({"unit": "u1", "tracker": ""}, "eskf, huang, waist, hip, hip-corridors, body"),
        ({"unit": "u1", "data": Path("/dev/null")}, "/dev/null"),
        ({"unit": "u1", "calibration": Path("nothing.toml")}, "there is no calibration file"),
        ({"enrolment": Path("nothing.toml")}, "there is no such enrolment file"),
    ],
)
def test_settings_that_cannot_work_are_one_sentence(flags, reported, tmp_path):
    config = load_config(None, EdgeConfig, {"source": WALK, "data": tmp_path, **flags})
    with pytest.raises(MusterError) as caught:
        run_agent(config, Event(), for_s=0.0, paced=True)
    assert reported in str(caught.value)
    assert "\n" not in str(caught.value)


@pytest.mark.slow
def test_the_sentence_goes_to_stderr_with_exit_code_2(tmp_path):
    ended = muster_edge("run", "--config", "nothing.toml", cwd=tmp_path)
    assert ended.returncode == 2
    assert ended.stderr.strip().splitlines() == ["muster: nothing.toml: there is no such file"]


@pytest.mark.slow
def test_lists_sources_and_trackers(tmp_path):
    listed = muster_edge("sources", cwd=tmp_path).stdout
    assert "mcap:PATH" in listed
    assert "--button evdev:NAME" in listed
    assert "eskf" in muster_edge("trackers", cwd=tmp_path).stdout


def test_a_file_gives_settings_and_flags_overrule_it(tmp_path):
    file = tmp_path / "unit.toml"
    file.write_text(
        'unit = "u1"\nsource = "simulated:straight"\ndata = "kept"\n[storage]\njournal_mb = 20\n'
    )
    config = load_config(file, EdgeConfig, {"unit": "u2", "tracker": None})
    assert (config.unit, config.tracker) == ("u2", "by-place")
    assert config.data == tmp_path / "kept"
    assert config.storage.journal_mb == 20.0


@pytest.mark.parametrize(
    ("line", "reported"),
    [
        ('conect = ["tcp/a:1"]', "connect"),
        ("position_rate_mhz = 5000", "position_rate_hz"),
        ("position_rate_hz = 500", "position_rate_hz"),
        ("[storage]\njournal_gb = 1", "journal_mb"),
    ],
)
def test_a_wrong_key_is_named_with_the_right_one(line, reported, tmp_path):
    file = tmp_path / "unit.toml"
    file.write_text(f'unit = "u1"\nsource = "x"\n{line}\n')
    with pytest.raises(ConfigError, match=reported):
        load_config(file, EdgeConfig)


@pytest.mark.parametrize("name", ["gain_std", "gyro_bias_std_radps"])
@pytest.mark.parametrize("value", ["-0.001", "0.21", "nan", "inf", "'good'", "true"])
def test_deviations_that_cannot_be_are_one_sentence(name, value, tmp_path):
    file = tmp_path / "unit.toml"
    file.write_text(f'source = "x"\n{name} = {value}\n')
    with pytest.raises(ConfigError) as caught:
        load_config(file, EdgeConfig)
    assert name in str(caught.value)
    assert "\n" not in str(caught.value)


def test_settings_that_cannot_work_leave_nothing_behind(tmp_path):
    config = EdgeConfig(unit="u1", source="simulated:nowhere", data=tmp_path / "data")
    with pytest.raises(ConfigError):
        run_agent(config, Event(), for_s=0.0, paced=True)
    assert not (tmp_path / "data").exists()


@pytest.mark.parametrize(
    ("unit", "sensor", "reported"),
    [("u2", "", "is for unit 'u2', and this is 'u1'"), ("", "other", "is for sensor 'other'")],
)
def test_the_calibration_of_another_unit_is_refused(unit, sensor, reported, tmp_path):
    path = tmp_path / "c.toml"
    write_calibration(Calibration(unit, sensor, datetime(2026, 1, 1, tzinfo=UTC)), path)
    flags = {"unit": "u1", "calibration": path, "source": WALK, "data": tmp_path / "data"}
    with pytest.raises(ConfigError, match=reported):
        run_agent(load_config(None, EdgeConfig, flags), Event(), for_s=0.0, paced=True)


@pytest.mark.slow
def test_calibrating_without_a_source_says_what_to_give(tmp_path):
    result = muster_edge("calibrate", "--out", "c.toml", cwd=tmp_path)
    assert result.returncode == 2
    assert "--still, --poses, --turning, --warm-up" in result.stderr
    assert "Traceback" not in result.stderr


@pytest.mark.slow
@pytest.mark.parametrize(
    ("arguments", "reported"),
    [
        (("calibrate", "--source", "bench:1", "--out", "c.toml", "--speed", "0"), "--speed"),
        (("calibrate", "--source", "bench:1", "--out", "c.toml", "--speed", "nan"), "--speed"),
        (("calibrate", "--still", "bench:1", "--out", "c.toml", "--unit", "a/b"), "unit id 'a/b'"),
        (("calibrate", "--still", "bench:1", "--out", "c.toml", "--sensor", "a\x7f"), "'a\\x7f'"),
        (("calibrate", "--still", "bench:1", "--out", "c.toml", "--with-warm-up"), "--warm-up"),
        (("calibrate", "--source", "bus:u1", "--out", "c.toml", "--unit", "u2"), "not of u2"),
        (("calibrate", "--source", "bus:", "--out", "c.toml"), "unit id ''"),
        (("run", "--source", WALK, "--unit", "u1", "--for", "inf"), "--for"),
    ],
)
def test_numbers_and_names_that_cannot_be_are_refused_before_anything_is_done(
    arguments, reported, tmp_path
):
    result = muster_edge(*arguments, cwd=tmp_path)
    assert result.returncode == 2
    assert reported in result.stderr
    assert "Traceback" not in result.stderr
    assert list(tmp_path.iterdir()) == []
