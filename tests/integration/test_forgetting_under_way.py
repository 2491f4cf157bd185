"""Forgetting beside a running station, asked for over the API, and cut short anywhere."""

from __future__ import annotations

import asyncio
import hashlib
import shutil
from collections.abc import Callable, Collection, Iterator
from concurrent.futures import Future
from contextlib import ExitStack
from pathlib import Path
from typing import Any, cast

import msgspec
import pytest

from base_station.app.disk import open_disk
from base_station.data_folder import DataFolder
from base_station.db.models import Incident
from base_station.db.principals import Role
from base_station.db.records import EVER, Records
from base_station.db.roster import Roster
from base_station.db.store import Store
from base_station.forgetting import forgetter as forgetter_module
from base_station.forgetting.desk import ForgettingDesk
from base_station.forgetting.forgetter import ClosedLog, Forgetter, Tally
from base_station.live.sinks import ActionDone
from base_station.past.checkpoints import Checkpoints
from base_station.recorder import Recorder
from base_station.recordings.desk import RecordingDesk
from base_station.recordings.fetch import FetchState, Wanted
from shared.clock import ManualClock, SystemClock
from shared.errors import StoreError, UserError
from shared.mcap_log import (
    SegmentPolicy,
    SegmentReader,
    SegmentWriter,
    read_log,
    rewrite_segment,
    segment_paths,
)
from shared.messages import CommandKind
from shared.messages.recording import RecordedFile, RecordingIndex, RecordingPiece
from shared.messages.station import (
    Assign,
    ConfirmCommand,
    RegisterUnit,
    ResolveAlarm,
    SendCommand,
    Unassign,
)
from tests.forgetting_story import ANA, BO, Story, Walker, names_in, stored_in
from tests.live_station import LiveStation
from tests.station import DeskStation
from tests.waiting import until


class NoPulls:
    """Nothing is being pulled."""

    def forget(self, unit_ids: Collection[str]) -> None:
        pass


def test_it_is_done_while_the_station_runs(tmp_path: Path) -> None:
    folder = DataFolder(tmp_path)
    with LiveStation(tmp_path) as station, ExitStack() as closing:
        store = closing.enter_context(Store(folder.database))
        records = Records(store, SystemClock())
        forgetter = Forgetter(
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
        forgetter.person("admin", "p-77")
        unit = station.pipeline.state.units["FF-01"]
        assert unit.trail == []
        assert unit.fused is None
        saved = station.pipeline.checkpoint()
        assert ANA.encode() not in saved
        assert BO in station.pipeline.state.alarms["mayday|FF-02"].text
        station.act(RegisterUnit("FF-03", "FF-03"))  # the log goes on
        assert len(station.recorder.segments()) == 2
    assert len(list(read_log(folder.log))) > 10
    text = b"".join(payload for _, _, payload in read_log(folder.log)).decode("utf-8", "ignore")
    assert ANA not in text
    for path in folder.checkpoints.glob("*.checkpoint"):
        found = station.checkpoints.latest(int(path.stem))
        assert ANA.encode() not in msgspec.msgpack.encode(found)


@pytest.fixture
def desk(tmp_path: Path, clock: ManualClock) -> Iterator[DeskStation]:
    (tmp_path / "log").mkdir()
    desk = DeskStation(tmp_path, clock)
    yield desk
    desk.close()


async def test_the_api_asks_for_the_name_and_for_an_administrator(desk: DeskStation) -> None:
    desk.hub.connect(asyncio.get_running_loop(), desk.drive)
    async with desk.client(Role.COMMANDER) as commander:
        person = (await commander.post("/people", json={"name": ANA})).json()
        path = f"/people/{person['person_id']}/forget"
        assert (await commander.post(path, json={"name": ANA})).status_code == 403
    async with desk.client(Role.ADMINISTRATOR) as administrator:
        assert (await administrator.post(path, json={"name": BO})).status_code == 422
        asked = await administrator.post(path, json={"name": ANA})
        assert (asked.status_code, asked.json()["state"]) == (202, "waiting")
        while (one := (await administrator.get("/forgettings")).json()[-1])["state"] != "done":
            await asyncio.sleep(0.02)
        assert (one["kind"], one["subject_id"], one["share"]) == ("person", person["person_id"], 1)
        assert (await administrator.post(path, json={"name": ANA})).status_code == 404
        entries = (await administrator.get("/audit")).json()
    assert ("administrator", "ForgotPerson") in {(one["by"], one["action"]) for one in entries}
    assert not any(ANA in one["detail"] for one in entries)


async def test_a_message_that_is_on_its_way_is_not_forgotten_before_it_is_there(
    desk: DeskStation,
) -> None:
    desk.hub.connect(asyncio.get_running_loop(), desk.drive)
    message = SendCommand("c1", CommandKind.TEXT, "FF-01", "", False, "north door", 0.0, 600.0)
    for action in (RegisterUnit("FF-01", "one"), message):
        desk.drive.submit("chief", action)
    async with desk.client(Role.ADMINISTRATOR) as administrator:
        person = (await administrator.post("/people", json={"name": ANA})).json()
        path = f"/people/{person['person_id']}/forget"
        refused = await administrator.post(path, json={"name": ANA})
        assert refused.status_code == 409
        assert "message" in refused.json()["detail"]
        desk.drive.submit("chief", ConfirmCommand("c1", "FF-01"))
        assert (await administrator.post(path, json={"name": ANA})).status_code == 202


def forgetter_of(data: DataFolder, store: Store, records: Records) -> Forgetter:
    """Of a station that does not run."""
    log, checkpoints = ClosedLog(data.log), Checkpoints(data.checkpoints)
    return Forgetter(log, store, checkpoints, records, SystemClock(), NoPulls())


class PowerCut(BaseException):
    """In the middle of forgetting."""


def test_what_was_wished_before_an_incident_opened_waits_for_its_end(tmp_path: Path) -> None:
    folder, clock, acted = DataFolder(tmp_path), SystemClock(), []
    with ExitStack() as closing:
        recorder = Recorder(folder.log, clock)
        closing.callback(recorder.close)
        disk = open_disk(folder, recorder, clock, lambda _: None, closing)
        with disk.store.write() as session:
            session.add(
                Incident(
                    incident_id="i1", name="", opened_ns=1, opened_by="bo", closed_ns=None,
                    closed_by="",
                )
            )  # fmt: skip
        desk = disk.forgetting_desk(
            NoPulls(), lambda _, action: acted.append(action), lambda: None, lambda: True
        )
        with desk:
            desk.add("ada", "person", "p-77")
            until(lambda: "an incident is open" in desk.all()[0].problem)
        assert acted == []


def test_cut_short_anywhere_and_done_again_no_byte_is_left(tmp_path: Path) -> None:
    """The log goes segment by segment, and the tables after it."""
    story = Story(tmp_path / "station")
    data = DataFolder(story.folder)
    _split(data.log, 4)
    whole = sum(1 for _ in read_log(data.log))
    cuts = 0
    with Store(data.database) as store:
        records = Records(store, SystemClock())
        forgetter = forgetter_of(data, store, records)

        def forget_until(progress: int) -> None:
            told = iter(range(progress))

            def go_on(_: float) -> None:
                if next(told, None) is None:
                    raise PowerCut

            forgetter.person("ada", "p-77", go_on)

        for progress in range(10):
            try:
                forget_until(progress)
                break
            except PowerCut:
                cuts += 1
    assert cuts > 4
    assert names_in(story.stored(), ANA) == []
    assert [payload for payload in story.ana_said if payload in story.stored()] == []
    assert 0 < sum(1 for _ in read_log(data.log)) < whole


def forgotten_in_tries(folder: Path, kind: str, subject_id: str, cut_at: Collection[str]) -> str:
    """What the audit says of it, where the store fails at these steps, each once."""
    data = DataFolder(folder)
    with Store(data.database) as store:
        records = Records(store, SystemClock())
        forgetter = forgetter_of(data, store, records)
        desk = ForgettingDesk(forgetter, data.forgettings, lambda _: "", lambda _: None)
        desk.add("ada", kind, subject_id)
        for step in cut_at:
            with pytest.MonkeyPatch.context() as patched:
                patched.setattr(*BROKEN[step](store, records))
                assert not desk._work_on_one(desk._wishes.under_way())
            desk = ForgettingDesk(forgetter, data.forgettings, lambda _: "", lambda _: None)
        assert desk._work_on_one(desk._wishes.under_way())
        (said,) = [one for one in records.audit_entries(EVER) if one.action.startswith("Forgot")]
        return said.detail


def _fails(*_: object) -> None:
    raise StoreError("the disk is full")


def _third_segment() -> Callable[..., int]:
    done: list[Path] = []

    def rewrite(path: Path, redactor: Any, **more: Any) -> int:
        done.append(path)
        return rewrite_segment(path, redactor, **more) if len(done) < 3 else cast("int", _fails())

    return rewrite


BROKEN: dict[str, Callable[[Store, Records], tuple[Any, str, Any]]] = {
    "log": lambda _store, _records: (forgetter_module, "rewrite_segment", _third_segment()),
    "store": lambda _store, _records: (forgetter_module, "forget_in", _fails),
    "compact": lambda store, _records: (store, "compact", _fails),
    "audit": lambda _store, records: (records, "audit", _fails),
}


@pytest.fixture(scope="module")
def told(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = Story(tmp_path_factory.mktemp("told") / "station").folder
    _split(DataFolder(folder).log, 4)
    return folder


@pytest.mark.parametrize("cut_at", [["log"], ["store"], ["compact"], ["audit"], [*BROKEN]])
@pytest.mark.parametrize(("kind", "subject_id"), [("person", "p-77"), ("incident", "i1")])
def test_in_many_tries_the_same_goes_and_the_audit_says_the_same(
    tmp_path: Path, told: Path, kind: str, subject_id: str, cut_at: list[str]
) -> None:
    at_once, in_tries = (shutil.copytree(told, tmp_path / name) for name in ("once", "tries"))
    whole = forgotten_in_tries(at_once, kind, subject_id, [])
    assert forgotten_in_tries(in_tries, kind, subject_id, cut_at) == whole
    assert int(whole.split()[2]) > 10
    assert list(read_log(DataFolder(in_tries).log)) == list(read_log(DataFolder(at_once).log))
    left = [stored_in(folder) for folder in (at_once, in_tries)]
    for name in (ANA, BO):
        assert names_in(left[1], name) == names_in(left[0], name)
    assert (names_in(left[0], ANA) == []) == (kind == "person")  # who wears what beside it stays
    assert not begun_in(in_tries).exists()


def begun_in(folder: Path) -> Path:
    """Who was in an incident that is being forgotten."""
    return folder / "forgetting-begun.json"


def test_who_was_there_is_kept_until_all_is_gone_and_nobody_is_forgotten_by_halves(
    tmp_path: Path, told: Path
) -> None:
    folder = shutil.copytree(told, tmp_path / "station")
    data = DataFolder(folder)
    with Store(data.database) as store, pytest.MonkeyPatch.context() as patched:
        forgetter = forgetter_of(data, store, Records(store, SystemClock()))
        patched.setattr(forgetter_module, "forget_in", _fails)
        with pytest.raises(StoreError, match="full"):
            forgetter.incident("ada", "i1")
        assert begun_in(folder).stat().st_mode & 0o077 == 0
        assert ANA in begun_in(folder).read_text(encoding="utf-8")
        begun_in(folder).write_text("[", encoding="utf-8")
        with pytest.raises(StoreError, match="cannot be read"):
            forgetter.incident("ada", "i1")


@pytest.mark.parametrize("cut_at", [[], ["log"], ["audit"]])
def test_what_cannot_be_read_of_the_log_is_told(
    tmp_path: Path, told: Path, cut_at: list[str]
) -> None:
    """It goes with what is written anew: nobody takes that for whole as it was."""
    folder = shutil.copytree(told, tmp_path / "station")
    paths = segment_paths(DataFolder(folder).log)
    for path, chunk in ((paths[1], 1), (paths[-1], 0)):
        with SegmentReader(path) as reader:
            place = reader._contents.chunks[chunk].offset + 100
        content = bytearray(path.read_bytes())
        content[place] ^= 1
        path.write_bytes(content)
    detail = forgotten_in_tries(folder, "person", "p-77", cut_at)
    assert detail.count("Damaged") == 2, "each is told once"
    first, last = (detail.partition(path.name)[2].split(". ")[0] for path in (paths[1], paths[-1]))
    assert first.endswith("what could not be read of it is gone")
    assert last.endswith("it stays, whoever it tells of")
    wishes = msgspec.json.decode(DataFolder(folder).forgettings.read_bytes())
    assert paths[1].name in wishes[-1]["problem"]
    damage: list[str] = []
    list(read_log(DataFolder(folder).log, on_damage=damage.append))
    assert [paths[-1].name in one for one in damage] == [True]


def test_what_is_saved_is_removed_when_the_running_station_has_forgotten(
    tmp_path: Path, told: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """What it saves before that has everything in it."""
    data, happened = DataFolder(shutil.copytree(told, tmp_path / "station")), list[str]()

    class Acted(Future[ActionDone]):
        def result(self, timeout: float | None = None) -> ActionDone:
            assert timeout is not None
            happened.append("acted")
            return ActionDone("", 0, None)

    checkpoints = Checkpoints(data.checkpoints)
    monkeypatch.setattr(checkpoints, "clear", lambda: happened.append("cleared"))
    with Store(data.database) as store:
        Forgetter(
            ClosedLog(data.log), store, checkpoints, Records(store, SystemClock()), SystemClock(),
            NoPulls(), lambda _by, _action: Acted(),
        ).incident("ada", "i1")  # fmt: skip
        assert happened == ["acted", "acted", "cleared", "cleared"]
        monkeypatch.setattr(forgetter_module, "_ACTED_WITHIN_S", 0.0)
        with pytest.raises(StoreError, match="did not get to"):
            Forgetter(
                ClosedLog(data.log), store, checkpoints, Records(store, SystemClock()),
                SystemClock(), NoPulls(), lambda _by, _action: Future(),
            ).person("ada", "p-77")  # fmt: skip


def test_who_wore_nothing_and_is_gone_already_is_in_the_audit(tmp_path: Path) -> None:
    (tmp_path / "log").mkdir()
    with Store(tmp_path / "station.sqlite") as store:
        records = Records(store, SystemClock())
        forgetter = forgetter_of(DataFolder(tmp_path), store, records)
        person_id = Roster(store, SystemClock()).add_person(ANA, "", "").person_id
        with pytest.MonkeyPatch.context() as patched:
            patched.setattr(records, "audit", _fails)
            with pytest.raises(StoreError):
                forgetter.person("ada", person_id)
        with pytest.raises(UserError, match="knows a person"):
            forgetter.person("ada", person_id)
        forgetter.person("ada", person_id, tally=Tally(again=True))
        (entry,) = records.audit_entries(EVER)
    assert entry.detail == f"person {person_id}: 0 records of the log in 0 files"


def _split(folder: Path, parts: int) -> None:
    """The same log in more segments."""
    records = list(read_log(folder))
    for path in folder.iterdir():
        path.unlink()
    writer = SegmentWriter(folder, SegmentPolicy(chunk_bytes=4096))
    for number, record in enumerate(records):
        writer.write(*record)
        if (number + 1) % (len(records) // parts) == 0:
            writer.end_segment()
    writer.close()


def test_a_recording_that_is_being_pulled_does_not_come_back(tmp_path: Path) -> None:
    folder = DataFolder(tmp_path)
    asked: list[str] = []

    def ask(unit_id: str, question: str) -> bytes | None:
        asked.append(f"{unit_id} {question}")
        what, _, parameters = question.partition("?")
        told = dict(pair.split("=", 1) for pair in parameters.split(";"))
        if what == "index":
            file = RecordedFile("day/000001.mcap", 100_000_000)  # it lasts
            return RecordingIndex((file,), 1).to_bytes()
        offset, data = int(told["offset"]), b"somebody walked" * 50
        digest = hashlib.sha256(data).digest()
        return RecordingPiece(offset, data, digest, gone=False).to_bytes()

    def others() -> list[Path]:
        return [path for path in folder.recordings.rglob("*.mcap*") if path.is_file()]

    with RecordingDesk(ask, folder.recordings, SystemClock()) as pulls:
        pulls.add("ada", Wanted("FF-01", 1, 2))
        until(lambda: any(path.stat().st_size > 3000 for path in others()))
        with LiveStation(tmp_path) as station, Store(folder.database) as store:
            station.act(RegisterUnit("FF-01", "FF-01"))
            station.act(Assign("FF-01", "p-77", ANA, "", ""))
            station.act(Unassign("FF-01"))
            Forgetter(
                station.recorder, store, station.checkpoints, Records(store, SystemClock()),
                SystemClock(), pulls,
            ).person("ada", "p-77")  # fmt: skip
        assert not (folder.recordings / "FF-01").exists()
        until(lambda: not pulls._running)
        assert not (folder.recordings / "FF-01").exists()
        asked.clear()
    with RecordingDesk(ask, folder.recordings, SystemClock()) as again:
        (pull,) = again.pulls()
        assert (pull.state, pull.problem) == (FetchState.FAILED, "deleted: its wearer is forgotten")
    assert asked == []
    assert others() == []
