"""A log is cut where two stations diverged, and the records behind it are kept beside."""

from __future__ import annotations

import errno
from pathlib import Path

import pytest

from base_station.core.log_position import START, LogPosition
from base_station.engine.log_feed import FolderFeed
from base_station.standby.log_truncation import (
    APART,
    mark_merged,
    parts,
    read_part,
    set_aside,
)
from base_station.standby.shared_log import SharedLog
from base_station.storage.data_folder import DataFolder
from base_station.storage.recorder import Recorder
from shared.clock import SystemClock
from shared.mcap_log import segment_paths
from tests.rig.standby_logs import T0, TICKED, events, written


@pytest.mark.parametrize("kept", [0, 1, 7, 20])
def test_cut_log_holds_the_records_up_to_the_cut_and_the_rest_is_beside(
    tmp_path: Path, kept: int
) -> None:
    records = events(20)
    recorder = Recorder(tmp_path, SystemClock())
    written(recorder, SharedLog(recorder, SystemClock()), records)
    recorder.close()
    place = START
    for t_ns, _, _ in records[:kept]:
        place = place.next(t_ns)
    folder = DataFolder(tmp_path)
    set_aside(folder, place)
    left = list(FolderFeed(folder.log).records())
    assert [record for record in left if record[1] == TICKED] == records[:kept]
    assert len(left) == 2 * kept  # with its decisions
    (name,) = parts(tmp_path)
    assert list(read_part(tmp_path, name)) == records[kept:]
    mark_merged(tmp_path, name)
    assert parts(tmp_path) == []


def test_log_continues_behind_a_cut_and_may_be_cut_there_again(tmp_path: Path) -> None:
    records = events(9)
    for begin, apart in ((0, b"once"), (9, b"twice")):
        recorder = Recorder(tmp_path, SystemClock())
        strays = [(T0 + 10, TICKED, apart)]
        written(recorder, SharedLog(recorder, SystemClock()), records[begin:] + strays)
        recorder.close()
        set_aside(DataFolder(tmp_path), LogPosition(T0 + 7, 2))
    recorder = Recorder(tmp_path, SystemClock())
    written(recorder, SharedLog(recorder, SystemClock()), events(3, start=9))
    recorder.close()
    kept = [r for r in FolderFeed(tmp_path / "log").records() if r[1] == TICKED]
    assert kept == events(12)
    reported = [
        [payload for _, _, payload in read_part(tmp_path, name)] for name in parts(tmp_path)
    ]
    assert reported == [[b"once"], [b"twice"]]


def test_log_is_cut_between_two_events_of_one_time_though_a_segment_ends_there(
    tmp_path: Path,
) -> None:
    records = events(6)  # of which the last two have one time
    recorder = Recorder(tmp_path, SystemClock())
    written(recorder, SharedLog(recorder, SystemClock()), records)
    recorder.close()
    set_aside(DataFolder(tmp_path), LogPosition(T0 + 4, 1))
    kept = [r for r in FolderFeed(tmp_path / "log").records() if r[1] == TICKED]
    assert kept == records[:5]
    (name,) = parts(tmp_path)
    assert list(read_part(tmp_path, name)) == records[5:]


def test_set_aside_records_do_not_come_back_with_the_next_start(tmp_path: Path) -> None:
    """It was killed, and the repair of its log has the torn file beside it."""
    records = [*events(9), (T0 + 10**12, TICKED, b"apart"), (T0 + 10**12 + 1, TICKED, b"apart too")]
    recorder = Recorder(tmp_path, SystemClock())
    written(recorder, SharedLog(recorder, SystemClock()), records)
    recorder.close()
    *_, last = segment_paths(tmp_path / "log")
    with last.open("rb+") as torn:
        torn.truncate(last.stat().st_size - 10)
    Recorder(tmp_path, SystemClock()).close()
    set_aside(DataFolder(tmp_path), LogPosition(T0 + 7, 2))
    for _ in range(2):
        Recorder(tmp_path, SystemClock()).close()
        kept = [r for r in FolderFeed(tmp_path / "log").records() if r[1] == TICKED]
        assert kept == records[:9]
    (name,) = parts(tmp_path)
    assert list(read_part(tmp_path, name)) == records[9:]


def test_log_on_a_disk_of_its_own_is_cut_too(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """As where DATA/log is a mount, or a link to one."""
    folder, rename = DataFolder(tmp_path), Path.rename

    def rename_on_a_disk(path: Path, target: Path) -> Path:
        if path.is_relative_to(folder.log) != target.is_relative_to(folder.log):
            raise OSError(errno.EXDEV, "Invalid cross-device link")
        return rename(path, target)

    monkeypatch.setattr(Path, "rename", rename_on_a_disk)
    records = events(20)
    recorder = Recorder(tmp_path, SystemClock())
    written(recorder, SharedLog(recorder, SystemClock()), records)
    recorder.close()
    set_aside(folder, LogPosition(records[6][0], 1))
    kept = [record for record in FolderFeed(folder.log).records() if record[1] == TICKED]
    (name,) = parts(tmp_path)
    assert [*kept, *read_part(tmp_path, name)] == records
    assert len(kept) == 7
    assert [path.suffix for path in (tmp_path / APART / name).iterdir()] == [".mcap"]
    assert all(path.suffix == ".mcap" for path in folder.log.iterdir())
