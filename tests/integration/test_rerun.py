"""``muster base rerun`` on a log alone, with separate black boxes."""

from __future__ import annotations

import shutil
from contextlib import closing
from pathlib import Path

import msgspec
import pytest
from typer.testing import CliRunner, Result

from base_station.app.folder_commands import rebuild
from base_station.cli import app
from base_station.replay.rerun.comparison import RerunReport
from shared.errors import RecordingError, UserError
from shared.mcap_log import SegmentPolicy, SegmentWriter, read_log, segment_paths
from shared.messages.station import SetAnchor
from tests.rig.retracked_incident import write_incident

SCENARIOS = {"FF-01": "search-ground-floor?seed=1", "FF-02": "search-ground-floor?seed=2"}
DURATION_S = 60.0


class RerunFolders:
    def __init__(self, folder: Path) -> None:
        self.station = write_incident(folder, SCENARIOS, DURATION_S)
        self.units = folder / "units"

    def boot(self, unit_id: str) -> Path:
        (boot,) = (self.units / unit_id / "black_box").iterdir()
        return boot

    def rerun(self, out: Path, *options: str) -> RerunReport:
        result = rerun(self.station, "--recording", str(self.units), "--out", str(out), *options)
        assert result.exit_code == 0, (result.output, result.exception)
        return msgspec.json.decode((out / "report.json").read_bytes(), type=RerunReport)


def rerun(data: Path, *options: str) -> Result:
    return CliRunner().invoke(app, ["rerun", "i1", "--data", str(data), *options])


@pytest.fixture(scope="module")
def given(tmp_path_factory: pytest.TempPathFactory) -> RerunFolders:
    return RerunFolders(tmp_path_factory.mktemp("given"))


@pytest.fixture(scope="module")
def same(given: RerunFolders, tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, RerunReport]:
    out = tmp_path_factory.mktemp("same") / "out"
    return out, given.rerun(out)


def test_the_same_settings_give_the_same_trails_and_alarms(
    same: tuple[Path, RerunReport],
) -> None:
    _, report = same
    assert [(one.unit_id, one.tracker) for one in report.trails] == [
        (unit_id, "eskf") for unit_id in SCENARIOS
    ]
    for one in report.trails:
        assert one.retracked == one.positions > 200
        assert one.seconds > 40
        assert (one.max_m, one.vertical_p95_m, one.other_floor_s) == (0.0, 0.0, 0)
    assert not [one for one in report.alarms if one.outcome != "same"]
    assert report.notes == ()


def test_other_tracker_gives_another_trail(given: RerunFolders, tmp_path: Path) -> None:
    report = given.rerun(tmp_path / "out", "--tracker", "huang")
    first = report.trails[0]
    assert (report.tracker, first.tracker) == ("huang", "huang")
    assert first.median_m is not None
    assert 0.0 < first.median_m < 30.0
    assert any("first metres" in note for note in report.notes)
    page = (tmp_path / "out" / "report.html").read_text(encoding="utf-8")
    assert page.count("stroke-dasharray") >= 2
    assert "Person 0 (FF-01)" in page


def test_kept_trails_are_brought_into_the_incident_once(
    given: RerunFolders, tmp_path: Path
) -> None:
    anchored = write_incident(
        tmp_path, {"FF-01": SCENARIOS["FF-01"]}, 30.0, anchor=SetAnchor(52.0, 4.0, 0.0, 0.0)
    )
    rebuild(anchored, lambda _: None)
    options = ("--recording", str(tmp_path / "units"), "--out", str(tmp_path / "out"), "--keep")
    for _ in range(2):
        result = rerun(anchored, *options, "--tracker", "huang")
        assert result.exit_code == 0, (result.output, result.exception)
    listed = CliRunner().invoke(app, ["import", "i1", "--data", str(anchored)]).output
    (line,) = listed.splitlines()
    assert "\trerun-huang.gpx\tgpx\t1 tracks\t" in line
    assert "by muster base rerun" in line
    rebuild(given.station, lambda _: None)
    with pytest.raises(UserError, match="place on the Earth"):
        raise rerun(given.station, *options).exception or AssertionError


def test_interrupted_rerun_continues_from_finished_parts(
    given: RerunFolders, same: tuple[Path, RerunReport]
) -> None:
    out, report = same
    logs = {path: path.stat().st_mtime_ns for path in (out / "retracked").rglob("*.mcap")}
    shutil.rmtree(next(iter(logs)).parent)
    assert given.rerun(out) == report
    again = {path: path.stat().st_mtime_ns for path in (out / "retracked").rglob("*.mcap")}
    assert again.keys() == logs.keys()
    assert sum(again[path] == logs[path] for path in logs) == len(logs) - 1


def test_late_recording_continues_the_recorded_path(given: RerunFolders, tmp_path: Path) -> None:
    """Pulled recordings often lack the start of the boot."""
    late = tmp_path / "FF-01" / "boot"
    shutil.copytree(given.boot("FF-01"), late)
    (only,) = segment_paths(late)
    _begin_at(only, 0.4)
    result = rerun(
        given.station, "--recording", str(tmp_path / "FF-01"), "--out", str(tmp_path / "out")
    )
    assert result.exit_code == 0, (result.output, result.exception)
    report = msgspec.json.decode((tmp_path / "out" / "report.json").read_bytes(), type=RerunReport)
    trails = {one.unit_id: one for one in report.trails}
    assert 0 < trails["FF-01"].retracked < trails["FF-01"].positions
    assert trails["FF-01"].max_m is not None
    assert 0.0 < trails["FF-01"].max_m < 3.0
    assert trails["FF-02"].max_m == 0.0
    assert any(note.startswith("FF-02 has no raw recording") for note in report.notes)


def test_unknown_tracker_leaves_no_result(given: RerunFolders, tmp_path: Path) -> None:
    recording = ("--recording", str(given.boot("FF-01")), "--out", str(tmp_path / "out"))
    with pytest.raises(UserError, match="no tracker 'eskv'"):
        raise rerun(given.station, *recording, "--tracker", "eskv").exception or AssertionError
    assert not list((tmp_path / "out").glob("report*"))


def test_a_recording_of_another_incident_is_refused(given: RerunFolders, tmp_path: Path) -> None:
    other = write_incident(tmp_path / "other", {"FF-09": "straight?seed=3"}, 12.0)
    recording = ("--recording", str(tmp_path / "other" / "units"))
    with pytest.raises(UserError, match=r"FF-09.*does not belong"):
        raise rerun(given.station, *recording).exception or AssertionError
    with pytest.raises(UserError, match="there is no raw recording of i1: pull one"):
        raise rerun(given.station).exception or AssertionError
    with pytest.raises(RecordingError, match="no raw recording"):
        raise rerun(given.station, "--recording", str(other)).exception or AssertionError
    with pytest.raises(UserError, match="known are: i1"):
        CliRunner().invoke(
            app, ["rerun", "i9", "--data", str(given.station)], catch_exceptions=False
        )


def _begin_at(segment: Path, part: float) -> None:
    """Leave out the first part of a segment's records, but keep the description."""
    folder = segment.parent
    records = list(read_log(folder))
    segment.unlink()
    kept = [records[0], *records[round(part * len(records)) :]]
    first_ns = kept[1][0]
    with closing(SegmentWriter(folder, SegmentPolicy(segment_s=1e6))) as writer:
        for t_ns, key, payload in kept:
            writer.write(max(t_ns, first_ns), key, payload)
