"""Tables of a log without a database, made while its replay runs."""

from __future__ import annotations

from contextlib import ExitStack, closing
from pathlib import Path

import psutil
import pytest

from base_station.app.factories import project_whole_log
from base_station.app.offline_log import OfflineLog, open_offline_log
from base_station.app.tables_from_log import TablesFromLog
from base_station.storage.db.records import Records
from base_station.storage.db.store import Store
from base_station.storage.db.window import FOREVER_NS, Window
from shared.clock import SystemClock
from shared.errors import StoreError
from shared.mcap_log import SegmentWriter
from shared.messages.station import CloseIncident
from tests.rig.round_walk import Walk
from tests.rig.waiting import until

pytestmark = pytest.mark.slow  # a process makes the tables
_ALWAYS = Window(0, FOREVER_NS)


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A log alone: two units walk for a minute."""
    walk = Walk("FF-01", "FF-02", turn_rad=0.5)
    for unit_id in walk.units:
        walk.start(unit_id)
    walk.go(60)
    walk.script.act(CloseIncident("i1"))
    with closing(SegmentWriter(tmp_path / "given" / "log")) as log:
        for record in walk.script.records:
            log.write(*record)
    return tmp_path / "given"


def _opened(folder: Path, stack: ExitStack) -> OfflineLog:
    return open_offline_log(
        folder,
        "i1",
        stack,
        lambda _: None,
        lambda _: None,
        in_place=False,
        decides_again=False,
        tables_later=True,
    )


def test_tables_are_refused_until_the_whole_log_is_in_them(folder: Path, tmp_path: Path) -> None:
    announced: list[str] = []
    with ExitStack() as stack:
        offline_log = _opened(folder, stack)
        assert offline_log.lacks_tables
        records = Records(offline_log.store, SystemClock())
        assert records.require_incident("i1").closed_ns is not None
        assert records.track("FF-01", _ALWAYS) == []
        tables = TablesFromLog(offline_log, announced.append)
        with pytest.raises(StoreError, match="being made from its log"):
            tables.flush_soon()
        assert tables.flush_actions_soon()(), "the console shows which incident it replays"
        with tables:
            until(tables.flush, "the tables are complete")
            assert tables.flush_soon()()
            made = {one: records.track(one, _ALWAYS) for one in ("FF-01", "FF-02")}
            assert [one.name for one in records.segments()] == [
                path.name for path in (folder / "log").glob("*.mcap")
            ]
    assert announced == ["the lists of the incident are made from its log: all can be read"]
    with Store(tmp_path / "whole.sqlite") as store:
        project_whole_log(store, folder / "log", lambda _: None)
        whole = Records(store, SystemClock())
        assert made == {one: whole.track(one, _ALWAYS) for one in made}
        assert all(len(track) > 50 for track in made.values())


def test_reason_is_given_where_the_tables_cannot_be_made(folder: Path) -> None:
    announced: list[str] = []
    with ExitStack() as stack:
        offline_log = _opened(folder, stack)
        offline_log.database.unlink()
        offline_log.database.mkdir()
        tables = TablesFromLog(offline_log, announced.append)
        with tables:
            until(lambda: bool(announced), "the process has failed")
            with pytest.raises(StoreError, match="could not be made from its log: "):
                tables.flush_soon()
            assert not tables.flush()


def test_process_ends_with_the_replay(folder: Path) -> None:
    def children() -> set[psutil.Process]:
        return set(psutil.Process().children(recursive=True))

    before = children()
    with ExitStack() as stack:
        with TablesFromLog(_opened(folder, stack), lambda _: None):
            until(lambda: children() - before, "the process has begun")
        assert children() <= before
