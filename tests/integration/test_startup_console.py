"""While a station reads its log, its console shows the last stored state and the progress."""

from __future__ import annotations

import gc
import json
from collections.abc import Iterator
from contextlib import ExitStack
from datetime import UTC, datetime, timedelta
from pathlib import Path
from socket import create_connection
from ssl import PROTOCOL_TLS_CLIENT, MemoryBIO, SSLContext, SSLWantReadError
from typing import NoReturn

import httpx
import pytest
from starlette.types import Receive, Scope, Send
from websockets.sync.client import connect

from base_station.accounts.principals import Role
from base_station.api.authentication import COOKIE
from base_station.api.server import bind
from base_station.app import startup_console as module
from base_station.app import stored_snapshot
from base_station.app.startup_console import serve_while_recovering, startup_application
from base_station.app.station_storage import StationStorage, open_storage
from base_station.app.stored_snapshot import StoredSnapshotSource
from base_station.config import HttpConfig, StationConfig
from base_station.engine.ports import Record, Trails
from base_station.security.pki.certificates import issue, make_authority
from base_station.site.max_travel import max_travel_m
from base_station.storage.data_folder import DataFolder
from base_station.storage.db.store import Store
from base_station.storage.projection import Projection
from base_station.storage.recorder import Recorder
from base_station.views.wire import Snapshot
from shared.clock import NS_PER_S, ManualClock
from shared.enrolment import Holder
from shared.errors import StoreError
from shared.header_factory import HeaderFactory
from shared.mcap_log import SegmentInfo, SegmentState
from shared.messages import STATION_ID, AlarmChange, AlarmState, OperatorAction
from shared.messages.station import Action, Assign, OpenIncident, RegisterUnit
from tests.rig import message_factory as stated_by_bench
from tests.rig.in_process_station import PASSWORD
from tests.rig.waiting import PATIENCE_S

SEGMENT = SegmentInfo(Path("1.mcap"), SegmentState.CLOSED, 1000, 5000, 5, 1)


def test_last_stored_state_is_shown_read_only(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, clock: ManualClock
) -> None:
    monkeypatch.setattr(module, "_SERVE_AFTER_S", 0.0)
    monkeypatch.setattr(module, "_ANNOUNCE_EVERY_S", 0.0)
    monkeypatch.setattr(module, "_RECORDS_PER_REPORT", 1)
    monkeypatch.setattr(stored_snapshot, "_PUBLISH_EVERY_NS", 0)
    stated: list[str] = []
    folder = DataFolder(tmp_path)
    recorder = Recorder(tmp_path, clock)
    with bind("127.0.0.1", 0) as listening, ExitStack() as closing:
        closing.callback(recorder.close)
        disk = open_storage(folder, recorder, clock, stated.append, closing)
        store_what_happened(disk)
        address = f"http://127.0.0.1:{listening.getsockname()[1]}"
        config = StationConfig(data=tmp_path)

        def records() -> Iterator[Record]:
            for t_ns in (1000, 2000, 3000):
                yield t_ns, "key", b""
            look(address)

        with serve_while_recovering(
            [SEGMENT],
            listening,
            HttpConfig(),
            lambda: startup_application(config, disk),
            stated.append,
        ) as watched:
            assert [t_ns for t_ns, _, _ in watched(records())] == [1000, 2000, 3000]
        with pytest.raises(httpx.TransportError):
            httpx.get(address, timeout=0.3)
        assert listening.fileno() >= 0
    assert stated[-1] == "reading the log: 50%"


def store_what_happened(disk: StationStorage, raised_before_s: float = 0.0) -> None:
    disk.accounts.add_user("ada", PASSWORD, Role.COMMANDER)
    header_factory = HeaderFactory(STATION_ID, 1, disk.clock)
    t_ns = disk.clock.utc_ns()
    actions: tuple[Action, ...] = (OpenIncident("i1", "Mill Lane"), RegisterUnit("FF-01", "one"),
               Assign("FF-01", "p1", "Bea", "red", "leader"))  # fmt: skip
    header = header_factory.header()
    disk.projection.project(
        Projection(
            t_ns,
            actions=tuple(
                OperatorAction(header, f"a{number}", "ada", action)
                for number, action in enumerate(actions)
            ),
            last_messages=(("FF-01", t_ns),),
            tracks=(stated_by_bench.fused(header, "FF-01", north_m=3.0, east_m=4.0),),
            alarms=(
                AlarmChange(
                    header,
                    "x1",
                    "mayday",
                    "FF-01",
                    1,
                    AlarmState.RAISED,
                    "",
                    "MAYDAY",
                    "",
                    raised_ns := t_ns - round(raised_before_s * NS_PER_S),
                    raised_ns,
                ),
            ),
        )
    )
    disk.projection.flush()


class NoConsoles:
    """No console is open."""

    def reset(self, *_: object) -> None:
        pass

    def delta(self, _: object) -> None:
        pass


def test_unit_received_long_ago_in_the_incident_is_shown_at_its_position(
    tmp_path: Path, clock: ManualClock
) -> None:
    """And an alarm that had been raised when somebody opened it."""
    folder, recorder = DataFolder(tmp_path), Recorder(tmp_path, clock)
    with ExitStack() as closing:
        closing.callback(recorder.close)
        disk = open_storage(folder, recorder, clock, lambda _: None, closing)
        assert isinstance(disk.store, Store)
        disk.store.hangs = lambda: False  # hours go by between two turns of the recorder
        store_what_happened(disk, raised_before_s=600.0)
        pictures = []
        for waited_s in (1800.0, 3 * 3600.0):
            clock.advance(waited_s)
            pictures.append(
                StoredSnapshotSource(disk.roster, disk.records, clock, NoConsoles()).snapshot()
            )
    for picture, trails in pictures:
        (shown,) = picture.units
        assert shown.position is not None
        assert (shown.position.north_m, shown.position.east_m) == (3.0, 4.0)
        assert [points[1:3] for points in json.loads(bytes(trails["FF-01"]))] == [[3.0, 4.0]]
        assert [one.text for one in picture.alarms] == ["MAYDAY"]


def test_uncertainty_grows_while_units_are_not_received(tmp_path: Path, clock: ManualClock) -> None:
    with ExitStack() as closing:
        recorder = Recorder(tmp_path, clock)
        closing.callback(recorder.close)
        disk = open_storage(DataFolder(tmp_path), recorder, clock, lambda _: None, closing)
        assert isinstance(disk.store, Store)
        disk.store.hangs = lambda: False
        store_what_happened(disk)
        known = StoredSnapshotSource(disk.roster, disk.records, clock, NoConsoles())
        radii_m = []
        for waited_s in (1.0, 30.0, 60.0):
            clock.advance(waited_s)
            (shown,) = known.snapshot()[0].units
            assert shown.position is not None
            assert shown.position.ellipse_major_m == shown.position.ellipse_minor_m
            radii_m.append(shown.position.ellipse_major_m)
    first_m, second_m, third_m = radii_m
    assert second_m - first_m == pytest.approx(max_travel_m(31.0))
    assert third_m - first_m == pytest.approx(max_travel_m(91.0))


class Consoles:
    """They show what they are told."""

    def __init__(self) -> None:
        self.shown: list[Snapshot] = []

    def reset(self, snapshot: Snapshot, _: Trails) -> None:
        self.shown.append(snapshot)

    def delta(self, _: object) -> None:
        raise AssertionError("nothing here is live")


def test_temporarily_unreadable_tables_do_not_end_the_start(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, clock: ManualClock
) -> None:
    """The log has everything; what was last stored is shown once it can be read."""
    monkeypatch.setattr(stored_snapshot, "_PUBLISH_EVERY_NS", 0)
    folder, recorder = DataFolder(tmp_path), Recorder(tmp_path, clock)
    with ExitStack() as closing:
        closing.callback(recorder.close)
        disk = open_storage(folder, recorder, clock, lambda _: None, closing)
        store_what_happened(disk)
        hangs = True
        assert isinstance(disk.store, Store)
        disk.store.hangs = lambda: hangs
        consoles = Consoles()
        known = StoredSnapshotSource(disk.roster, disk.records, clock, consoles)
        known.report_progress(0.1)
        with pytest.raises(StoreError):
            known.request_snapshot(consoles.reset)
        assert consoles.shown == []
        hangs = False
        known.report_progress(0.2)
    (shown,) = consoles.shown
    assert shown.health.reading == 0.2


def look(address: str) -> None:
    with httpx.Client(
        base_url=f"{address}/api/v1", headers={"origin": address}, timeout=PATIENCE_S
    ) as browser:
        page = httpx.get(address, timeout=PATIENCE_S)
        assert "frame-ancestors" in page.headers["content-security-policy"]
        assert browser.get("/units").status_code == 401
        credentials = {"username": "ada", "password": PASSWORD}
        assert browser.post("/login", json=credentials).status_code == 200
        (unit,) = browser.get("/units").json()
        assert unit["person_id"] == "p1"
        refused = browser.post("/incidents", json={"name": "Other"})
        assert refused.status_code == 503
        assert "reading its log (50%)" in refused.json()["detail"]
        assert browser.post("/standby/take-over").status_code == 503
        assert browser.get("/standby/leads").json() == {"leads": False}
        cookie = f"{COOKIE}={browser.cookies[COOKIE]}"
        with connect(
            f"{address.replace('http', 'ws')}/api/v1/live",
            additional_headers={"cookie": cookie, "origin": address},
        ) as socket:
            picture, trail = json.loads(socket.recv()), json.loads(socket.recv())
    assert picture["health"]["reading"] == 0.5
    assert picture["incident"]["name"] == "Mill Lane"
    (shown,) = picture["units"]
    assert (shown["link"], shown["trust"]["level"]) == ("lost", "red")
    assert shown["person"]["name"] == "Bea"
    assert (shown["position"]["north_m"], shown["position"]["east_m"]) == (3.0, 4.0)
    assert shown["alarms"] == ["x1"]
    assert [one["text"] for one in picture["alarms"]] == ["MAYDAY"]
    assert (trail["unit_id"], trail["points"][0][1:3]) == ("FF-01", [3.0, 4.0])


def never() -> NoReturn:
    pytest.fail("it was quick")


def test_a_quick_start_shows_no_page(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(module, "_StartupServer", None)
    stated: list[str] = []
    with (
        bind("127.0.0.1", 0) as listening,
        serve_while_recovering([SEGMENT], listening, HttpConfig(), never, stated.append) as watched,
    ):
        assert list(watched(iter([(1000, "key", b"")]))) == [(1000, "key", b"")]
    assert stated == []


def test_unfinished_tls_handshake_is_closed_when_the_log_is_read(
    monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture, tmp_path: Path
) -> None:
    monkeypatch.setattr(module, "_SERVE_AFTER_S", 0.0)
    now, day = datetime.now(UTC), timedelta(days=1)
    issued = issue(make_authority("Test", now, 2 * day), "station", Holder.STATION, now, day)
    http = HttpConfig(certificate=tmp_path / "station.pem", private_key=tmp_path / "station.key")
    (tmp_path / "station.pem").write_bytes(issued.certificate_pem())
    (tmp_path / "station.key").write_bytes(issued.key_pem())
    with bind("127.0.0.1", 0) as listening, create_connection(listening.getsockname()) as client:

        def records() -> Iterator[Record]:
            yield 1000, "key", b""
            client.sendall(first_words())
            assert client.recv(1), "the station answers, and waits for what never comes"

        with serve_while_recovering(
            [SEGMENT], listening, http, lambda: (no_page, lambda _: None), lambda _: None
        ) as watched:
            assert len(list(watched(records()))) == 1
    gc.collect()
    assert caplog.messages == []


async def no_page(_scope: Scope, _receive: Receive, _send: Send) -> None:
    """Nobody gets as far as to ask."""


def first_words() -> bytes:
    """First bytes of a TLS client."""
    stated, context = MemoryBIO(), SSLContext(PROTOCOL_TLS_CLIENT)
    with pytest.raises(SSLWantReadError):
        context.wrap_bio(MemoryBIO(), stated, server_hostname="x").do_handshake()
    return stated.read()
