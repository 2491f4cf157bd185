"""Re-runs and rehearsals of incidents whose log is in an archive alone."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import msgspec

from base_station.app.factories import project_whole_log
from base_station.replay.rehearsal.report import RehearsalReport
from base_station.storage.db.store import Store
from shared.errors import LogError
from shared.mcap_log import segment_paths
from shared.messages.station import Assign, CloseIncident, OpenIncident
from tests.rig.archived_station import muster, refusal, succeeded
from tests.rig.bucket_server import ADDRESS, BucketServer
from tests.rig.noted_segments import note_segments
from tests.rig.reported_incident import write_log
from tests.rig.retracked_incident import write_incident
from tests.rig.station_script import Script

THRESHOLDS = ("--set", "no-motion.alarm_s=20", "--set", "no-motion.pre_alert_s=10")


def watched_incidents(*incident_ids: str) -> Script:
    """One person, who rests in each."""
    script = Script()
    script.register("FF-01")
    script.act(Assign("FF-01", "p1", "Anna Vos", "red", ""))
    for incident_id in incident_ids:
        script.act(OpenIncident(incident_id, incident_id))
        for second in range(90):
            script.now_s += 1.0
            rests = 40 <= second < 75  # not from one incident into the next: a copy has one
            script.status("FF-01", motionless_s=second - 40.0 if rests else 0.0)
            script.position("FF-01", 1.0 * second, 0.0)
            script.tick()
        script.act(CloseIncident(incident_id))
        script.wait(60.0)
    return script


def note_tables(data: Path) -> None:
    with Store(data / "station.sqlite") as store:
        project_whole_log(store, data / "log", lambda _: None)
        note_segments(store, data / "log")


def remove_log(data: Path, kept: int = 0) -> None:
    """Remove all segments but the last ``kept``, as a person who makes room."""
    segments = segment_paths(data / "log")
    for segment in segments[: len(segments) - kept]:
        segment.unlink()


def test_rerun_of_an_archived_incident_equals_the_one_with_its_log(tmp_path: Path) -> None:
    data = write_incident(tmp_path, {"FF-01": "search-ground-floor?seed=1"}, 30.0)
    note_tables(data)
    archive = tmp_path / "archive"
    succeeded("archive", "copy", archive, "--data", data)
    options = ("--data", data, "--recording", tmp_path / "units", "--tracker", "huang")
    succeeded("rerun", "i1", *options, "--out", tmp_path / "with-log")
    remove_log(data)
    printed = succeeded("rerun", "i1", *options, "--out", tmp_path / "without-log")
    assert f"the log of i1 is not here any more: it is read in {archive}" in printed
    reports = [tmp_path / one / "report.json" for one in ("with-log", "without-log")]
    assert reports[1].read_bytes() == reports[0].read_bytes()
    assert "known are: i1" in refusal("rerun", "i9", *options)

    archive.rename(tmp_path / "moved")
    assert f"{archive} has no complete copy of it" in refusal("rerun", "i1", *options)


def test_rehearsal_reads_each_incident_where_it_is(
    server: BucketServer, ask_as: Callable[[str], None], tmp_path: Path
) -> None:
    data = tmp_path / "station"
    write_log(data, watched_incidents("i1", "i2").records, segment_s=50.0)
    note_tables(data)
    succeeded("archive", "copy", f"{ADDRESS}-rehearsed", "--data", data)
    with_log = rehearsal(data, tmp_path)
    assert [one.incident_id for one in with_log.incidents] == ["i1", "i2"]
    assert all(one.worn_h > 0.01 for one in with_log.incidents)
    assert {one.incident_id for one in with_log.points[0].changes} == {"i1", "i2"}
    for kept in (2, 0):
        remove_log(data, kept)
        assert rehearsal(data, tmp_path) == with_log
        named = rehearsal(data, tmp_path, "--incident", "i2", "--incident", "i1")
        assert named == with_log
    server.stop()
    try:
        assert "nothing is lost" in refusal("rehearse", *THRESHOLDS, "--data", data)
    finally:
        server.start()


def test_command_without_log_and_copy_reports_what_to_do(data: Path) -> None:
    remove_log(data)
    for arguments in (("report", "i1"), ("rehearse", *THRESHOLDS)):
        failed = muster(*arguments, "--data", data).exception
        assert isinstance(failed, LogError)
        assert "muster base archive fetch ARCHIVE INCIDENT" in str(failed)


def rehearsal(data: Path, folder: Path, *options: str) -> RehearsalReport:
    out = folder / "rehearsal.json"
    succeeded("rehearse", *THRESHOLDS, *options, "--data", data, "--json", out)
    return msgspec.json.decode(out.read_bytes(), type=RehearsalReport)
