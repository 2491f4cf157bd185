"""Incidents of an archive are listed, replayed and queried, without the log of the station."""

from __future__ import annotations

import json
import re
from collections.abc import Callable
from contextlib import ExitStack, closing
from pathlib import Path
from typing import Any
from urllib.error import URLError

import pytest

from base_station.app.archive_sources import open_archived_log
from base_station.archive.store import open_store
from base_station.config import HttpConfig
from base_station.department.answers import StartedReplay
from base_station.department.archive_replays import ArchiveReplays
from base_station.department.config import DepartmentArchiveConfig
from base_station.engine.log_feed import FolderFeed
from base_station.replay.recorded_player import RecordedPlayer
from base_station.storage.db.records import Records
from base_station.storage.db.store import Store
from base_station.storage.db.window import EVER
from shared.clock import NS_PER_S, SystemClock
from shared.errors import ArchiveError
from shared.mcap_log import segment_paths
from tests.rig.archived_station import WALKED_S, succeeded
from tests.rig.bucket_server import ADDRESS, BucketServer
from tests.rig.console_client import Api
from tests.rig.counting_store import CountingStore
from tests.rig.live_station import Screen
from tests.rig.served_station import snapshot
from tests.rig.shown_replay import people, shown_at
from tests.rig.station_command import Browser, Command
from tests.rig.station_process import free_port
from tests.rig.waiting import until

MOST_REQUESTS = 5


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
        code = away["text_code"]
        assert (code["code"], code["texts"]["archive"]) == ("archive-bucket-away", address)
        assert code["texts"]["what:"] in ("archive-cannot-list", "archive-cannot-read")
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
            with pytest.raises(AssertionError, match=f"503 .*{address}.*archive-bucket-away"):
                browser.call("POST", "/replays", json={"incident_id": "i1"})
        finally:
            server.start()


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
                with pytest.raises(AssertionError, match=f"503 .*{address}.*nothing is lost") as no:
                    browser.text(path)
                assert "archive-bucket-away" in str(no.value), "consoles have it in their language"
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
