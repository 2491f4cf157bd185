"""A station's folder with people in it, some of whom are to be forgotten."""

from __future__ import annotations

import io
import shutil
from pathlib import Path

from PIL import Image

from base_station.api.images import normalize_photo
from base_station.app import folder_commands as station_app
from base_station.core.events import Received, event_of
from base_station.core.person_references import with_references
from base_station.core.state import Alarm
from base_station.storage.db.models import PersonRow
from base_station.storage.db.records import Records
from base_station.storage.db.roster import Roster
from base_station.storage.db.store import Store
from shared.clock import SystemClock
from shared.mcap_log import SegmentReader, read_log, segment_paths
from shared.messages import (
    EventKind,
    Header,
    UnitEvent,
)
from shared.messages.pins import SetPin
from shared.messages.station import (
    Action,
    Assign,
    CloseIncident,
    OpenIncident,
    RegisterUnit,
    ResolveAlarm,
    SetAnchor,
    SetStart,
    Unassign,
)
from tests.rig.live_station import LiveStation
from tests.rig.station_script import Script
from tests.rig.waiting import until

ANA, BO, CEM = "Anastazja Kovač", "Bo Lind", "Cem Öz"
PEOPLE = {"p-77": ANA, "p-bo": BO, "p-cem": CEM}


class Walker:
    """Somebody whose unit speaks; remembers what it said."""

    def __init__(self, station: LiveStation, unit_id: str) -> None:
        self._station = station
        self._unit_id = unit_id
        self._makes = Script()
        self.stated: list[bytes] = []

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
                self.stated.append(payload)
                self._station.feed.offer(key, payload)
        seq = self._makes.header(self._unit_id).seq - 1
        last = Header(self._unit_id, 7, seq, 0)
        until(lambda: self._station.pipeline.state.units[self._unit_id].has(last.boot_id, last.seq))

    def press_mayday(self) -> None:
        header = self._makes.header(self._unit_id)
        self._station.publish(UnitEvent(header, EventKind.MAYDAY))
        until(lambda: any(a.unit_id == self._unit_id for a in self._alarms()))

    def _alarms(self) -> list[Alarm]:
        return list(self._station.pipeline.state.alarms.values())


def some_photo() -> bytes:
    picture = io.BytesIO()
    Image.effect_noise((320, 320), 80).save(picture, "PNG")
    return normalize_photo(picture.getvalue())[0]


class ErasureScenario:
    """A station's folder after an incident in which Ana and then Bo wore one unit.

    ``older``: with names in the log, as earlier versions wrote it.
    """

    def __init__(self, folder: Path, *, older: bool = True) -> None:
        self.folder = folder
        self._older = older
        self.ana_stated: list[bytes] = []
        self.photo = some_photo()
        with LiveStation(folder) as station:
            self._tell(station)
        station_app.rebuild(folder, lambda _: None)
        with Store(folder / "station.sqlite") as store:
            roster = Roster(store, SystemClock())
            for person_id, name in PEOPLE.items():
                put_person(store, person_id, name)
            roster.read_again()
            roster.set_photo("p-77", self.photo, "1234")
            Records(store, SystemClock()).audit(
                "chief", "AddedPerson", f"p-77 {ANA}" if self._older else "p-77"
            )
        self.before = list(read_log(folder / "log"))
        self._keep_copies()

    def _tell(self, station: LiveStation) -> None:
        def act(action: Action) -> None:
            station.act(self._recorded(action))

        for unit_id in ("FF-01", "FF-02"):
            act(RegisterUnit(unit_id, unit_id))
        act(SetAnchor(52.0, 4.0, 0.0, 0.0))
        act(Assign("FF-01", "p-77", ANA, "Engine 1", "Nozzle"))
        act(Assign("FF-02", "p-cem", CEM, "Engine 1", "Search"))
        act(OpenIncident("i1", "Mill Lane"))
        act(SetStart("FF-01", 1.0, 2.0, 0.0, 0.1, 0.5, 0.1))
        act(SetPin("pin-1", "FF-01", 0, 3.25, 4.5, 1.0, None, None, 0.3, f"{ANA} here"))
        shared, cem = Walker(station, "FF-01"), Walker(station, "FF-02")
        shared.walk(40, 7.125)
        shared.press_mayday()
        alarm = next(iter(station.pipeline.state.alarms.values()))
        act(ResolveAlarm(alarm.alarm_id, f"spoke with {ANA.upper()}"))
        self.ana_stated, shared.stated = shared.stated[:], []
        act(Unassign("FF-01"))
        act(Assign("FF-01", "p-bo", BO, "Engine 2", "Search"))
        shared.walk(20, 9.0)
        cem.walk(40, 5.0)
        act(CloseIncident("i1"))
        act(Unassign("FF-01"))

    def _recorded(self, action: Action) -> Action:
        """The action as it goes into the log."""
        if self._older:
            return action
        if isinstance(action, Assign):
            return Assign(action.unit_id, action.person_id)
        return with_references(action, {name: person_id for person_id, name in PEOPLE.items()})

    def _keep_copies(self) -> None:
        """A part of the log that was set aside, a torn segment and a unit's own recording."""
        (segment,) = segment_paths(self.folder / "log")
        for copy in ("aside/000001-20260101T000000Z.mcap", "recordings/FF-01/day/raw.mcap"):
            (self.folder / copy).parent.mkdir(parents=True)
            shutil.copy(segment, self.folder / copy)
        shutil.copy(segment, segment.with_name(segment.name + ".torn"))

    def stored(self) -> bytes:
        return stored_in(self.folder)

    def events(self) -> list[Received]:
        events = [event_of(*record) for record in read_log(self.folder / "log")]
        return [event for event in events if isinstance(event, Received)]


def stored_in(folder: Path) -> bytes:
    """Every byte in the folder, with what is packed in the log unpacked.

    Packed bytes that can be unpacked are left out: any short name is in them by chance.
    """
    return b"\0".join(map(_unpacked, filter(Path.is_file, sorted(folder.rglob("*")))))


def _unpacked(path: Path) -> bytes:
    content = path.read_bytes()
    if ".mcap" in path.suffixes:
        with SegmentReader(path) as reader:
            for chunk in reader.intact_chunks():
                content = content.replace(chunk.record, chunk.data)
    return content


def put_person(store: Store, person_id: str, name: str) -> None:
    with store.write() as session:
        session.add(
            PersonRow(
                person_id=person_id,
                name=name,
                crew="",
                role="",
                created_ns=1,
                photo=None,
                photo_hash=None,
            )
        )


def forget(scenario: ErasureScenario, what: str) -> None:
    station_app.forget(scenario.folder, what, lambda _: None, lambda _: None)


def names_in(stored: bytes, name: str) -> list[str]:
    text = stored.decode("utf-8", "ignore").lower()
    return [part for part in (name.lower(), *name.lower().split()) if part in text]
