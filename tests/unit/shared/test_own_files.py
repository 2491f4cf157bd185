"""Files that root makes in a station's folder belong to the folder's owner, as whom the station
runs.
"""

from __future__ import annotations

import os
import stat
from collections.abc import Callable
from pathlib import Path

import pytest

from base_station.app.backup import back_up
from base_station.core.log_position import START
from base_station.standby.log_truncation import set_aside
from base_station.storage.checkpoints import Checkpoints
from base_station.storage.data_folder import DataFolder
from base_station.storage.db.models import LogSegment
from base_station.storage.db.records import Records
from base_station.storage.db.store import Store
from base_station.unit_sync.recordings.transfer import TransferState
from shared.clock import ManualClock
from shared.mcap_log import SegmentWriter, recover_log, rewrite_segment, segment_paths
from shared.own_files import make_folder
from tests.rig.changing_recordings import RecordingsUnit
from tests.rig.recorded_unit import finish
from tests.rig.small_log import KEY, T0_NS

STATION = 12345

root_alone = pytest.mark.skipif(os.geteuid() != 0, reason="only root can give files away")


def write_log(data: Path) -> None:
    writer = SegmentWriter(DataFolder(data).log)
    writer.write(T0_NS, KEY, b"said", urgent=True)
    writer.close()


def mend_log(data: Path) -> None:
    write_log(data)
    (path,) = segment_paths(DataFolder(data).log)
    path.write_bytes(path.read_bytes()[:-10])
    assert recover_log(path.parent)


def rewrite_log(data: Path) -> None:
    write_log(data)
    (path,) = segment_paths(DataFolder(data).log)
    assert rewrite_segment(path, lambda record: [(record[0], record[1], b"forgotten")])


def cut_log(data: Path) -> None:
    write_log(data)
    set_aside(DataFolder(data), START)


def hold(data: Path) -> None:
    DataFolder(data).lock().close()


def save_state(data: Path) -> None:
    Checkpoints(DataFolder(data).checkpoints).save(T0_NS, 1, b"state")


def fill_database(data: Path) -> None:
    with Store(DataFolder(data).database) as store:
        Records(store, ManualClock()).put_segments(
            [LogSegment(name="1", first_ns=1, last_ns=2, messages=1, size_bytes=6, note="")]
        )
        left = {path.name for path in data.iterdir() if path.stat().st_uid == STATION}
        assert left == {"station.sqlite", "station.sqlite-wal", "station.sqlite-shm"}


def pull_recording(data: Path) -> None:
    fetch = finish(RecordingsUnit(one=b"samples").pull(DataFolder(data).recordings))
    assert fetch.state is TransferState.DONE


def make_backup(data: Path) -> None:
    """Into a folder of the station's user, from anybody's."""
    source = data.parent / "of root"
    write_log(source)
    with Store(source / "station.sqlite"):
        back_up(source, data, lambda _: None)


@pytest.mark.slow
@root_alone
@pytest.mark.parametrize(
    "act",
    [
        write_log,
        mend_log,
        rewrite_log,
        cut_log,
        hold,
        save_state,
        fill_database,
        pull_recording,
        make_backup,
    ],
)
def test_files_made_by_root_belong_to_the_station(
    tmp_path: Path, act: Callable[[Path], None]
) -> None:
    data = tmp_path / "station"
    data.mkdir()
    os.chown(data, STATION, STATION)
    act(data)
    made = list(data.rglob("*"))
    assert made
    assert {(one.stat().st_uid, one.stat().st_gid) for one in made} == {(STATION, STATION)}, made


def test_a_database_is_its_owners_alone_anyone_may_read_new_files(tmp_path: Path) -> None:
    """It holds people's names and photos, and what passwords are checked by."""
    before = os.umask(0)
    try:
        with Store(tmp_path / "station.sqlite"):
            modes = {path.name: stat.S_IMODE(path.stat().st_mode) for path in tmp_path.iterdir()}
    finally:
        os.umask(before)
    assert modes["station.sqlite"] == 0o600
    assert set(modes.values()) == {0o600}


def test_a_folder_is_made_with_those_around_it_and_no_file_is_taken_for_one(tmp_path: Path) -> None:
    for _ in range(2):
        make_folder(tmp_path / "a" / "b", 0o700)
    assert stat.S_IMODE((tmp_path / "a" / "b").stat().st_mode) == 0o700
    (tmp_path / "file").touch()
    with pytest.raises(FileExistsError):
        make_folder(tmp_path / "file")
