"""Station with closed incidents to be archived, and the commands of its archive."""

from __future__ import annotations

from contextlib import closing
from pathlib import Path

from typer.testing import CliRunner, Result

from base_station.app.factories import project_whole_log
from base_station.cli import app
from base_station.storage.db.known_people import KnownPerson
from base_station.storage.db.roster import Roster
from base_station.storage.db.store import Store
from shared.clock import SystemClock
from shared.errors import ArchiveError, ConfigError, UserError
from shared.mcap_log import SegmentPolicy, SegmentWriter
from shared.messages import EventKind
from shared.messages.station import Assign, CloseIncident, OpenIncident, SetPlan
from tests.rig.console_log import with_console
from tests.rig.live_station import make_pipeline
from tests.rig.round_walk import PLAN, Walk

PEOPLE = {
    "ada0": KnownPerson("Ada", "Engine 1", "officer"),
    "bo00": KnownPerson("Bo", "Engine 1", ""),
    "cy00": KnownPerson("Cy", "Engine 2", ""),
}
WALKED_S = 400  # three keyframes


def make_station(folder: Path) -> None:
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
    records = with_console(script.records, make_pipeline(None))
    with closing(SegmentWriter(folder / "log", SegmentPolicy(segment_s=60.0))) as log:
        for record in records:
            log.write(*record)
    with Store(folder / "station.sqlite") as store:
        project_whole_log(store, folder / "log", lambda _: None)
        Roster(store, SystemClock()).add_unknown_people(PEOPLE)


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
