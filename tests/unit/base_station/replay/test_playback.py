"""Seeking in the log, from a saved state or from the beginning."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

import pytest

from base_station.replay.playback import Archive, Playback
from base_station.storage.checkpoints import Checkpoints
from shared.clock import NS_PER_S
from tests.rig.live_station import make_pipeline
from tests.rig.logged_walk import archive, walk_with_mayday
from tests.rig.station_script import START_NS, Record


def test_checkpoint_on_the_way_gives_the_same_picture(tmp_path: Path) -> None:
    plain = Playback(archive(walk_with_mayday(), tmp_path / "none"))
    source = archive(walk_with_mayday(), tmp_path / "some")
    saving = Playback(source)
    for second in (40, 80):
        for _ in saving.seek(START_NS + second * NS_PER_S):
            pass
        at_ns = saving.pipeline.state.t_ns
        events = sum(record[0] == at_ns for record in walk_with_mayday())
        source.checkpoints.save(at_ns, events, saving.pipeline.checkpoint())
    opened: list[int] = []

    def counting(t_ns: int) -> Iterable[Record]:
        opened.append(t_ns)
        return source.open_log(t_ns)

    quick = Playback(Archive(counting, source.checkpoints, make_pipeline))
    for second in (100, 60, 20, 110):
        target_ns = START_NS + second * NS_PER_S
        for playback in (plain, quick):
            for _ in playback.seek(target_ns):
                pass
        assert quick.pipeline.checkpoint() == plain.pipeline.checkpoint()
    assert max(opened) == START_NS + 80 * NS_PER_S


def test_damaged_checkpoint_only_costs_time(tmp_path: Path) -> None:
    source = archive(walk_with_mayday(), tmp_path)
    for _ in (saving := Playback(source)).seek(START_NS + 40 * NS_PER_S):
        pass
    source.checkpoints.save(START_NS + 40 * NS_PER_S, 2, saving.pipeline.checkpoint())
    (path,) = tmp_path.iterdir()
    for damaged in (path.read_bytes()[:-10], b"", path.read_bytes()[::-1]):
        path.write_bytes(damaged)
        assert source.checkpoints.latest() is None
        again = Playback(source)
        for _ in again.seek(START_NS + 60 * NS_PER_S):
            pass
        assert again.pipeline.state.units["FF-01"].position is not None


def test_checkpoint_of_another_log_is_left_out(tmp_path: Path) -> None:
    source = archive(walk_with_mayday(), tmp_path)
    for _ in (saving := Playback(source)).seek(START_NS + 40 * NS_PER_S):
        pass
    state = saving.pipeline.checkpoint()
    source.checkpoints.save(START_NS + 40 * NS_PER_S, 2, state)
    mine = source.latest()
    assert mine is not None
    source.checkpoints.save(
        START_NS + 50 * NS_PER_S, 3, state
    )  # of a log with one more event there
    source.checkpoints.save(START_NS + 60 * NS_PER_S + 1, 1, state)
    source.checkpoints.save(START_NS + 900 * NS_PER_S, 1, state)  # the log was put back
    assert source.latest() == mine
    assert source.latest(START_NS + 60 * NS_PER_S + 1) == mine
    assert source.latest(after_ns=START_NS + 40 * NS_PER_S) is None
    for _ in (again := Playback(source)).seek(START_NS + 100 * NS_PER_S):
        pass
    assert again.pipeline.state.t_ns == START_NS + 100 * NS_PER_S


def test_checkpoints_of_another_program_do_not_send_a_seek_back(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    source = archive(walk_with_mayday(), tmp_path)
    for _ in (saving := Playback(source)).seek(START_NS + 80 * NS_PER_S):
        pass
    source.checkpoints.save(START_NS + 80 * NS_PER_S, 2, saving.pipeline.checkpoint())
    monkeypatch.setattr("base_station.storage.checkpoints.program_checksum", lambda: 7)
    opened: list[int] = []

    def counting(t_ns: int) -> Iterable[Record]:
        opened.append(t_ns)
        return source.open_log(t_ns)

    again = Playback(Archive(counting, Checkpoints(tmp_path), make_pipeline))
    for second in (40, 90, 100):
        for _ in again.seek(START_NS + second * NS_PER_S):
            pass
    assert opened == [0]


def test_passed_states_are_not_stepped_again(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Without a usable checkpoint of the station, seeking back is as quick."""
    monkeypatch.setattr("base_station.replay.playback.SAVED_APART", 20)
    monkeypatch.setattr("base_station.replay.playback.BURST", 7)  # ends amid those of one time
    plain = Playback(archive(walk_with_mayday(), tmp_path / "none"))
    source, own = archive(walk_with_mayday(), tmp_path / "theirs"), Checkpoints(tmp_path / "own")
    opened: list[int] = []

    def counting(t_ns: int) -> Iterable[Record]:
        opened.append(t_ns)
        return source.open_log(t_ns)

    past = Archive(counting, source.checkpoints, make_pipeline, own=own)
    playback = Playback(past)
    saved = 0
    for second in (100, 80, 40, 100, 79, 110, 60):
        for one in (plain, playback):
            for _ in one.seek(START_NS + second * NS_PER_S):
                pass
        assert playback.pipeline.checkpoint() == plain.pipeline.checkpoint()
        if second == 80:
            assert opened[-1] > START_NS + 60 * NS_PER_S
            saved = len(list((tmp_path / "own").iterdir()))
    assert saved > 3
    assert list((tmp_path / "theirs").iterdir()) == []
    assert len(list((tmp_path / "own").iterdir())) <= saved + 2  # each stretch has its own


def test_disk_that_refuses_states_only_costs_time(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("base_station.replay.playback.SAVED_APART", 20)
    reported: list[str] = []
    source = archive(walk_with_mayday(), tmp_path / "theirs")
    own = Checkpoints(tmp_path / "own", reported.append)

    def refuse(*_: object) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(own, "save", refuse)
    playback = Playback(Archive(source.open_log, source.checkpoints, make_pipeline, own=own))
    for second in (100, 40):
        for _ in playback.seek(START_NS + second * NS_PER_S):
            pass
        assert playback.pipeline.state.t_ns == START_NS + second * NS_PER_S
    (stated,) = reported
    assert "No space left on device" in stated
