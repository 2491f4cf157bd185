"""An incident from another machine: a whole folder, its log alone, or parts."""

from __future__ import annotations

import shutil
from collections.abc import Callable, Iterator
from contextlib import ExitStack, closing, contextmanager
from pathlib import Path
from typing import Any

import httpx
import pytest
from mcap.writer import Writer
from typer.testing import CliRunner, Result

from base_station.accounts.principals import Role
from base_station.app import folder_commands as station_app
from base_station.app.offline_log import open_offline_log
from base_station.cli import app
from base_station.storage.data_folder import DataFolder
from base_station.storage.db.accounts import Accounts
from base_station.storage.db.records import Records
from base_station.storage.db.store import Store
from shared.clock import NS_PER_S, SystemClock
from shared.errors import LogError, UserError
from shared.mcap_log import (
    SegmentPolicy,
    SegmentReader,
    SegmentWriter,
    recover_log,
    segment_began_ns,
    segment_path,
    segment_paths,
)
from shared.messages.station import CloseIncident, OpenIncident
from tests.rig.logged_walk import logged, north
from tests.rig.plain_http import NO_AUTHORITIES
from tests.rig.round_walk import Walk
from tests.rig.station_command import Command, CommandByModes
from tests.rig.station_script import Record, Script
from tests.rig.waiting import PATIENCE_S, until

POLICY = SegmentPolicy(segment_s=60.0)


def walked() -> list[Record]:
    """Two units in an incident of five minutes."""
    walk = Walk("FF-01", "FF-02", turn_rad=0.5)
    for unit_id in walk.units:
        walk.start(unit_id)
    walk.go(300)
    walk.script.act(CloseIncident("i1"))
    walk.script.wait(1.0)
    return walk.script.records


def _log(folder: Path, records: list[Record], policy: SegmentPolicy | None = None) -> None:
    with closing(SegmentWriter(folder / "log", policy or SegmentPolicy())) as log:
        for record in records:
            log.write(*record)


@contextmanager
def client_of_replay(replaying: Command) -> Iterator[httpx.Client]:
    """Client of a replay station, logged in with the login that the station has printed."""
    address = replaying.wait_ready()
    (line,) = (one for one in replaying.output().splitlines() if "login" in one)
    _, username, password = (part.split()[0] for part in line.split(": "))
    with httpx.Client(
        base_url=f"{address}/api/v1",
        headers={"Origin": address},
        timeout=PATIENCE_S,
        verify=NO_AUTHORITIES,
    ) as client:
        login = {"username": username, "password": password}
        assert client.post("/login", json=login).is_success
        yield client


@pytest.fixture(scope="module")
def given(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The log alone, in several segments."""
    folder = tmp_path_factory.mktemp("given")
    _log(folder, walked(), POLICY)
    assert len(segment_paths(folder / "log")) > 3
    return folder


@pytest.fixture
def copy(given: Path, tmp_path: Path) -> Path:
    shutil.copytree(given, tmp_path / "copy")
    return tmp_path / "copy"


def run(command: str, incident_id: str, data: Path) -> Result:
    return CliRunner().invoke(app, [command, incident_id, "--data", str(data)])


def files_of(folder: Path) -> dict[str, int]:
    return {str(one.relative_to(folder)): one.stat().st_mtime_ns for one in folder.rglob("*")}


def test_log_without_a_database_is_assessed_and_its_folder_unchanged(copy: Path) -> None:
    before = files_of(copy)
    judged = run("assess", "i1", copy)
    assert judged.exit_code == 0, judged.output
    assert "ISO/IEC 18305" in judged.output
    assert "FF-02" in judged.output
    smoothed = run("smooth", "i1", copy)
    assert smoothed.exit_code == 0, smoothed.output
    assert "2 trails by path-graph; not kept: " in smoothed.output
    assert files_of(copy) == before


def test_unknown_incident_is_refused_with_the_known_ones(copy: Path) -> None:
    result = run("assess", "i9", copy)
    assert isinstance(result.exception, UserError)
    assert "i1 (" in str(result.exception)


def test_log_folder_alone_and_renamed_files_are_read(given: Path, tmp_path: Path) -> None:
    assert run("assess", "i1", given / "log").exit_code == 0
    renamed = tmp_path / "from the drive"
    renamed.mkdir()
    for name, path in zip("edcbafghijk", segment_paths(given / "log"), strict=False):
        shutil.copy(path, renamed / f"mill lane {name}.mcap")
    shutil.copytree(renamed, tmp_path / "tidy" / "log")
    assert run("assess", "i1", tmp_path / "tidy").exit_code == 0
    judged = run("assess", "i1", renamed)
    assert judged.exit_code == 0, judged.output
    assert judged.output == run("assess", "i1", given).output


def test_single_file_with_the_whole_incident_is_enough(tmp_path: Path) -> None:
    _log(tmp_path, walked())
    (path,) = segment_paths(tmp_path / "log")
    path = path.rename(tmp_path / "evidence 7.mcap")
    judged = run("assess", "i1", path)
    assert judged.exit_code == 0, judged.output
    assert "FF-02" in judged.output


def test_folder_without_a_log_is_refused(given: Path, tmp_path: Path) -> None:
    def refusal(data: Path) -> str:
        result = run("assess", "i1", data)
        assert isinstance(result.exception, LogError)
        return str(result.exception)

    nothing = tmp_path / "nothing.mcap"
    nothing.write_bytes(b"%PDF-1.7 no log at all" * 1000)
    assert "nothing in nothing.mcap can be read" in refusal(nothing)
    empty = tmp_path / "empty"
    empty.mkdir()
    assert "there is no station's log" in refusal(empty)
    (empty / "log").mkdir()
    assert "there is no station's log" in refusal(empty)
    assert "there is no station's log" in refusal(tmp_path / "away")
    twice = tmp_path / "twice"
    twice.mkdir()
    first = segment_paths(given / "log")[0]
    shutil.copy(first, twice / "a.mcap")
    shutil.copy(first, twice / "b.mcap")
    assert "a.mcap and b.mcap are of the same time" in refusal(twice)


@pytest.fixture
def reported() -> list[str]:
    return []


@pytest.fixture
def closing_at_end() -> Iterator[ExitStack]:
    with ExitStack() as stack:
        yield stack


def test_missing_and_damaged_segments_are_reported(
    copy: Path, reported: list[str], closing_at_end: ExitStack
) -> None:
    paths = segment_paths(copy / "log")
    paths[1].unlink()
    paths[2].unlink()
    torn = paths[-1]
    torn.write_bytes(torn.read_bytes()[:300])
    opened = _open(copy, "i1", reported, closing_at_end)
    missing = [one for one in reported if "missing" in one]
    assert len(missing) == 1
    assert missing[0].startswith("segments 2 to 3 of the log are missing: what happened from 2023-")
    assert any(one.startswith(torn.name) for one in reported)
    assert list(opened.archive().flaws()) == [one for one in reported if "database" not in one]


def test_complete_log_has_no_defects(
    copy: Path, reported: list[str], closing_at_end: ExitStack
) -> None:
    station_app.rebuild(copy, lambda _: None)
    opened = _open(copy, "i1", reported, closing_at_end)
    assert reported == []
    assert opened.keeps_result
    segment_paths(copy / "log")[-1].unlink()
    _open(copy, "i1", reported, closing_at_end)
    assert any("missing" in one for one in reported), "only the database knows of it"


def test_damage_is_reported_once_when_read(
    copy: Path, reported: list[str], closing_at_end: ExitStack
) -> None:
    station_app.rebuild(copy, lambda _: None)
    path = segment_paths(copy / "log")[1]
    data = bytearray(path.read_bytes())
    data[len(data) // 2] ^= 0xFF
    path.write_bytes(data)
    opened = _open(copy, "i1", reported, closing_at_end)
    for _ in range(2):
        assert list(opened.log.records())
    (damage,) = (one for one in reported if path.name in one)
    assert damage in opened.archive().flaws(), "and on the screen, by then"


def test_damage_skipped_by_a_seek_is_found_by_the_check(
    copy: Path, reported: list[str], closing_at_end: ExitStack
) -> None:
    station_app.rebuild(copy, lambda _: None)
    archive = _open(copy, "i1", reported, closing_at_end).archive()
    path = segment_paths(copy / "log")[1]
    data = bytearray(path.read_bytes())
    data[len(data) // 2] ^= 0xFF
    path.write_bytes(data)
    assert archive.flaws() == ()
    while archive.check_next_chunk():
        pass
    (damage,) = archive.flaws()
    assert damage.startswith(f"a part of the log cannot be read: {path.name}: the chunk at byte")
    assert reported == [damage]


def emptied(path: Path) -> None:
    """A whole file of MCAP, with nothing in it."""
    with path.open("wb") as file:
        writer = Writer(file)
        writer.start(profile="muster")
        writer.finish()


def of_another_time(path: Path) -> None:
    elsewhere = path.parent.parent / "elsewhere"
    later = [(t_ns + 7200 * NS_PER_S, key, payload) for t_ns, key, payload in walked()[:500]]
    _log(elsewhere, later)
    shutil.copy(segment_paths(elsewhere / "log")[0], path)


def test_foreign_segment_after_the_log_is_left_out(
    tmp_path: Path, reported: list[str], closing_at_end: ExitStack
) -> None:
    """With the next number and a later time, of an incident that is not closed in the log."""
    data, is_open = tmp_path / "station", len(walked()) - 200
    _log(data, walked()[:is_open], POLICY)
    end_ns = max(one.end_ns for one in DataFolder(data).segments())
    of_another_time(tmp_path / "other.mcap")
    elsewhere = segment_paths(tmp_path.parent / "elsewhere" / "log")[0]
    number = len(segment_paths(data / "log")) + 1
    beside = segment_path(data / "log", number, segment_began_ns(elsewhere))
    shutil.move(tmp_path / "other.mcap", beside)
    opened = _open(data, "i1", reported, closing_at_end)
    assert [beside.name in one for one in reported].count(True) == 1, reported
    assert (
        f"{beside.name} is no segment of this log and is left out: it is of another log" in reported
    )
    assert max(one.end_ns for one in opened.folder.segments()) == end_ns


@pytest.mark.parametrize("is_station", [True, False])
def test_foreign_files_are_reported(
    is_station: bool, copy: Path, reported: list[str], closing_at_end: ExitStack
) -> None:
    """In a station's folder, or among files that somebody gives."""
    log = copy / "log"
    of_another_time(copy / "foreign.mcap")
    shutil.move(copy / "foreign.mcap", log)
    (log / "empty.mcap").touch()
    opened = _open(copy if is_station else log, "i1", reported, closing_at_end)
    for name in ("foreign.mcap", "empty.mcap"):
        (stated,) = (one for one in reported if name in one)
        assert f"{name} is no segment of this log and is left out" in stated
    assert len(list(opened.folder.segments())) == len(segment_paths(log))
    assert set(reported) <= {*opened.defects(), *reported[-1:]}


def cut_short(path: Path) -> None:
    path.write_bytes(path.read_bytes()[: path.stat().st_size // 2])


@pytest.mark.parametrize(
    ("damage", "words"),
    [
        (emptied, "is empty: what happened from 2023-"),
        (of_another_time, "is no segment of this log and is left out"),
        (cut_short, "cannot be read"),
        (Path.unlink, "segment 2 of the log is missing: what happened from 2023-"),
    ],
)
@pytest.mark.parametrize("has_database", [True, False])
def test_damaged_segment_is_reported_and_keeps_the_length_of_the_replay(
    damage: Callable[[Path], None],
    words: str,
    has_database: bool,
    copy: Path,
    reported: list[str],
    closing_at_end: ExitStack,
) -> None:
    if has_database:
        station_app.rebuild(copy, lambda _: None)
    end_ns = max(one.end_ns for one in DataFolder(copy).segments())
    damage(segment_paths(copy / "log")[1])
    opened = _open(copy, "i1", reported, closing_at_end)
    assert any(words in one for one in reported), reported
    assert not any("decides otherwise" in one for one in reported)
    assert max(one.end_ns for one in opened.folder.segments()) == end_ns


def test_middle_part_of_a_log_is_not_reported_as_another_program(
    copy: Path, reported: list[str], closing_at_end: ExitStack
) -> None:
    """It lacks what was before, and that is told."""
    _log(copy / "decided", list(logged()), SegmentPolicy(segment_s=30.0))
    segment_paths(copy / "decided" / "log")[0].rename(copy / "first.mcap")
    (middle, *_) = segment_paths(copy / "decided" / "log")
    _open(middle, "i1", reported, closing_at_end)
    assert not any("decides otherwise" in one for one in reported)


def test_log_with_a_truncated_index_has_lost_nothing(
    copy: Path, reported: list[str], closing_at_end: ExitStack
) -> None:
    path = segment_paths(copy / "log")[1]
    with SegmentReader(path) as reader:
        records = list(reader.records())
    content = path.read_bytes()
    for end in range(len(content) - 1, len(content) - 2000, -97):
        path.write_bytes(content[:end])
        with SegmentReader(path) as reader:
            if list(reader.records()) == records:
                assert reader.bytes_lost == 0
    path.write_bytes(content[:-40])
    assert recover_log(copy / "log")[0].bytes_lost == 0
    assert str(recover_log(copy / "log")) == "[]"
    _open(copy, "i1", reported, closing_at_end)
    assert not any("lost" in one or "cannot be read" in one for one in reported)


def test_outdated_database_is_not_used_for_the_log(
    tmp_path: Path, reported: list[str], closing_at_end: ExitStack
) -> None:
    """As where the log was copied again and the database was not."""
    script = Script()
    script.act(OpenIncident("i1", "Mill Lane"))
    script.wait(1.0)
    script.act(CloseIncident("i1"))
    half = len(script.records)
    script.wait(100.0)
    script.act(OpenIncident("i2", "Church Street"))
    script.wait(1.0)
    _log(tmp_path, script.records[:half])
    station_app.rebuild(tmp_path, lambda _: None)
    _log(tmp_path, script.records[half:])
    opened = _open(tmp_path, "i2", reported, closing_at_end)
    assert Records(opened.store, SystemClock()).require_incident("i2").name == "Church Street"
    assert not opened.keeps_result
    assert Records(_open(tmp_path, "i1", reported, closing_at_end).store, SystemClock()).incident(
        "i1"
    )


def test_different_decisions_of_another_version_are_reported(
    tmp_path: Path, reported: list[str], closing_at_end: ExitStack
) -> None:
    """Nobody may take what it shows for what was shown."""
    _log(tmp_path, list(logged(north(2.0))))
    opened = _open(tmp_path, "i1", reported, closing_at_end)
    assert any("decides otherwise than the station did" in one for one in reported)
    assert any("decides otherwise" in one for one in opened.archive().flaws())


def _open(data: Path, incident_id: str, reported: list[str], stack: ExitStack) -> Any:
    return open_offline_log(
        data, incident_id, stack, reported.append, lambda _: None, in_place=True
    )


def test_replay_stopped_during_its_start_leaves_no_personal_data(
    copy: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    scratch = tmp_path / "scratch"
    scratch.mkdir()
    monkeypatch.setenv("TMPDIR", str(scratch))
    flags = ("--data", str(copy), "--http", "127.0.0.1:0")
    with Command(tmp_path / "replay.txt", "replay", "i1", *flags) as replaying:
        until(lambda: any(scratch.glob("muster-past-*/*")), "the first file of the copy is there")
        replaying.stop()
    assert list(scratch.iterdir()) == []


@pytest.mark.parametrize(("left", "writable"), [(("-wal",), True), (("-wal", "-shm"), False)])
def test_replay_leaves_the_folder_unchanged(
    left: tuple[str, ...], writable: bool, copy: Path, tmp_path: Path
) -> None:
    """Also what a kill left beside the database, and where nothing can be written."""
    station_app.rebuild(copy, lambda _: None)
    database = copy / "station.sqlite"
    if left:
        with Store(database) as store:
            Accounts(store, SystemClock()).add_user("ada", "only the others know it", Role.VIEWER)
            beside = {one: Path(f"{database}{one}").read_bytes() for one in ("", *left)}
        for suffix, content in beside.items():
            Path(f"{database}{suffix}").write_bytes(content)
    before = {one: one.read_bytes() for one in copy.rglob("*") if one.is_file()}
    folders = {one: one.stat().st_mtime_ns for one in (copy, copy / "log")}
    for path in () if writable else (*before, *folders):
        path.chmod(0o555 if path.is_dir() else 0o444)
    flags = ("--data", str(copy), "--http", "127.0.0.1:0")
    with CommandByModes(tmp_path / "replay.txt", "replay", "i1", *flags) as replaying:
        with client_of_replay(replaying) as client:
            assert client.get("/incidents/i1/trails?kind=smoothed").is_success
        assert replaying.stop() == 0
    assert {one: one.read_bytes() for one in copy.rglob("*") if one.is_file()} == before
    assert {one: one.stat().st_mtime_ns for one in folders} == folders


def test_replay_of_another_stations_folder_has_its_own_login(copy: Path, tmp_path: Path) -> None:
    """Nobody here knows its passwords, and they are not to be changed in what was given."""
    station_app.rebuild(copy, lambda _: None)
    with Store(copy / "station.sqlite") as store:
        accounts = Accounts(store, SystemClock())
        accounts.add_user("replay", "only the others know it", Role.ADMINISTRATOR)
    flags = ("--data", str(copy), "--http", "127.0.0.1:0")
    with Command(tmp_path / "replay.txt", "replay", "i1", *flags) as replaying:
        with client_of_replay(replaying) as client:
            assert client.get("/incidents/i1/alarms").is_success
        assert replaying.stop() == 0
    with Store(copy / "station.sqlite") as store:
        names = [one.username for one in Accounts(store, SystemClock()).users()]
    assert names == ["replay"]
