"""Incidents in an archive: copied to an S3 server and to a disk, listed, and shown."""

from __future__ import annotations

import json
import re
import shutil
from collections.abc import Callable, Iterator
from contextlib import ExitStack, closing, suppress
from pathlib import Path
from typing import Any
from urllib.error import URLError

import pytest
from sqlalchemy import select
from typer.testing import CliRunner, Result

from base_station.app.archive_sources import open_archived_log, open_copier
from base_station.app.factories import project_whole_log
from base_station.archive.entry import CONSOLE_NAME, ENTRY_NAME, LOG_NAME, require_entry
from base_station.archive.store import open_store
from base_station.cli import app
from base_station.config import HttpConfig
from base_station.department.answers import StartedReplay
from base_station.department.archive_replays import ArchiveReplays
from base_station.department.config import DepartmentArchiveConfig
from base_station.engine.log_feed import FolderFeed
from base_station.replay.recorded_player import RecordedPlayer
from base_station.storage.db.archived import ArchivedCopies
from base_station.storage.db.models import AlarmRow
from base_station.storage.db.records import Records
from base_station.storage.db.roster import Roster
from base_station.storage.db.store import Store
from base_station.storage.db.window import EVER
from base_station.storage.segment_index import segment_row
from shared.clock import NS_PER_S, SystemClock
from shared.errors import ArchiveError, ConfigError, UserError
from shared.mcap_log import SegmentPolicy, SegmentReader, SegmentWriter, segment_paths
from shared.messages import EventKind
from shared.messages.station import Assign, CloseIncident, OpenIncident, SetPlan
from tests.golden.test_recorded_console import people, shown_at
from tests.integration.test_incident_file import PEOPLE
from tests.rig.bucket_server import ADDRESS, BucketServer, bucket_server
from tests.rig.console_client import Api
from tests.rig.console_log import with_console
from tests.rig.counting_store import CountingStore
from tests.rig.live_station import Screen, make_pipeline
from tests.rig.round_walk import PLAN, Walk
from tests.rig.served_station import snapshot
from tests.rig.station_command import Browser, Command
from tests.rig.station_process import free_port
from tests.rig.station_script import START_NS, Script
from tests.rig.waiting import until

WALKED_S = 400  # three keyframes
MOST_REQUESTS = 5


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A station's folder with two closed incidents, i1 and i2, and one that is open."""
    walk = Walk("FF-01", "FF-02", turn_rad=0.3)
    script = walk.script
    for action in (SetPlan(PLAN), Assign("FF-01", "ada0"), Assign("FF-02", "bo00")):
        script.act(action)
    for unit_id in walk.units:
        walk.start(unit_id)
    walk.go(60)
    script.event("FF-01", EventKind.MAYDAY)
    walk.go(WALKED_S - 60)
    script.act(CloseIncident("i1"))
    script.wait(30.0)
    script.act(OpenIncident("i2", "Harbour"))
    walk.go(30)
    script.act(CloseIncident("i2"))
    script.wait(30.0)
    script.act(OpenIncident("i3", "still open"))
    walk.go(5)
    folder = tmp_path_factory.mktemp("station")
    records = with_console(script.records, make_pipeline(None))
    with closing(SegmentWriter(folder / "log", SegmentPolicy(segment_s=60.0))) as log:
        for record in records:
            log.write(*record)
    with Store(folder / "station.sqlite") as store:
        project_whole_log(store, folder / "log", lambda _: None)
        Roster(store, SystemClock()).bring_people(PEOPLE)
    return folder


@pytest.fixture
def data(made: Path, tmp_path: Path) -> Path:
    """A copy: what is archived is noted in it."""
    return Path(shutil.copytree(made, tmp_path / "station"))


@pytest.fixture(scope="module")
def server() -> Iterator[BucketServer]:
    with bucket_server() as server:
        yield server


@pytest.fixture
def ask_as(server: BucketServer, monkeypatch: pytest.MonkeyPatch) -> Callable[[str], None]:
    def ask(name: str) -> None:
        for variable, value in server.environment(name).items():
            monkeypatch.setenv(variable, value)

    ask("owner")
    return ask


def muster(*arguments: str | Path) -> Result:
    return CliRunner().invoke(app, list(map(str, arguments)))


def succeeded(*arguments: str | Path) -> str:
    result = muster(*arguments)
    assert result.exit_code == 0, (result.output, result.exception)
    return result.output


def refusal(*arguments: str | Path) -> str:
    result = muster(*arguments)
    assert isinstance(result.exception, ArchiveError | UserError | ConfigError), result
    return str(result.exception)


@pytest.mark.slow
def test_bucket_contains_the_incidents_of_the_station(
    data: Path, ask_as: Callable[[str], None], tmp_path: Path
) -> None:
    address = f"{ADDRESS}-whole"
    copied = succeeded("archive", "copy", address, "--data", data)
    assert "2 incidents copied" in copied
    assert "0 incidents copied" in succeeded("archive", "copy", address, "--data", data)
    listed = succeeded("archive", "list", address)
    assert "i1\\t" in listed.replace("\t", "\\t")
    assert "mayday" in listed
    assert "Mill Lane" in listed
    assert ": 0 defects" in succeeded("archive", "verify", address)
    found = succeeded("search", "mill", "--person", "ada", "--alarm", "mayday", "--data", data)
    assert address in found
    assert "i2" not in found

    fetched, exported = tmp_path / "fetched.mcap", tmp_path / "exported.mcap"
    succeeded("archive", "fetch", address, "i1", fetched)
    succeeded("export", "i1", exported, "--data", data)
    assert fetched.read_bytes() == exported.read_bytes()

    with Store(data / "station.sqlite") as store:
        entry = require_entry(open_store(address), "i1")
        files = ArchivedCopies(store).files("i1")
        assert files == {one.name: one for one in entry.files}
        assert {CONSOLE_NAME, LOG_NAME} == set(files)
        assert entry.people.keys() == {"ada0", "bo00"}
        with store.write() as session:
            for table in ("archived_incidents", "archived_objects", "archived_ranges"):
                session.connection().exec_driver_sql(f"DELETE FROM {table}")
    again = succeeded("archive", "copy", address, "--data", data)
    assert again.count("is there already") == 2, "the catalogue is made again from the archive"
    with Store(data / "station.sqlite") as store:
        assert ArchivedCopies(store).files("i1") == files


@pytest.mark.slow
def test_archived_incident_replays_identically_with_few_requests(
    data: Path, ask_as: Callable[[str], None]
) -> None:
    address = f"{ADDRESS}-shown"
    succeeded("archive", "copy", address, "--data", data)
    here = RecordedPlayer(FolderFeed(data / "log").everything, Screen(), people)
    with Store(data / "station.sqlite") as store:
        incident = Records(store, SystemClock()).require_incident("i1")
    for second in range(1, WALKED_S, 57):
        t_ns = incident.opened_ns + second * NS_PER_S
        counted = CountingStore(open_store(address))
        with ExitStack() as closing_all:
            opened = open_archived_log(counted, "i1", closing_all, lambda _: None)
            there = RecordedPlayer(opened.log.everything, Screen(), people)
            assert shown_at(there, t_ns) == shown_at(here, t_ns), second
            assert counted.requests <= MOST_REQUESTS
            if second >= WALKED_S - 57:
                rows = Records(opened.store, SystemClock())
                assert "mayday" in {one.rule for one in rows.alarms(EVER)}
                before = list(
                    FolderFeed(data / "log").records(incident.opened_ns, incident.closed_ns)
                )
                after = list(opened.log.records(incident.opened_ns, incident.closed_ns))
                assert after == before, "to decide again, all of it is fetched"


@pytest.mark.slow
def test_bucket_without_rights_is_reported(
    data: Path, ask_as: Callable[[str], None], monkeypatch: pytest.MonkeyPatch
) -> None:
    address = f"{ADDRESS}-rights"
    succeeded("archive", "copy", address, "--data", data)
    for asker in ("reader", "nobody"):
        ask_as(asker)
        reported = refusal("archive", "copy", f"{address}-other", "--data", data)
        assert "s3:PutObject" in reported
        assert "AWS_ACCESS_KEY_ID" in reported
    assert "s3:ListBucket" in refusal("archive", "list", address)
    ask_as("reader")
    assert "2 incidents" not in succeeded("archive", "verify", address)
    with Store(data / "station.sqlite") as store:
        assert ArchivedCopies(store).archives(["i1", "i2"]) == {"i1": address, "i2": address}
    ask_as("owner")
    assert "has no complete copy of ?; it has: i1, i2" in refusal(
        "archive", "fetch", address, "?", data / "out.mcap"
    )
    assert "make the bucket" in refusal("archive", "list", "s3://no-such-bucket/x")
    monkeypatch.setenv("AWS_ENDPOINT_URL", "http://192.0.2.1:1")
    assert "192.0.2.1" in refusal("archive", "list", address), "names of people are encrypted"


def note_segments(store: Store, log: Path) -> None:
    """As a station does when it begins a segment."""
    rows = []
    for path in segment_paths(log):
        with SegmentReader(path) as segment:
            rows.append(segment_row(segment.info()))
    Records(store, SystemClock()).put_segments(rows)


@pytest.mark.slow
def test_complete_copy_is_not_replaced_after_loss_of_the_log(data: Path, tmp_path: Path) -> None:
    archive = tmp_path / "archive"
    succeeded("archive", "copy", archive, "--data", data)
    before = {path: path.read_bytes() for path in (archive / "i1").iterdir()}
    with Store(data / "station.sqlite") as store:
        note_segments(store, data / "log")
        Roster(store, SystemClock()).change_person("ada0", "Ada Changed", "", "")
        with store.write() as session:
            for table in ("archived_incidents", "archived_objects", "archived_ranges"):
                session.connection().exec_driver_sql(f"DELETE FROM {table}")
    segment_paths(data / "log")[1].unlink()
    refused = refusal("archive", "copy", archive, "--data", data)
    assert "i1 has newer data than its copy" in refused
    assert "i2" not in refused
    assert {path: path.read_bytes() for path in before} == before
    with Store(data / "station.sqlite") as store:
        assert ArchivedCopies(store).files("i2"), "the others are copied all the same"


@pytest.mark.slow
def test_unreachable_bucket_loses_nothing(
    data: Path, server: BucketServer, ask_as: Callable[[str], None]
) -> None:
    address = f"{ADDRESS}-away"
    with open_copier(address, data) as copier:
        results = copier.copy_due(lambda _: None)
        assert next(results).incident_id == "i1"
        server.stop()
        try:
            with pytest.raises(ArchiveError, match="nothing is lost"):
                next(results)
            assert "nothing is lost" in refusal("archive", "list", address)
        finally:
            server.start()
    again = succeeded("archive", "copy", address, "--data", data)
    assert "i2\t" in again
    assert "i1" not in again
    assert ": 0 defects" in succeeded("archive", "verify", address)


@pytest.mark.slow
def test_station_archives_automatically_and_shows_incidents_without_log(
    data: Path, server: BucketServer, ask_as: Callable[[str], None], serve: Callable[..., Command],
    tmp_path: Path,
) -> None:  # fmt: skip
    address = f"{ADDRESS}-live"
    settings = tmp_path / "station.toml"
    settings.write_text(f'[archive]\nlocation = "{address}"\n')
    server.stop()
    first = serve("--config", str(settings))
    with Browser(first.wait_ready(), data) as browser:
        until(lambda: archive_of(browser)["state"] == "away", "the archive is away")
        away = archive_of(browser)
        assert away["waiting"] == 2
        assert address in away["text"]
        assert "muster_archive_reachable 0.0" in metrics_of(browser)
    first.kill()
    server.start()
    second = serve("--config", str(settings))
    with Browser(second.wait_ready(), data) as browser:
        until(lambda: archived_ids(browser) == {"i1", "i2"}, "both closed incidents are archived")
        until(lambda: archive_of(browser)["state"] == "waiting", "it waits for the next one")
        assert "muster_archive_copied_total 2.0" in metrics_of(browser)
        with_log = shown_in_replay(browser, 0.5)
    assert second.stop() == 0
    assert ": 0 defects" in succeeded("archive", "verify", address)

    for segment in segment_paths(data / "log")[:-1]:
        segment.unlink()
    third = serve("--config", str(settings))
    with Browser(third.wait_ready(), data) as browser:
        assert shown_in_replay(browser, 0.5) == with_log
        server.stop()
        try:
            with pytest.raises(AssertionError, match=f"503 .*{address}"):
                browser.call("POST", "/replays", json={"incident_id": "i1"})
        finally:
            server.start()


@pytest.mark.slow
def test_queries_about_an_incident_without_log_are_answered_from_the_bucket(
    data: Path, server: BucketServer, ask_as: Callable[[str], None], serve: Callable[..., Command],
    tmp_path: Path,
) -> None:  # fmt: skip
    address = f"{ADDRESS}-asked"
    succeeded("archive", "copy", address, "--data", data)
    first = serve()
    with Browser(first.wait_ready(), data) as browser:
        with_log = asked_about_i1(browser)
    assert first.stop() == 0
    assert json.loads(with_log["timeline"] + "}")["silence_s"]["t_ms"]
    assert json.loads(with_log["explanation"])["live_ms"]
    assert len(with_log["raw"]) > 1000
    assert "<svg" in with_log["report"]
    forget_results(data)
    for segment in segment_paths(data / "log")[:-1]:
        segment.unlink()

    second = serve()
    with Browser(second.wait_ready(), data) as browser:
        without_log = asked_about_i1(browser)
        for name, content in with_log.items():
            assert without_log[name] == content, name
        forget_results(data)
        server.stop()
        try:
            for path in addresses_about_i1(browser).values():
                with pytest.raises(AssertionError, match=f"503 .*{address}.*nothing is lost"):
                    browser.text(path)
        finally:
            server.start()
        raw = addresses_about_i1(browser)["raw"]
        until(lambda: is_answered(browser, raw), "the bucket is read again")
        assert browser.text(raw) == with_log["raw"]
    assert second.stop() == 0
    forget_results(data)
    for arguments in (
        ("report", "i1", "--html", tmp_path / "i1.html"),
        ("export", "i1", tmp_path / "i1.csv", "--kind", "raw"),
    ):
        printed = succeeded(*arguments, "--data", data)
        assert f"the log of i1 is not here any more: it is read in {address}" in printed
    assert (tmp_path / "i1.csv").read_bytes().decode() == with_log["raw"]


def is_answered(browser: Browser, path: str) -> bool:
    """A server that has started again may refuse for some seconds still."""
    try:
        browser.text(path)
    except AssertionError:
        return False
    return True


def addresses_about_i1(browser: Browser) -> dict[str, str]:
    """Addresses of all that is made of the log, by name."""
    (i1,) = (one for one in browser.call("GET", "/incidents") if one["incident_id"] == "i1")
    during = f"from_ms={i1['opened_ms']}&until_ms={i1['closed_ms']}"
    alarms = browser.call("GET", "/alarms?from_ms=0")
    mayday = next(one["alarm_id"] for one in alarms if one["rule"] == "mayday")
    return {
        "timeline": f"/units/FF-01/timeline?{during}",
        "explanation": f"/alarms/{mayday}/explanation",
        "report": "/incidents/i1/report.html",
        "raw": "/incidents/i1/export/csv?kind=raw",
        "whole": "/incidents/i1/incident.mcap",
    }


def asked_about_i1(browser: Browser) -> dict[str, str]:
    """Without the state of the files, which is another where they are gone."""
    answers = {name: browser.text(path) for name, path in addresses_about_i1(browser).items()}
    drawn = "".join(re.findall("<svg.*?</svg>", answers["report"], re.DOTALL))
    timeline = answers["timeline"].partition(',"defects"')[0]
    records = answers["whole"].partition("muster.incident")[0][:-20]  # its length, too
    return answers | {"timeline": timeline, "report": drawn, "whole": records}


def forget_results(data: Path) -> None:
    """Remove results of post-processing, so that it is done again."""
    with Store(data / "station.sqlite") as store, store.write() as session:
        for table in ("smoothed_incidents", "incident_trails", "looked_back"):
            session.connection().exec_driver_sql(f"DELETE FROM {table}")


def archive_of(browser: Browser) -> dict[str, Any]:
    archive: dict[str, Any] = browser.call("GET", "/health")["archive"]
    return archive


def archived_ids(browser: Browser) -> set[str]:
    incidents = browser.call("GET", "/incidents")
    return {one["incident_id"] for one in incidents if one["archived_ms"] is not None}


def metrics_of(browser: Browser) -> str:
    return browser.text("/metrics")


def shown_in_replay(browser: Browser, part: float) -> dict[str, Any]:
    """Positions of a second of i1."""
    opened = browser.call("POST", "/replays", json={"incident_id": "i1"})
    path, span_ms = f"/replays/{opened['replay_id']}", opened["end_ms"] - opened["start_ms"]
    at_ms = opened["start_ms"] + round(part * span_ms)
    until(lambda: not moved_to(browser, path, at_ms)["seeking"], "it stands there")
    shown = snapshot(browser, f"{path}/live")
    assert shown["replay"]["at_ms"] == at_ms
    browser.call("DELETE", path)
    return {one["unit_id"]: one["position"] for one in shown["units"]}


def moved_to(browser: Browser, path: str, at_ms: int) -> dict[str, Any]:
    """State of the replay once it is at the time that was ordered."""
    browser.call("POST", path, json={"at_ms": at_ms, "playing": False})
    view: dict[str, Any] = browser.call("GET", path)
    return view


def test_damaged_copy_is_detected_and_replaced(data: Path, tmp_path: Path) -> None:
    disk = tmp_path / "disk"
    succeeded("archive", "copy", disk, "--data", data)
    assert ": 0 defects" in succeeded("archive", "verify", disk)
    whole = (disk / "i1" / LOG_NAME).read_bytes()
    flipped = bytearray(whole)
    flipped[len(whole) // 2] ^= 1
    (disk / "i1" / LOG_NAME).write_bytes(flipped)
    (disk / "i2" / ENTRY_NAME).unlink()
    verified = muster("archive", "verify", disk)
    assert verified.exit_code == 1
    assert f"i1: {LOG_NAME} is not as it was written" in verified.output
    assert "i2: the copy was cut short" in verified.output
    out = tmp_path / "out.mcap"
    assert "is not as it was written" in refusal("archive", "fetch", disk, "i1", out)
    assert list(tmp_path.glob("*out.mcap*")) == [], "no partial file is left"
    (disk / "i1" / LOG_NAME).write_bytes(whole[:-1])
    with suppress(UserError), Store(data / "station.sqlite") as store, store.write() as session:
        session.connection().exec_driver_sql("DELETE FROM archived_incidents")
    copied = succeeded("archive", "copy", disk, "--data", data)
    assert "already" not in copied
    assert ": 0 defects" in succeeded("archive", "verify", disk)
    entry = json.loads((disk / "i1" / ENTRY_NAME).read_bytes())
    (disk / "i1" / ENTRY_NAME).write_text(json.dumps(entry | {"version": 99}))
    assert "newer version of Muster" in refusal("archive", "fetch", disk, "i1", out)
    assert "an archive is a folder, or s3://" in refusal("archive", "list", "ftp://x/y")
    assert "see that the disk is there" in refusal("archive", "list", tmp_path / "none")


def test_erased_person_is_removed_from_the_next_copy(data: Path, tmp_path: Path) -> None:
    records = list(FolderFeed(data / "log").records())
    script = Script()
    script.now_s = (records[-1][0] - START_NS) / NS_PER_S + 1.0
    script.act(CloseIncident("i3"))
    with closing(SegmentWriter(data / "log")) as log:
        for record in script.records:
            log.write(*record)
    succeeded("rebuild", "--data", data)
    disk = tmp_path / "disk"
    succeeded("archive", "copy", disk, "--data", data)
    assert any(b"Ada" in file.read_bytes() for file in disk.rglob("*.*"))
    forgotten = CliRunner().invoke(app, ["forget", "Ada", "--data", str(data)], input="Ada\n")
    assert forgotten.exit_code == 0, forgotten.output
    assert "3 incidents copied" in succeeded("archive", "copy", disk, "--data", data)
    assert not any(b"Ada" in file.read_bytes() for file in disk.rglob("*.*"))
    with Store(data / "station.sqlite") as store, store.read() as session:
        assert "mayday" in session.scalars(select(AlarmRow.rule)).all()


@pytest.mark.slow
def test_department_replays_archived_incidents_and_ends_the_oldest(
    data: Path, tmp_path: Path
) -> None:
    archive = tmp_path / "archive"
    succeeded("archive", "copy", archive / "engine-7", "--data", data)
    config = DepartmentArchiveConfig(location=str(archive), first_port=free_port(), replays=1)
    with closing(ArchiveReplays(config, HttpConfig())) as replays:
        first = replays.open("engine-7", "i1")
        assert replays.open("engine-7", "i1") == first  # it runs already
        assert shown_by(first) == ["Mill Lane"]
        second = replays.open("engine-7", "i2")
        assert (second.port, shown_by(second)) == (first.port, ["Harbour"])
        with pytest.raises(ArchiveError, match=r"did not start: .*no complete copy of i3"):
            replays.open("engine-7", "i3")
    with pytest.raises(URLError):
        shown_by(second)


def shown_by(replay: StartedReplay) -> list[str]:
    api = Api(f"http://127.0.0.1:{replay.port}", replay.username, replay.password)
    return [one["name"] for one in api.get("/incidents")]
