"""Data folder with one closed incident of a person who walks a round."""

from __future__ import annotations

from contextlib import closing
from pathlib import Path

from base_station.app.factories import project_whole_log
from base_station.storage.db.known_people import KnownPerson
from base_station.storage.db.roster import Roster
from base_station.storage.db.store import Store
from shared.clock import SystemClock
from shared.geo import Anchor
from shared.mcap_log import SegmentWriter
from shared.messages.station import Assign, CloseIncident, SetAnchor
from tests.rig.imported_files import records_with_fused
from tests.rig.round_walk import Walk

ANCHOR = Anchor(52.0, 4.0, 0.0, 0.3)
ADA = KnownPerson("Ada Vos", "Engine 1", "")


def new_folder(folder: Path, name: str, incident_s: int = 60) -> Path:
    """Folder of a station with one closed incident of a person who walks a round."""
    walk = Walk("FF-01")
    script = walk.script
    script.act(SetAnchor(ANCHOR.lat_deg, ANCHOR.lon_deg, ANCHOR.height_m, ANCHOR.rotation_rad))
    script.act(Assign("FF-01", "ada0"))
    walk.start("FF-01")
    walk.go(incident_s)
    script.act(CloseIncident("i1"))
    records = records_with_fused(script)
    with closing(SegmentWriter(folder / "log")) as log:
        for t_ns, key, payload in records:
            log.write(t_ns, key, payload.replace(b"i1", name.encode()))
    with Store(folder / "station.sqlite") as store:
        project_whole_log(store, folder / "log", lambda _: None)
        Roster(store, SystemClock()).add_unknown_people({"ada0": ADA})
    return folder
