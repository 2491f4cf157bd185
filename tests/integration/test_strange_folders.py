"""A station's folder in which the parts are not of one kin: said in a sentence, nothing mixed."""

from __future__ import annotations

import shutil
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path

import pytest

from base_station.app import folder as station_folder
from base_station.app.disk import Disk, open_disk
from base_station.standby.places import Place
from base_station.storage.data_folder import DataFolder
from base_station.storage.recorder import Recorder
from shared.clock import ManualClock
from shared.errors import LogError, StoreError
from shared.messages.station import OpenIncident
from tests.station_script import START_NS, Script


def record(data: Path, incident: str) -> None:
    """A station has run here, and its log is all that is left."""
    script = Script()
    script.now_s = float(len(incident))  # each at a time of its own
    script.register("anna")
    script.act(OpenIncident(incident, incident))
    recorder = Recorder(data, ManualClock(START_NS))
    for one in script.records:
        recorder.write(*one)
    recorder.close()


@contextmanager
def opened(data: Path, said: list[str] | None = None) -> Iterator[Disk]:
    clock = ManualClock(START_NS)
    with ExitStack() as closing:
        recorder = Recorder(data, clock)
        closing.callback(recorder.close)
        tell = (said if said is not None else []).append
        yield open_disk(DataFolder(data), recorder, clock, tell, closing)


def incidents(data: Path) -> list[str]:
    with opened(data) as disk:
        return [one.name for one in disk.records.incidents()]


@pytest.mark.parametrize("left", [None, b""])
def test_a_database_that_is_gone_or_empty_is_made_again(tmp_path: Path, left: bytes | None) -> None:
    record(tmp_path, "Mill Lane")
    if left is not None:
        (tmp_path / "station.sqlite").write_bytes(left)
    said: list[str] = []
    for _ in range(2):
        with opened(tmp_path, said) as disk:
            assert [one.name for one in disk.records.incidents()] == ["Mill Lane"]
    assert len(said) == 1, "once"
    assert "made again from the log" in said[0]


def test_what_was_cut_short_while_it_was_made_is_made_again(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    record(tmp_path, "Mill Lane")

    def killed(*_: object) -> int:
        raise KeyboardInterrupt

    with monkeypatch.context() as cut:
        cut.setattr("base_station.app.parts.project_log", killed)
        for begin in (lambda: incidents(tmp_path), lambda: rebuild(tmp_path)):
            with pytest.raises(KeyboardInterrupt):
                begin()
    assert incidents(tmp_path) == ["Mill Lane"]


def rebuild(data: Path) -> None:
    station_folder.rebuild(data, lambda _: None)


def test_a_log_that_is_not_cut_in_the_end_leaves_nothing_of_it_unknown(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    record(tmp_path, "Mill Lane")
    assert incidents(tmp_path) == ["Mill Lane"]

    def full(*_: object) -> None:
        raise LogError("the disk is full")

    monkeypatch.setattr("base_station.app.folder.set_aside", full)
    with pytest.raises(LogError):
        station_folder.cut_log(tmp_path, Place(START_NS, 1), lambda _: None)
    assert incidents(tmp_path) == ["Mill Lane"]


def test_the_database_of_another_log_is_refused_and_kept(tmp_path: Path) -> None:
    one, other = tmp_path / "one", tmp_path / "other"
    for data, name in ((one, "Mill Lane"), (other, "Dock Road West")):
        record(data, name)
        assert incidents(data) == [name]
    shutil.copy(one / "station.sqlite", other / "station.sqlite")
    with pytest.raises(StoreError, match=r"is of another log.*move it away"):
        incidents(other)
    (other / "station.sqlite").replace(one / "station.sqlite")
    assert incidents(one) == ["Mill Lane"], "nothing of the other one came into it"
    assert incidents(other) == ["Dock Road West"]


def test_a_log_of_which_old_segments_were_moved_away_is_no_other(tmp_path: Path) -> None:
    record(tmp_path, "Mill Lane")
    record(tmp_path, "Dock Road West")
    before = incidents(tmp_path)
    first, _ = sorted((tmp_path / "log").glob("*.mcap"))
    first.unlink()
    assert incidents(tmp_path) == before
