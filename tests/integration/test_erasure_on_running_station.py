"""Erasure beside a running station: memory, checkpoints and pulls are erased too."""

from __future__ import annotations

import hashlib
import shutil
from concurrent.futures import Future
from contextlib import ExitStack
from pathlib import Path

import msgspec
import pytest

from base_station.app.station_storage import open_storage
from base_station.engine.ports import ActionResult
from base_station.privacy import erasure_service
from base_station.privacy.erasure_service import ErasureService
from base_station.privacy.log_files import ClosedLog
from base_station.storage.checkpoints import Checkpoints
from base_station.storage.data_folder import DataFolder
from base_station.storage.db.models import IncidentRow
from base_station.storage.db.records import Records
from base_station.storage.db.store import Store
from base_station.storage.db.window import EVER
from base_station.storage.recorder import Recorder
from base_station.unit_sync.recordings.transfer import TransferRequest, TransferState
from base_station.unit_sync.recordings.transfer_queue import TransferQueue
from shared.clock import SystemClock
from shared.errors import StoreError
from shared.mcap_log import (
    SegmentReader,
    read_log,
    segment_paths,
)
from shared.messages.recording import RecordedFile, RecordingIndex, RecordingPiece
from shared.messages.station import (
    Assign,
    RegisterUnit,
    ResolveAlarm,
    Unassign,
)
from tests.rig.erasure_folders import NoPulls, acting_in
from tests.rig.erasure_scenario import ANA, BO, Walker, names_in, stored_in
from tests.rig.live_station import LiveStation
from tests.rig.waiting import until


def test_erasure_runs_on_a_running_station(tmp_path: Path) -> None:
    folder = DataFolder(tmp_path)
    with LiveStation(tmp_path) as station, ExitStack() as closing:
        store = closing.enter_context(Store(folder.database))
        records = Records(store, SystemClock())
        service = ErasureService(
            station.recorder, store, station.checkpoints, records, SystemClock(), NoPulls(),
            station.drive.submit,
        )  # fmt: skip
        station.act(RegisterUnit("FF-01", "FF-01"))
        station.act(Assign("FF-01", "p-77", ANA, "", ""))
        walker = Walker(station, "FF-01")
        walker.walk(10, 3.0)
        walker.press_mayday()
        (mayday,) = station.pipeline.state.alarms.values()
        station.act(ResolveAlarm(mayday.alarm_id, f"spoke with {ANA}"))
        station.act(Unassign("FF-01"))
        station.act(RegisterUnit("FF-02", "FF-02"))
        station.act(Assign("FF-02", "p-bo", BO, "", ""))
        Walker(station, "FF-02").press_mayday()
        service.erase_person("admin", "p-77")
        unit = station.pipeline.state.units["FF-01"]
        assert unit.trails.shown == []
        assert unit.place.fused is None
        saved = station.pipeline.checkpoint()
        assert ANA.encode() not in saved
        assert BO in station.pipeline.state.alarms["mayday|FF-02"].text
        until(lambda: station.screen.resets != [], "open consoles begin anew")
        shown = msgspec.json.encode(station.screen.resets[-1]).decode()
        assert (ANA in shown, BO in shown) == (False, True)
        station.act(RegisterUnit("FF-03", "FF-03"))  # the log goes on
        assert len(station.recorder.segments()) > 1
    assert len(list(read_log(folder.log))) > 10
    text = b"".join(payload for _, _, payload in read_log(folder.log)).decode("utf-8", "ignore")
    assert ANA not in text
    for path in folder.checkpoints.glob("*.checkpoint"):
        found = station.checkpoints.latest(int(path.stem))
        assert ANA.encode() not in msgspec.msgpack.encode(found)


def test_requested_erasure_waits_for_the_end_of_a_new_incident(tmp_path: Path) -> None:
    folder, clock, acted = DataFolder(tmp_path), SystemClock(), []
    with ExitStack() as closing:
        recorder = Recorder(folder.log, clock)
        closing.callback(recorder.close)
        disk = open_storage(folder, recorder, clock, lambda _: None, closing)
        with disk.store.write() as session:
            session.add(
                IncidentRow(
                    incident_id="i1", name="", opened_ns=1, opened_by="bo", closed_ns=None,
                    closed_by="",
                )
            )  # fmt: skip
        desk = disk.erasure_queue(
            NoPulls(), lambda _, action: acted.append(action), lambda: None, lambda: True,
            lambda: False, lambda *_: 0,
        )  # fmt: skip
        with desk:
            desk.add("ada", "person", "p-77")
            until(lambda: "an incident is open" in desk.all()[0].problem)
        assert acted == []


@pytest.mark.parametrize("comes", [True, False])
def test_damaged_segment_is_repaired_from_the_other_station_before_erasure(
    tmp_path: Path, reported: Path, monkeypatch: pytest.MonkeyPatch, comes: bool
) -> None:
    """Written anew without it the segment would look whole.  Nobody waits for it in vain."""
    monkeypatch.setattr("base_station.privacy.erasure_queue._AGAIN_S", 0.05)
    monkeypatch.setattr("base_station.app.station_storage.REPAIR_RETENTION", 10**9 if comes else 2)
    folder, clock = DataFolder(shutil.copytree(reported, tmp_path / "station")), SystemClock()
    damaged = segment_paths(folder.log)[1]
    whole = damaged.read_bytes()
    with SegmentReader(damaged) as reader:
        place = reader._contents.chunks[1].offset + 100
    damaged.write_bytes(whole[:place] + bytes([whole[place] ^ 1]) + whole[place + 1 :])
    with ExitStack() as closing:
        recorder = Recorder(folder.path, clock)
        closing.callback(recorder.close)
        disk = open_storage(folder, recorder, clock, lambda _: None, closing, alone=False)
        desk = disk.erasure_queue(
            NoPulls(), acting_in(recorder), lambda: None, lambda: True, lambda: True, lambda *_: 0
        )
        with desk:
            desk.add("ada", "person", "p-77")
            if comes:
                until(lambda: "fetched from the other station first" in desk.all()[0].problem)
                with recorder.rewriting:
                    assert damaged.read_bytes() != whole
                    damaged.write_bytes(whole)
            until(lambda: desk.all()[0].state.is_over)
        assert disk.check.damaged == (damaged,), "it is told, and mended by who mends"
        (entry,) = [one for one in disk.records.audit_entries(EVER) if one.by == "ada"]
    assert ("Damaged" in entry.detail) != comes
    assert names_in(stored_in(folder.path), ANA) == []


def test_checkpoints_are_removed_after_the_erasure_in_memory(
    tmp_path: Path, reported: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A checkpoint saved before still contains everything."""
    data, happened = DataFolder(shutil.copytree(reported, tmp_path / "station")), list[str]()

    class RecordingActions(Future[ActionResult]):
        def result(self, timeout: float | None = None) -> ActionResult:
            assert timeout is not None
            happened.append("acted")
            return ActionResult("", 0, None)

    checkpoints = Checkpoints(data.checkpoints)
    monkeypatch.setattr(checkpoints, "clear", lambda: happened.append("cleared"))
    with Store(data.database) as store:
        ErasureService(
            ClosedLog(data.log), store, checkpoints, Records(store, SystemClock()), SystemClock(),
            NoPulls(), lambda _by, _action: RecordingActions(),
        ).erase_incident("ada", "i1")  # fmt: skip
        assert happened == ["acted", "acted", "acted", "cleared", "cleared"]
        monkeypatch.setattr(erasure_service, "_ACTED_WITHIN_S", 0.0)
        with pytest.raises(StoreError, match="did not get to"):
            ErasureService(
                ClosedLog(data.log), store, checkpoints, Records(store, SystemClock()),
                SystemClock(), NoPulls(), lambda _by, _action: Future(),
            ).erase_person("ada", "p-77")  # fmt: skip


def test_transfer_of_an_erased_recording_is_ended(tmp_path: Path) -> None:
    folder = DataFolder(tmp_path)
    asked: list[str] = []

    def ask(unit_id: str, question: str) -> bytes | None:
        asked.append(f"{unit_id} {question}")
        what, _, parameters = question.partition("?")
        reported = dict(pair.split("=", 1) for pair in parameters.split(";"))
        if what == "index":
            file = RecordedFile("day/000001.mcap", 100_000_000)  # it lasts
            return RecordingIndex((file,), 1).to_bytes()
        offset, data = int(reported["offset"]), b"somebody walked" * 50
        digest = hashlib.sha256(data).digest()
        return RecordingPiece(offset, data, digest, gone=False).to_bytes()

    def others() -> list[Path]:
        return [path for path in folder.recordings.rglob("*.mcap*") if path.is_file()]

    with TransferQueue(ask, folder.recordings, SystemClock()) as pulls:
        pulls.add("ada", TransferRequest("FF-01", 1, 2))
        until(lambda: any(path.stat().st_size > 3000 for path in others()))
        with LiveStation(tmp_path) as station, Store(folder.database) as store:
            station.act(RegisterUnit("FF-01", "FF-01"))
            station.act(Assign("FF-01", "p-77", ANA, "", ""))
            station.act(Unassign("FF-01"))
            ErasureService(
                station.recorder, store, station.checkpoints, Records(store, SystemClock()),
                SystemClock(), pulls,
            ).erase_person("ada", "p-77")  # fmt: skip
        assert not (folder.recordings / "FF-01").exists()
        until(lambda: not pulls._running)
        assert not (folder.recordings / "FF-01").exists()
        asked.clear()
    with TransferQueue(ask, folder.recordings, SystemClock()) as again:
        (pull,) = again.transfers()
        assert (pull.state, pull.problem) == (
            TransferState.FAILED,
            "deleted: its wearer is forgotten",
        )
    assert asked == []
    assert others() == []
