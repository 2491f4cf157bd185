"""The folder of checkpoints stays small: recent ones close together, older ones minutes apart."""

from __future__ import annotations

from itertools import pairwise
from pathlib import Path
from threading import Thread

import pytest

from base_station.storage.checkpoints import (
    KEPT_CLOSE,
    KEPT_FAR,
    SPARSE_NS,
    Checkpoints,
    _checksum_of,
)
from shared.clock import NS_PER_S
from tests.rig.live_station import make_pipeline

STEP_NS = 10 * NS_PER_S


def times(folder: Path) -> list[int]:
    return sorted(int(path.stem) for path in folder.iterdir())


def test_old_checkpoints_are_thinned_and_the_newest_is_always_there(tmp_path: Path) -> None:
    checkpoints = Checkpoints(tmp_path)
    state = make_pipeline().checkpoint()
    for number in range(1, 300):
        checkpoints.save(number * STEP_NS, 1, state)
    kept = times(tmp_path)
    assert kept[-KEPT_CLOSE:] == [number * STEP_NS for number in range(300 - KEPT_CLOSE, 300)]
    far = [after - before for before, after in pairwise(kept[:-KEPT_CLOSE])]
    assert len(far) > 10
    assert min(far) >= SPARSE_NS
    assert max(far) < 2 * SPARSE_NS


@pytest.mark.slow
def test_number_of_checkpoints_is_bounded(tmp_path: Path) -> None:
    checkpoints = Checkpoints(tmp_path)
    state = make_pipeline().checkpoint()
    for number in range(1, KEPT_FAR + KEPT_CLOSE + 30):
        checkpoints.save(number * SPARSE_NS, 1, state)
    assert len(times(tmp_path)) <= KEPT_FAR + KEPT_CLOSE


def test_latest_before_a_time_is_found(tmp_path: Path) -> None:
    checkpoints = Checkpoints(tmp_path)
    assert checkpoints.latest() is None
    for t_ns in (100, 200, 300):
        checkpoints.save(t_ns, t_ns // 100, make_pipeline().checkpoint())
    saved = checkpoints.latest(until_ns=250)
    assert saved is not None
    assert (saved.t_ns, saved.events_at_t) == (200, 2)
    exactly = checkpoints.latest(until_ns=200)
    assert exactly is not None
    assert exactly.t_ns == 200
    assert checkpoints.latest(until_ns=99) is None
    assert checkpoints.latest(until_ns=250, after_ns=200) is None


def test_checkpoint_before_a_torn_one_is_used(tmp_path: Path) -> None:
    checkpoints = Checkpoints(tmp_path)
    for t_ns in (100, 200, 300):
        checkpoints.save(t_ns, 1, make_pipeline().checkpoint())
    newest = max(tmp_path.iterdir())
    newest.write_bytes(newest.read_bytes()[:-10])
    saved = checkpoints.latest()
    assert saved is not None
    assert saved.t_ns == 200


def test_file_that_is_no_checkpoint_is_left(tmp_path: Path) -> None:
    checkpoints = Checkpoints(tmp_path)
    checkpoints.save(100, 1, make_pipeline().checkpoint())
    (path,) = tmp_path.iterdir()
    path.with_stem(f"{path.stem} (copy)").write_bytes(path.read_bytes())
    saved = checkpoints.latest()
    assert saved is not None
    assert saved.t_ns == 100


def test_checkpoints_of_another_program_are_left(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Parts of the state may have another form; the log has everything that matters."""
    Checkpoints(tmp_path).save(100, 3, make_pipeline().checkpoint())
    assert Checkpoints(tmp_path).latest() is not None
    monkeypatch.setattr("base_station.storage.checkpoints.program_checksum", lambda: 7)
    assert Checkpoints(tmp_path).latest() is None


def test_any_changed_module_makes_another_program(tmp_path: Path) -> None:
    """Other files beside the modules, which may be changing just now, do not."""
    programs = set()
    for name in ("a.py", "inside/deeper/b.py"):
        path = tmp_path / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text("x = 1\n", encoding="utf-8")
        programs.add(_checksum_of(tmp_path))
        path.write_text("x = 2\n", encoding="utf-8")
        programs.add(_checksum_of(tmp_path))
    assert len(programs) == 4
    for name in ("a.txt", "node_modules/c.py", "__pycache__/a.py"):
        path = tmp_path / name
        path.parent.mkdir(exist_ok=True)
        path.write_text("x = 3\n", encoding="utf-8")
        assert _checksum_of(tmp_path) in programs


def test_total_size_is_bounded(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("base_station.storage.checkpoints.KEPT_BYTES", 2000)
    checkpoints = Checkpoints(tmp_path)
    for number in range(1, 50):
        checkpoints.save(number * SPARSE_NS, 1, make_pipeline().checkpoint())
    old = sorted(tmp_path.iterdir())[:-KEPT_CLOSE]
    assert old
    assert sum(path.stat().st_size for path in old) <= 2000


def test_checkpoint_saved_during_a_removal_is_saved_or_removed(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """It is not reported as a failing disk."""
    checkpoints, replace = Checkpoints(tmp_path), Path.replace
    removing = Thread(target=checkpoints.clear)

    def removed_meanwhile(part: Path, path: Path) -> Path:
        removing.start()
        removing.join(0.2)  # as far as it gets
        return replace(part, path)

    monkeypatch.setattr(Path, "replace", removed_meanwhile)
    checkpoints.save(100, 1, make_pipeline().checkpoint())
    removing.join()
    assert times(tmp_path) == []
