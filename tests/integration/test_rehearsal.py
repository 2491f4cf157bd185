"""``muster base rehearse`` on a log alone, against the alarms of a station with those
thresholds.
"""

from __future__ import annotations

from pathlib import Path

import msgspec
import pytest
from typer.testing import CliRunner, Result

from base_station.cli import app
from base_station.replay.rehearsal.report import RehearsalReport
from shared.clock import NS_PER_MS
from shared.errors import UserError
from tests.rig.reported_incident import write_log
from tests.rig.resting_person import DURATION_S, resting_person


@pytest.fixture(scope="module")
def given(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("given")
    write_log(folder, resting_person(30.0).records)
    return folder


def rehearse(data: Path, *options: str) -> Result:
    return CliRunner().invoke(app, ["rehearse", "--data", str(data), *options])


def report(data: Path, out: Path, *options: str) -> RehearsalReport:
    result = rehearse(data, "--json", str(out), *options)
    assert result.exit_code == 0, result.output
    return msgspec.json.decode(out.read_bytes(), type=RehearsalReport)


def test_rehearsal_equals_a_station_with_those_thresholds(given: Path, tmp_path: Path) -> None:
    found = report(given, tmp_path / "out.json", "--set", "no_motion.alarm_s=20")
    levels = {one.level: one for one in found.points[0].levels}
    alarm = levels["alarm"]
    assert (alarm.recorded, alarm.rehearsed) == (1, 3)
    assert (alarm.earlier, alarm.added, alarm.missed, alarm.same) == (1, 2, 0, 0)
    assert alarm.median_shift_s == pytest.approx(-10.0)
    assert levels["pre-alert"].same == levels["pre-alert"].rehearsed == 3
    assert found.worn_h == pytest.approx(DURATION_S / 3600.0, rel=0.02)
    assert alarm.rehearsed_per_hour == pytest.approx(3 / found.worn_h)
    assert found.incidents[0].live_alarms == {"no-motion": 3}
    live = next(one for one in resting_person(20.0).alarms if one.level == "alarm")
    rehearsed_ms = [one.rehearsed_ms for one in found.points[0].changes if one.level == "alarm"]
    assert rehearsed_ms[0] == live.header.t_mono_ns // NS_PER_MS


def test_sweep_skips_contradictory_thresholds(given: Path, tmp_path: Path) -> None:
    out, picture = tmp_path / "out.json", tmp_path / "out.svg"
    found = report(given, out, "--sweep", "no_motion.alarm_s=5:70:5", "--picture", str(picture))
    possible = [one for one in found.points if not one.problem]
    assert [one.thresholds["no-motion.alarm_s"] for one in found.points if one.problem] == [5.0]
    counts = [point.levels[1].rehearsed for point in possible]
    assert counts == sorted(counts, reverse=True)
    assert (counts[0], counts[-1]) == (3, 0)
    assert possible[-1].levels[1].missed == 1
    assert picture.read_text(encoding="utf-8").startswith("<svg")
    assert not [one for one in tmp_path.iterdir() if one.name.startswith(".part")]


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (("--set", "no_motion.alarm_s=8"), "pre_alert_s comes before alarm_s"),
        (("--set", "heat.warning_degc=150", "--incident", "i9"), "known are: i1"),
        ((), "--set"),
        (("--set", "heat.warning_degc=150", "--picture", "x.svg"), "--sweep"),
        (("--set", "no-motion.alarm_s=25", "--sweep", "no-motion.alarm_s=20:30:5"), "both|and by"),
    ],
)
def test_invalid_rehearsal_is_refused(given: Path, options: tuple[str, ...], message: str) -> None:
    with pytest.raises(UserError, match=message):
        raise rehearse(given, *options).exception or AssertionError


def test_intact_part_of_a_damaged_log_is_rehearsed(tmp_path: Path) -> None:
    write_log(tmp_path, resting_person(30.0).records)
    last = sorted((tmp_path / "log").glob("*.mcap"))[-1]
    content = last.read_bytes()
    last.write_bytes(content[: len(content) // 2])
    out = tmp_path / "out.json"
    found = report(tmp_path, out, "--set", "no_motion.alarm_s=20", "--incident", "i1")
    assert found.points[0].levels[1].rehearsed == 3
