"""Makes `folder.tar.xz`: the data folder of a station as commit 8f25b104 wrote it.

Run once, from a checkout of that commit, whose module names it has:
    PYTHONPATH=CHECKOUT python make.py
"""

# mypy: ignore-errors
# Reason: the modules are those of an older version; today's tree does not have them.

from __future__ import annotations

import math
import tarfile
import tempfile
from contextlib import ExitStack
from pathlib import Path

from base_station.db.accounts import Accounts
from base_station.db.models import Person
from base_station.db.records import Records
from base_station.db.roster import Roster
from base_station.db.store import Store
from tests.station_script import Record, Script

from base_station.accounts.principals import Role
from base_station.app import folder as station_app
from base_station.storage.data_folder import DataFolder
from shared.channels import channel_of
from shared.clock import SystemClock
from shared.codec import encode
from shared.mcap_log import SegmentPolicy, SegmentWriter
from shared.messages import STATION_ID, AlarmChange, EventKind, FusedPosition
from shared.messages.station import (
    AcknowledgeAlarm,
    Assign,
    CloseIncident,
    OpenIncident,
    ResolveAlarm,
    SetAnchor,
    SetStart,
)

SECONDS = 60


def incident() -> list[Record]:
    """Two units for a minute, one of which sends a mayday, with the station's decisions."""
    script = Script()
    records: list[Record] = []

    def note_new() -> None:
        records.extend(script.records)
        for output in script.outputs:
            if isinstance(output, AlarmChange | FusedPosition):
                key = channel_of(output).key(STATION_ID)
                records.append((output.header.t_utc_ns, key, encode(output)))
        script.records.clear()
        script.outputs.clear()

    script.register("FF-01", "FF-02")
    script.act(SetAnchor(52.0, 4.0, 10.0, 0.3))
    script.act(OpenIncident("i1", "Mill Lane", par_interval_s=600.0, work_limit_s=1200.0))
    for number, name in ((1, "Ana Horn"), (2, "Bo Lind")):
        script.act(Assign(f"FF-0{number}", f"p{number}", name, "red", "firefighter"))
    script.act(SetStart("FF-01", 5.0, 5.0, 0.0, 0.4, 0.5, 0.2))
    note_new()
    for second in range(SECONDS):
        script.now_s += 1.0
        angle = second / 20.0
        for unit_id in ("FF-01", "FF-02"):
            north_m, east_m = 20.0 * math.cos(angle) - 20.0, 20.0 * math.sin(angle)
            heading_rad = (angle + math.pi / 2.0) % (2.0 * math.pi)
            script.position(
                unit_id, north_m, east_m, distance_m=1.0 * second, heading_rad=heading_rad
            )
        script.status("FF-01")
        script.gps("FF-02", 52.0 + 18e-5 * math.cos(angle), 4.0 + 29e-5 * math.sin(angle))
        if second == 30:
            script.event("FF-01", EventKind.MAYDAY)
            alarm_id = script.alarms[0].alarm_id
        if second == 35:
            script.act(AcknowledgeAlarm(alarm_id))
        if second == 40:
            script.act(ResolveAlarm(alarm_id, "spoken to"))
        script.tick()
        note_new()
    script.act(CloseIncident("i1"))
    note_new()
    return records


def write(data: DataFolder) -> None:
    data.log.mkdir(parents=True)
    writer = SegmentWriter(data.log, SegmentPolicy())
    for number, record in enumerate(incident()):
        writer.write(*record)
        if number == 200:
            writer.end_segment()
    writer.close()
    station_app.rebuild(data.path, lambda _: None)
    with ExitStack() as closing:
        past = station_app.look_back(data.path, "i1", closing, print, lambda _: None)
        past.hindsight.smooth(past.incident)
        past.hindsight.assess(past.incident, past.records.tracks_of(past.incident))
    clock = SystemClock()
    with Store(data.database) as store:
        with store.write() as session:
            for person_id, name in (("p1", "Ana Horn"), ("p2", "Bo Lind")):
                session.add(
                    Person(person_id=person_id, name=name, crew="red", role="firefighter",
                           created_ns=1)
                )  # fmt: skip
        Roster(store, clock).set_photo("p1", b"a photo", "0123")
        accounts = Accounts(store, clock)
        accounts.add_user("chief", "a long password 17", Role.ADMINISTRATOR)
        accounts.add_user("gone", "a long password 18", Role.VIEWER)
        accounts.remove_user("gone")
        accounts.add_token("chief", "wall", Role.VIEWER, None, ())
        secret = accounts.log_in("chief", "a long password 17")
        assert secret is not None
        accounts.create_login_ticket(secret)
        Records(store, clock).audit("chief", "Login", "")
        store.compact()


if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as scratch:
        folder = Path(scratch) / "data"
        write(DataFolder(folder))
        with tarfile.open(Path(__file__).with_name("folder.tar.xz"), "w:xz") as tar:
            for path in sorted(folder.rglob("*")):
                if path.is_file() and path.suffix in {".mcap", ".sqlite"}:
                    print(path.relative_to(folder), path.stat().st_size)
                    tar.add(path, path.relative_to(folder))
