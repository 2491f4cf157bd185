"""Forgetting a person or an incident: no byte is left of them, and the others replay as before."""

from __future__ import annotations

import asyncio
import hashlib
import io
import shutil
from collections.abc import Collection, Iterator
from contextlib import ExitStack
from pathlib import Path

import msgspec
import pytest
from PIL import Image

from base_station.api.photos import clean_photo
from base_station.app import folder as station_app
from base_station.data_folder import DataFolder
from base_station.db.accounts import Role
from base_station.db.models import Person
from base_station.db.records import FOREVER_NS, Records, Window
from base_station.db.roster import Roster
from base_station.db.store import Store
from base_station.events import Received, event_of
from base_station.forgetting.forgetter import ClosedLog, Forgetter
from base_station.live_state import FORGOTTEN, Alarm
from base_station.past.checkpoints import Checkpoints
from base_station.recordings.desk import RecordingDesk
from base_station.recordings.fetch import FetchState, Wanted
from shared.channels import Direction, channel_of
from shared.clock import ManualClock, SystemClock
from shared.codec import encode
from shared.errors import UserError
from shared.mcap_log import SegmentReader, SegmentWriter, is_derived, read_log, segment_paths
from shared.messages import (
    EventKind,
    FusedPosition,
    Header,
    Heartbeat,
    OperatorAction,
    UnitEvent,
)
from shared.messages.pins import SetPin
from shared.messages.recording import RecordedFile, RecordingIndex, RecordingPiece
from shared.messages.station import (
    Assign,
    CloseIncident,
    OpenIncident,
    RegisterUnit,
    ResolveAlarm,
    SetAnchor,
    SetStart,
    Unassign,
)
from tests.live_station import LiveStation, make_pipeline
from tests.station import DeskStation
from tests.station_script import Script
from tests.waiting import until

ANA, BO, CEM = "Anastazja Kovač", "Bo Lind", "Cem Öz"


class Walker:
    """Somebody whose unit speaks; remembers what it said."""

    def __init__(self, station: LiveStation, unit_id: str) -> None:
        self._station = station
        self._unit_id = unit_id
        self._makes = Script()
        self.said: list[bytes] = []

    def walk(self, steps: int, east_m: float) -> None:
        for step in range(steps):
            self._makes.now_s += 0.2
            at = self._makes
            at.outputs.clear()
            at.records.clear()
            at.status(self._unit_id)
            at.position(self._unit_id, 0.731 * step, east_m)
            at.gps(self._unit_id, 52.0 + 1e-5 * step, 4.0)
            for _, key, payload in at.records:
                self.said.append(payload)
                self._station.feed.offer(key, payload)
        seq = self._makes.header(self._unit_id).seq - 1
        last = Header(self._unit_id, 7, seq, 0)
        until(lambda: self._station.pipeline.state.units[self._unit_id].has(last))

    def press_mayday(self) -> None:
        header = self._makes.header(self._unit_id)
        self._station.say(UnitEvent(header, EventKind.MAYDAY))
        until(lambda: any(a.unit_id == self._unit_id for a in self._alarms()))

    def _alarms(self) -> list[Alarm]:
        return list(self._station.pipeline.state.alarms.values())


def some_photo() -> bytes:
    picture = io.BytesIO()
    Image.effect_noise((320, 320), 80).save(picture, "PNG")
    return clean_photo(picture.getvalue())[0]


class Story:
    """A station's folder after an incident in which Ana and then Bo wore one unit."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.ana_said: list[bytes] = []
        self.photo = some_photo()
        with LiveStation(folder) as station:
            self._tell(station)
        station_app.rebuild(folder, lambda _: None)
        with Store(folder / "station.sqlite") as store:
            roster = Roster(store, SystemClock())
            for person_id, name in (("p-77", ANA), ("p-bo", BO)):
                _put_person(store, person_id, name)
            roster.set_photo("p-77", self.photo, "1234")
            Records(store, SystemClock()).audit("chief", "AddedPerson", f"p-77 {ANA}")
        self.before = list(read_log(folder / "log"))
        self._keep_copies()

    def _tell(self, station: LiveStation) -> None:
        for unit_id in ("FF-01", "FF-02"):
            station.act(RegisterUnit(unit_id, unit_id))
        station.act(SetAnchor(52.0, 4.0, 0.0, 0.0))
        station.act(Assign("FF-01", "p-77", ANA, "Engine 1", "Nozzle"))
        station.act(Assign("FF-02", "p-cem", CEM, "Engine 1", "Search"))
        station.act(OpenIncident("i1", "Mill Lane"))
        station.act(SetStart("FF-01", 1.0, 2.0, 0.0, 0.1, 0.5, 0.1))
        station.act(SetPin("pin-1", "FF-01", 0, 3.25, 4.5, 1.0, None, None, 0.3, f"{ANA} here"))
        shared, cem = Walker(station, "FF-01"), Walker(station, "FF-02")
        shared.walk(40, 7.125)
        shared.press_mayday()
        alarm = next(iter(station.pipeline.state.alarms.values()))
        station.act(ResolveAlarm(alarm.alarm_id, f"spoke with {ANA.upper()}"))
        self.ana_said, shared.said = shared.said[:], []
        station.act(Unassign("FF-01"))
        station.act(Assign("FF-01", "p-bo", BO, "Engine 2", "Search"))
        shared.walk(20, 9.0)
        cem.walk(40, 5.0)
        station.act(CloseIncident("i1"))
        station.act(Unassign("FF-01"))

    def _keep_copies(self) -> None:
        """A part of the log that was set aside, a torn segment and a unit's own recording."""
        (segment,) = segment_paths(self.folder / "log")
        for copy in ("aside/000001-20260101T000000Z.mcap", "recordings/FF-01/day/raw.mcap"):
            (self.folder / copy).parent.mkdir(parents=True)
            shutil.copy(segment, self.folder / copy)
        shutil.copy(segment, segment.with_name(segment.name + ".torn"))

    def stored(self) -> bytes:
        """Every byte in the folder, with what is packed in the log unpacked."""
        files = [path for path in sorted(self.folder.rglob("*")) if path.is_file()]
        parts = [path.read_bytes() for path in files]
        for path in sorted(self.folder.rglob("*.mcap*")):
            with SegmentReader(path) as reader:
                parts += [chunk.data for chunk in reader.intact_chunks()]
        return b"\0".join(parts)

    def events(self) -> list[Received]:
        events = [event_of(*record) for record in read_log(self.folder / "log")]
        return [event for event in events if isinstance(event, Received)]


def _put_person(store: Store, person_id: str, name: str) -> None:
    with store.write() as session:
        session.add(
            Person(
                person_id=person_id,
                name=name,
                crew="",
                role="",
                created_ns=1,
                photo=None,
                photo_hash=None,
            )
        )


@pytest.fixture
def story(tmp_path: Path) -> Story:
    return Story(tmp_path / "station")


def forget(story: Story, what: str) -> None:
    station_app.forget(story.folder, what, lambda _: None, lambda _: None)


def names_in(stored: bytes, name: str) -> list[str]:
    text = stored.decode("utf-8", "ignore").lower()
    return [part for part in (name.lower(), *name.lower().split()) if part in text]


def test_no_byte_is_left_of_a_person(story: Story) -> None:
    before = story.stored()
    assert names_in(before, ANA)
    assert any(piece in before for piece in pieces(story.photo))
    assert all(payload in before for payload in story.ana_said)

    forget(story, "p-77")

    after = story.stored()
    assert names_in(after, ANA) == []
    assert not any(piece in after for piece in pieces(story.photo))
    assert [payload for payload in story.ana_said if payload in after] == []
    of_bo = [one for one in fused_in(story) if one.unit_id == "FF-01"]
    assert of_bo
    assert len(of_bo) < len([one for one in fused_in(story) if one.unit_id == "FF-02"])
    actions = [e.message.action for e in story.events() if isinstance(e.message, OperatorAction)]
    assert not any(isinstance(action, SetPin | SetStart) for action in actions)


def pieces(photo: bytes) -> list[bytes]:
    """Short enough for some to stand within a page of the database."""
    return [photo[at : at + 60] for at in range(0, len(photo) - 60, 500)]


def fused_in(story: Story) -> list[FusedPosition]:
    return [e.message for e in story.events() if isinstance(e.message, FusedPosition)]


def test_the_others_stay_and_replay_the_same(story: Story) -> None:
    forget(story, ANA)  # by name

    kept = list(read_log(story.folder / "log"))
    others = [one for one in story.before if "/FF-02/" in one[1]]
    assert [one for one in kept if "/FF-02/" in one[1]] == others
    logged = [one for one in fused_in(story) if one.unit_id == "FF-02"]
    pipeline = make_pipeline()
    replayed = [
        output
        for record in kept
        for output in pipeline.step(event_of(*record))
        if isinstance(output, FusedPosition)
    ]
    assert [_bare(one) for one in replayed if one.unit_id == "FF-02"] == list(map(_bare, logged))
    assert pipeline.state.incident is not None


def _bare(fused: FusedPosition) -> bytes:
    """Decisions are numbered; that there are fewer of them is seen."""
    return encode(msgspec.structs.replace(fused, header=Header("station", 0, 0, 0)))


def test_what_was_forgotten_is_not_fetched_from_the_unit_again(story: Story) -> None:
    forget(story, "p-77")
    again = make_pipeline()
    for record in read_log(story.folder / "log"):
        again.step(event_of(*record))
    before = make_pipeline()
    for record in story.before:
        before.step(event_of(*record))
    for unit_id in ("FF-01", "FF-02"):
        seen = [boot.seen for boot in again.state.units[unit_id].boots]
        assert seen
        assert seen == [boot.seen for boot in before.state.units[unit_id].boots]


def test_the_audit_keeps_who_did_what(story: Story) -> None:
    forget(story, "p-77")
    with Store(story.folder / "station.sqlite") as store:
        records = Records(store, SystemClock())
        audit = records.audit_entries(FOREVER_NS, 1000)
        said = [(entry.by, entry.action) for entry in audit]
        everything = Window(0, FOREVER_NS)
        assert records.track("FF-02", everything)
        (mayday,) = [one for one in records.alarms(everything) if one.rule == "mayday"]
        roster = Roster(store, SystemClock())
        assert roster.person("p-77") is None
        assert roster.photo("p-77") is None
        worn = {one.person_id: one.person_name for one in roster.assignments(0, FOREVER_NS)}
    for action in ("Assign", "SetPin", "ResolveAlarm", "AddedPerson"):
        assert ("chief", action) in said
    assert ("muster base forget", "ForgotPerson") in said
    assert mayday.text == FORGOTTEN
    assert mayday.state == "resolved"
    assert worn == {"p-77": FORGOTTEN, "p-bo": BO, "p-cem": CEM}


def test_the_tables_made_again_from_the_log_know_no_more(story: Story) -> None:
    forget(story, "p-77")
    station_app.rebuild(story.folder, lambda _: None)
    assert names_in(story.stored(), ANA) == []
    with Store(story.folder / "station.sqlite") as store:
        roster = Roster(store, SystemClock())
        worn = {one.person_id: one.person_name for one in roster.assignments(0, FOREVER_NS)}
        tracked = Records(store, SystemClock()).track_units(Window(0, FOREVER_NS))
    assert worn == {"p-77": FORGOTTEN, "p-bo": BO, "p-cem": CEM}
    assert list(tracked) == ["FF-01", "FF-02"]


def test_an_incident_is_forgotten_with_everybody_in_it(story: Story) -> None:
    forget(story, "i1")
    after = story.stored()
    assert [payload for payload in story.ana_said if payload in after] == []
    said = [one.message for one in story.events()]
    assert {type(one) for one in said if channel_of(one).direction is Direction.UP} == {Heartbeat}
    assert fused_in(story) == []
    pipeline = make_pipeline()
    worn = []
    for record in read_log(story.folder / "log"):
        pipeline.step(event_of(*record))
        if pipeline.state.incident is not None and pipeline.state.incident.closed_ns is None:
            worn += [unit.person for unit in pipeline.state.units.values() if unit.person]
    assert worn == []
    assert pipeline.state.units["FF-02"].person is not None  # as it was afterwards
    with Store(story.folder / "station.sqlite") as store:
        records = Records(store, SystemClock())
        incident = records.incident("i1")
        assert incident is not None
        assert incident.closed_ns is not None
        window = Window(incident.opened_ns, incident.closed_ns)
        assert list(records.track_units(window)) == []
        during = Roster(store, SystemClock()).assignments(window.from_ns, window.until_ns)
        assert list(during) == []
        texts = [one.text for one in records.alarms(window) if one.unit_id]
    assert set(texts) == {FORGOTTEN}


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
            lambda by, action: station.act(action, by),
        )  # fmt: skip
        station.act(RegisterUnit("FF-01", "FF-01"))
        station.act(Assign("FF-01", "p-77", ANA, "", ""))
        walker = Walker(station, "FF-01")
        walker.walk(10, 3.0)
        walker.press_mayday()
        station.act(Unassign("FF-01"))
        forgetter.person("admin", "p-77")
        unit = station.pipeline.state.units["FF-01"]
        assert unit.trail == []
        assert unit.fused is None
        saved = station.pipeline.checkpoint()
        assert ANA.encode() not in saved
        station.act(RegisterUnit("FF-02", "FF-02"))  # the log goes on
        assert len(station.recorder.segments()) == 2
    assert len(list(read_log(folder.log))) > 10
    text = b"".join(payload for _, _, payload in read_log(folder.log)).decode("utf-8", "ignore")
    assert ANA not in text
    for path in folder.checkpoints.glob("*.checkpoint"):
        found = station.checkpoints.latest(int(path.stem))
        assert ANA.encode() not in msgspec.msgpack.encode(found)


def test_an_open_incident_and_a_stranger_are_refused(story: Story) -> None:
    with pytest.raises(UserError, match="knows a person"):
        forget(story, "p-nobody")
    with LiveStation(story.folder) as station:
        station.act(OpenIncident("i2", "Another"))
    station_app.rebuild(story.folder, lambda _: None)
    with pytest.raises(UserError, match="open"):
        forget(story, "i2")


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


def test_a_name_is_found_whatever_holds_it(story: Story) -> None:
    """Every kind of record that can hold a text is in the story."""
    kinds = {key for _, key, payload in story.before if ANA.encode() in payload}
    assert any("operator" in key for key in kinds)
    assert any("alarm" in key for key in kinds)
    with SegmentReader(segment_paths(story.folder / "log")[0]) as reader:
        derived = [key for _, key, payload in reader.records(derived=True) if is_derived(key)]
    assert derived
    assert encode(Heartbeat(Header("FF-01", 1, 1, 1), 0, 0))


class PowerCut(BaseException):
    """In the middle of forgetting."""


def test_cut_short_anywhere_and_done_again_no_byte_is_left(story: Story) -> None:
    """The log goes segment by segment, and the tables after it."""
    data = DataFolder(story.folder)
    _split(data.log, 4)
    whole = sum(1 for _ in read_log(data.log))
    cuts = 0
    with Store(data.database) as store:
        records = Records(store, SystemClock())
        forgetter = Forgetter(
            ClosedLog(data.log), store, Checkpoints(data.checkpoints), records, SystemClock(),
            NoPulls(),
        )  # fmt: skip

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


def _split(folder: Path, parts: int) -> None:
    """The same log in more segments."""
    records = list(read_log(folder))
    for path in folder.iterdir():
        path.unlink()
    writer = SegmentWriter(folder)
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
