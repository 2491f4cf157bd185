"""An incident as one self-contained file: read by the plain reader of its format, and here."""

from __future__ import annotations

import csv
import shutil
from collections import Counter
from collections.abc import Iterator
from contextlib import closing
from pathlib import Path

import msgspec
import pytest
from mcap.reader import make_reader
from typer.testing import CliRunner, Result

from base_station.app.factories import project_whole_log
from base_station.cli import app
from base_station.core.person_references import reference_to
from base_station.replay.incident_file import read_incident_file
from base_station.storage.db.records import Records
from base_station.storage.db.roster import Roster
from base_station.storage.db.store import Store
from shared.channels import OPERATOR
from shared.clock import SystemClock
from shared.codec import decode
from shared.errors import UserError
from shared.mcap_log import SegmentWriter, byte_ranges_of
from shared.messages import STATION_ID, OperatorAction
from shared.messages.pins import SetPin
from shared.messages.station import (
    Action,
    Assign,
    CloseIncident,
    OpenIncident,
    SetAnchor,
    SetPlan,
    SetStart,
    SetThresholds,
    Unassign,
)
from tests.rig.archived_station import PEOPLE
from tests.rig.round_walk import PLAN, Walk


@pytest.fixture(scope="module")
def data(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A station's folder with an incident before the one that is asked for, and one behind it."""
    walk = Walk("FF-01", "FF-02", turn_rad=0.5)  # it begins with incident i1
    script = walk.script
    for action in (
        SetPlan(b"{}"), SetPlan(PLAN), SetAnchor(52.0, 13.0, 40.0, 0.0),
        SetThresholds({"no-motion.alarm_s": 25.0}),
        Assign("FF-01", "ada0"), Assign("FF-02", "cy00"),
    ):  # fmt: skip
        script.act(action)
    walk.start("FF-01")
    walk.go(30)
    script.act(CloseIncident("i1"))
    script.act(Unassign("FF-02"))
    script.wait(1000.0)
    script.act(OpenIncident("i2", f"Mill {reference_to('bo00')}"))
    script.act(Assign("FF-02", "bo00"))
    for unit_id in walk.units:
        walk.start(unit_id)
    walk.go(60)
    script.act(CloseIncident("i2"))
    closed_ns = script.t_ns
    script.wait(100.0)
    script.act(SetPin("p1", "FF-01", closed_ns - 10**10, 1.0, 2.0, 0.5, None, None, 0.0, ""))
    script.act(OpenIncident("i3", "later"))
    script.wait(5.0)
    folder = tmp_path_factory.mktemp("station")
    with closing(SegmentWriter(folder / "log")) as log:
        for record in script.records:
            log.write(*record)
    with Store(folder / "station.sqlite") as store:
        project_whole_log(store, folder / "log", lambda _: None)
        Roster(store, SystemClock()).add_unknown_people(PEOPLE)
    return folder


@pytest.fixture(scope="module")
def alone(data: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    file = tmp_path_factory.mktemp("given") / "mill.mcap"
    result = muster("export", "i2", str(file), "--data", str(data))
    assert result.exit_code == 0, result.output
    return file


def muster(*arguments: str) -> Result:
    return CliRunner().invoke(app, arguments)


def rows_of(table: Path) -> list[dict[str, str]]:
    with table.open(newline="") as file:
        return list(csv.DictReader(file))


def actions_in(file: Path) -> Iterator[type[Action]]:
    with file.open("rb") as stream:
        for _, _, message in make_reader(stream).iter_messages([OPERATOR.key(STATION_ID)]):
            done = decode(OPERATOR, message.data)
            assert isinstance(done, OperatorAction)
            yield type(done.action)


def test_standard_reader_finds_all_records(alone: Path) -> None:
    with alone.open("rb") as stream:
        reader = make_reader(stream, validate_crcs=True)
        summary = reader.get_summary()
        assert summary is not None
        assert summary.statistics is not None
        assert summary.statistics.attachment_count == 2
        attached = {one.name: one.data for one in reader.iter_attachments()}
        about = {one.name: one.metadata for one in reader.iter_metadata()}["muster.incident"]
        times = [message.log_time for _, _, message in reader.iter_messages()]
    assert times == sorted(times)
    assert len(times) == summary.statistics.message_count
    assert attached["plan.geojson"] == PLAN
    people = msgspec.json.decode(attached["people.json"])
    assert {one["name"] for one in people.values()} == {"Ada", "Bo"}, "whoever was not there"
    assert (about["incident_id"], about["name"], about["damage"]) == ("i2", "Mill Bo", "")
    assert about["closed"] > about["opened"] > "2023"


def test_file_contains_the_initial_state_once_and_no_other_incident(
    alone: Path,
) -> None:
    counts = Counter(actions_in(alone))
    for once in (SetPlan, SetThresholds, OpenIncident, CloseIncident, Unassign):
        assert counts[once] == 1, once
    assert counts[SetPin] == 1, "of the debriefing"
    assert counts[SetStart] == 3, "and where FF-01 began before"
    assert counts[Assign] == 2


def test_file_is_read_by_the_station(data: Path, alone: Path, tmp_path: Path) -> None:
    found = read_incident_file(alone)
    assert found is not None
    assert (found.incident_id, found.people["bo00"]) == ("i2", PEOPLE["bo00"])
    there, here = tmp_path / "there.csv", tmp_path / "here.csv"
    assert muster("export", "i2", str(there), "--data", str(data)).exit_code == 0
    result = muster("export", str(alone), str(here))
    assert result.exit_code == 0, result.output
    for read, was in zip(rows_of(here), rows_of(there), strict=True):
        for column in ("unit_id", "person", "crew", "t_utc_s", "floor"):
            assert read[column] == was[column]
        for column in ("north_m", "east_m", "height_m"):  # decided again, of fewer minutes before
            assert float(read[column]) == pytest.approx(float(was[column]), abs=1.0)
    again = tmp_path / "again.mcap"
    assert muster("export", str(alone), str(again)).exit_code == 0
    assert again.read_bytes() == alone.read_bytes()


def test_invalid_source_or_target_is_reported(data: Path, alone: Path, tmp_path: Path) -> None:
    torn, out = tmp_path / "torn.mcap", tmp_path / "out.mcap"
    torn.write_bytes(alone.read_bytes()[:-200])
    foreign = next((data / "log").glob("*.mcap"))
    for arguments, words in (
        ((str(torn), str(out)), "is not complete"),
        ((str(foreign), str(out)), "is no incident that stands alone"),
        (("i2", str(out), "--data", str(data), "--kind", "raw"), "leave out --kind"),
        (("i2", "/dev/full", "--format", "mcap", "--data", str(data)), "No space left"),
    ):
        result = muster("export", *arguments)
        assert isinstance(result.exception, UserError), result.output
        assert words in str(result.exception)
        assert not out.exists()


def test_a_damaged_log_is_exported_as_far_as_it_is_readable_and_names_the_damage(
    data: Path, tmp_path: Path
) -> None:
    copy, out = tmp_path / "copy", tmp_path / "out.mcap"
    shutil.copytree(data, copy)
    segment = max((copy / "log").glob("*.mcap"))
    with Store(copy / "station.sqlite") as store:
        opened_ns = Records(store, SystemClock()).require_incident("i2").opened_ns
    (chunk, *_) = (one for one in byte_ranges_of(segment).chunks if one.from_ns > opened_ns)
    content = bytearray(segment.read_bytes())
    content[(chunk.offset + chunk.end) // 2] ^= 0xFF
    segment.write_bytes(content)
    result = muster("export", "i2", str(out), "--data", str(copy))
    assert result.exit_code == 0, result.output
    with out.open("rb") as stream:
        about = {one.name: one.metadata for one in make_reader(stream).iter_metadata()}
    assert segment.name in about["muster.incident"]["damage"]
    assert segment.name in result.output
