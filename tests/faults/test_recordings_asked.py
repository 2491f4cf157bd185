"""What is asked of a unit's recording, by whom and into which folder; and what is refused."""

from __future__ import annotations

import hashlib
import os
import random
import shutil
from collections.abc import Callable
from pathlib import Path
from types import SimpleNamespace

import pytest

from base_station.recordings import fetch as fetching
from base_station.recordings.desk import RecordingDesk
from base_station.recordings.fetch import Ask, Fetch, FetchState, Wanted
from shared.clock import ManualClock, SystemClock
from shared.errors import DataFolderInUseError, UserError
from shared.messages.recording import (
    RecordedFile,
    RecordingDigest,
    RecordingIndex,
    RecordingPiece,
)
from tests.recorded_unit import SECONDS, RecordedUnit, U, begin, finish
from tests.waiting import until


@pytest.mark.parametrize(("from_s", "to_s"), [(-900.0, -800.0), (SECONDS + 900, SECONDS + 1900)])
def test_a_window_without_a_recording_is_said(
    unit: RecordedUnit, tmp_path: Path, from_s: float, to_s: float
) -> None:
    fetch = finish(begin(unit, tmp_path, unit.window(from_s, to_s)))
    assert fetch.state is FetchState.FAILED
    assert "no recording of that time" in fetch.problem


@pytest.mark.parametrize(
    "name", ["../../etc/passwd", "/etc/passwd", "a/../b", "..", "a/b/c", "a/.."]
)
def test_a_unit_cannot_name_a_file_outside_its_folder(tmp_path: Path, name: str) -> None:
    def ask(_: str, question: str) -> bytes | None:
        assert question.startswith("index")
        return RecordingIndex((RecordedFile(name, 10),), 1).to_bytes()

    fetch = finish(Fetch(ask, tmp_path, Wanted(U, 1, 2), SystemClock()))
    assert fetch.state is FetchState.FAILED
    assert "names files" in fetch.problem


@pytest.mark.parametrize(
    "question",
    [
        "piece?path=../journal.sqlite;offset=0;length=10",
        "piece?path=calibrations/../journal.sqlite;offset=0;length=10",
        "piece?path=/etc/passwd;offset=0;length=10",
    ],
)
def test_a_station_gets_nothing_but_the_recording(unit: RecordedUnit, question: str) -> None:
    answer = unit.ask(U, question)
    assert answer is not None
    piece = RecordingPiece.from_bytes(answer)
    assert piece.gone
    assert piece.data == b""


@pytest.mark.parametrize(
    "question",
    ["piece?path=a", "index?from=x;to=2", "what?", "piece?path=a/b;offset=-1;length=3", "digest?"],
)
def test_questions_that_make_no_sense_are_not_answered(unit: RecordedUnit, question: str) -> None:
    answer = unit.ask(U, question)
    assert answer is None or RecordingPiece.from_bytes(answer).gone


def test_a_disk_that_has_no_room_is_said_before_anything_is_pulled(
    unit: RecordedUnit, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    fetch = begin(unit, tmp_path)
    with monkeypatch.context() as patched:
        patched.setattr(fetching, "_SPARED_BYTES", 1 << 62)
        for _ in range(5):
            fetch.step()
        assert fetch.state is FetchState.WAITING
        assert "when the disk is freed" in fetch.problem
        assert "piece" not in unit.questions
    assert finish(fetch).state is FetchState.DONE


def test_a_disk_on_which_the_log_grows_meanwhile_is_left_to_it(
    unit: RecordedUnit, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    fetch = begin(unit, tmp_path)
    for _ in range(15):
        fetch.step()
    asked = unit.questions.count("piece")
    assert 0 < fetch.done_bytes < fetch.total_bytes
    with monkeypatch.context() as patched:
        patched.setattr(fetching, "_SPARED_BYTES", 1 << 62)
        for _ in range(5):
            fetch.step()
        assert fetch.state is FetchState.WAITING
        assert unit.questions.count("piece") <= asked + 1  # which was asked before
    fetch = finish(fetch)
    assert fetch.state is FetchState.DONE
    for one in unit.boot.iterdir():
        assert (tmp_path / U / unit.boot.name / one.name).read_bytes() == one.read_bytes()


def test_a_disk_that_gets_full_on_the_way_is_said_and_what_came_is_kept(
    unit: RecordedUnit, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    fetch = begin(unit, tmp_path)
    for _ in range(15):
        fetch.step()

    def full(_: int) -> None:
        raise OSError(28, "No space left on device")

    with monkeypatch.context() as patched:
        patched.setattr(os, "fsync", full)
        finish(fetch)
    assert fetch.state is FetchState.FAILED
    assert "No space left on device" in fetch.problem
    assert finish(begin(unit, tmp_path)).state is FetchState.DONE


def test_two_pulls_from_one_unit_do_not_write_over_each_other(
    unit: RecordedUnit, tmp_path: Path
) -> None:
    fetch = begin(unit, tmp_path)
    with pytest.raises(DataFolderInUseError, match="pull"):
        begin(unit, tmp_path)
    fetch.close()


def desk(ask: Ask, folder: Path) -> RecordingDesk:
    return RecordingDesk(ask, folder, SystemClock())


def test_a_station_that_is_started_again_goes_on(unit: RecordedUnit, tmp_path: Path) -> None:
    unit.linked = False
    with desk(unit.ask, tmp_path) as first:
        first.add("chief", unit.window())
        until(lambda: "does not answer" in first.pulls()[0].problem)
    unit.linked = True
    with desk(unit.ask, tmp_path) as second:
        until(lambda: second.pulls()[0].state is FetchState.DONE)
        (view,) = second.views()
    assert view.unit_id == U
    assert view.done_bytes == view.total_bytes > 0
    assert second.pulls()[0].by == "chief"


def test_a_unit_that_is_away_holds_up_no_other(unit: RecordedUnit, tmp_path: Path) -> None:
    away = Wanted("FF-02", 1, 2)
    with desk(unit.ask, tmp_path) as both:
        both.add("chief", away)
        both.add("chief", unit.window(0.0, 600.0))
        until(lambda: both.pulls()[1].state is FetchState.DONE)
        assert both.pulls()[0].state is FetchState.WAITING


def test_a_pull_can_be_stopped_and_asked_for_again(unit: RecordedUnit, tmp_path: Path) -> None:
    unit.linked = False
    with desk(unit.ask, tmp_path) as one:
        pull = one.add("chief", unit.window())
        with pytest.raises(UserError, match="already"):
            one.add("chief", unit.window())
        assert one.stop(pull.fetch_id)
        assert not one.stop(pull.fetch_id)
        unit.linked = True
        one.add("chief", unit.window())
        until(lambda: one.pulls()[-1].state is FetchState.DONE)
    assert one.pulls()[0].problem == "stopped by a person"


def test_a_window_that_ends_before_it_begins_is_refused(unit: RecordedUnit, tmp_path: Path) -> None:
    with desk(unit.ask, tmp_path) as one, pytest.raises(UserError, match="before it begins"):
        one.add("chief", Wanted(U, 2, 1))


class TellingUnit:
    """A unit that has these files, and of which a test says what becomes of them meanwhile."""

    def __init__(self, **files: bytes) -> None:
        self.files = {f"boot/{name}.mcap": content for name, content in files.items()}
        self.before: Callable[[str], None] = lambda _: None  # hears of every question
        self.pieces: list[int] = []  # how much was asked for

    def ask(self, _: str, question: str) -> bytes:
        self.before(question)
        what, _, said = question.partition("?")
        values = dict(pair.split("=") for pair in said.split(";"))
        if what == "index":
            files = (RecordedFile(name, len(content)) for name, content in self.files.items())
            return RecordingIndex(tuple(files), 1).to_bytes()
        content = self.files.get(values["path"])
        if what == "digest":
            size = int(values["size"])
            told = b"" if content is None else hashlib.sha256(content[:size]).digest()
            return RecordingDigest(size, told).to_bytes()
        offset, length = int(values["offset"]), int(values["length"])
        self.pieces.append(length)
        if content is None:
            return RecordingPiece(offset, b"", b"", gone=True).to_bytes()
        data = content[offset : offset + length]
        return RecordingPiece(offset, data, hashlib.sha256(data).digest()).to_bytes()

    def pull(self, folder: Path) -> Fetch:
        return Fetch(self.ask, folder, Wanted(U, 1, 2), SystemClock())


def pulled(folder: Path) -> dict[str, bytes]:
    """What is there of it, by name."""
    return {one.name: one.read_bytes() for one in (folder / U / "boot").iterdir()}


@pytest.mark.parametrize(("others_s", "link_s", "grows"), [(20.0, 0.0, True), (0.0, 20.0, False)])
def test_what_other_units_take_is_no_time_of_this_ones_link(
    tmp_path: Path, others_s: float, link_s: float, grows: bool
) -> None:
    """One that is out of reach may take seconds of every round."""
    unit, clock = TellingUnit(a=bytes(100_000)), ManualClock()
    unit.before = lambda _: clock.advance(link_s)
    fetch = Fetch(unit.ask, tmp_path, Wanted(U, 1, 2), clock)
    for _ in range(8):
        fetch.step()
        clock.advance(others_s)
    fetch.close()
    assert (unit.pieces[-1] > 10 * unit.pieces[0]) == grows


def test_a_link_that_gets_thin_is_asked_for_as_little_as_it_carries(tmp_path: Path) -> None:
    """What it cannot carry in time is not asked for again and again."""
    content = random.Random(1).randbytes(300_000)
    unit, carried_bytes = TellingUnit(a=content), len(content)

    def ask(unit_id: str, question: str) -> bytes | None:
        answer = unit.ask(unit_id, question)
        return answer if len(answer) <= carried_bytes else None

    fetch = Fetch(ask, tmp_path, Wanted(U, 1, 2), ManualClock())
    for _ in range(8):
        fetch.step()
    assert unit.pieces[-1] > 10 * unit.pieces[0]
    carried_bytes = 2000
    came = fetch.done_bytes
    for _ in range(10):
        fetch.step()
    assert fetch.done_bytes > came
    carried_bytes = len(content)
    finish(fetch)
    assert pulled(tmp_path) == {"a.mcap": content}


def test_a_file_that_got_shorter_at_the_unit_is_asked_for_as_it_is_now(tmp_path: Path) -> None:
    """Its power was lost, and it mended what it had recorded."""
    unit = TellingUnit(a=b"recorded" * 300)

    def lose(question: str) -> None:
        if "offset=1024" in question:
            unit.files["boot/a.mcap"] = b"recorded" * 128

    unit.before = lose
    fetch = finish(unit.pull(tmp_path), steps=20)
    assert (fetch.state, fetch.problem) == (FetchState.DONE, "")
    assert pulled(tmp_path) == {"a.mcap": b"recorded" * 128}


def test_a_unit_that_gives_less_than_it_says_is_not_asked_without_a_pause(tmp_path: Path) -> None:
    unit = TellingUnit(a=b"all of it")

    def lie(question: str) -> None:
        unit.files["boot/a.mcap"] = b"all of it" if question.startswith("index") else b"half"

    unit.before = lie
    fetch = unit.pull(tmp_path)
    states = []
    for _ in range(8):
        fetch.step()
        states.append(fetch.state)
    fetch.close()
    assert FetchState.WAITING in states[4:], "the desk rests then"
    assert not fetch.state.is_over


def test_what_is_begun_again_counts_nothing_twice(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    files = {"a": b"a" * 500, "b": b"b" * 5000}
    unit = TellingUnit(**files)
    fetch = unit.pull(tmp_path)

    def give_up(question: str) -> None:
        if "digest?path=boot/a" in question:
            del unit.files["boot/a.mcap"]

    unit.before = give_up
    while "boot/a.mcap" in unit.files:
        fetch.step()
    with monkeypatch.context() as patched:
        patched.setattr(fetching, "_SPARED_BYTES", 1 << 62)
        fetch.step()
    assert fetch.state is FetchState.WAITING
    unit.files = TellingUnit(**files).files
    fetch = finish(fetch)
    assert fetch.state is FetchState.DONE
    assert fetch.problem.startswith("1 of 2 files came whole")


def test_what_was_whole_stays_so_though_the_unit_has_another_now_and_gives_it_up(
    tmp_path: Path,
) -> None:
    unit = TellingUnit(a=b"before" * 20)
    finish(unit.pull(tmp_path))
    unit.files["boot/a.mcap"] = b"another" * 40

    def give_up(question: str) -> None:
        if "offset=0" in question:  # what was added did not fit to what was here
            unit.files.clear()

    unit.before = give_up
    fetch = finish(unit.pull(tmp_path))
    assert fetch.state is FetchState.DONE
    assert "1 of 1 files are gone" in fetch.problem
    assert pulled(tmp_path)["a.mcap"] == b"before" * 20


def test_what_was_whole_stays_so_while_more_of_it_is_on_its_way(tmp_path: Path) -> None:
    """The unit may never come back, and whoever pulls may be killed."""
    unit, before = TellingUnit(a=b"before" * 20), b"before" * 20
    finish(unit.pull(tmp_path))
    grown = unit.files["boot/a.mcap"] = before + bytes(100_000)
    fetch = unit.pull(tmp_path)
    for _ in range(4):
        fetch.step()
    assert 0 < fetch.done_bytes < fetch.total_bytes
    assert pulled(tmp_path)["a.mcap"] == before
    fetch.close()
    unit.pieces.clear()
    assert finish(unit.pull(tmp_path)).state is FetchState.DONE
    assert pulled(tmp_path) == {"a.mcap": grown}
    assert sum(unit.pieces) < len(grown) - len(before), "what had come is not asked for again"


def test_a_list_of_hashes_that_is_damaged_ends_no_pull(tmp_path: Path) -> None:
    unit = TellingUnit(a=b"all of it")
    finish(unit.pull(tmp_path))
    hashes = tmp_path / U / fetching.HASHES
    hashes.write_bytes(b"\xff\xfe" + hashes.read_bytes())
    unit.files["boot/b.mcap"] = b"another"
    assert finish(unit.pull(tmp_path)).state is FetchState.DONE
    digest = hashlib.sha256(b"another").hexdigest()
    assert f"{digest}  boot/b.mcap" in hashes.read_text(encoding="utf-8").splitlines()


def test_a_bus_that_fails_ends_no_pull(tmp_path: Path) -> None:
    unit, failures = TellingUnit(a=b"all of it"), [RuntimeError("can't start new thread")]

    def fail_once(_: str) -> None:
        if failures:
            raise failures.pop()

    unit.before = fail_once
    fetch = unit.pull(tmp_path)
    fetch.step()
    fetch.step()
    assert (fetch.state, "does not answer" in fetch.problem) == (FetchState.WAITING, True)
    assert finish(fetch).state is FetchState.DONE


def test_a_unit_that_has_another_file_under_the_name_gives_that(tmp_path: Path) -> None:
    unit = TellingUnit(a=b"before" * 20, b=b"before" * 20)
    finish(unit.pull(tmp_path))
    unit.files = {"boot/a.mcap": b"shorter", "boot/b.mcap": b"longer" * 99}
    fetch = finish(unit.pull(tmp_path))
    assert (fetch.state, fetch.problem) == (FetchState.DONE, "")
    assert pulled(tmp_path) == {"a.mcap": b"shorter", "b.mcap": b"longer" * 99}


def test_what_is_here_of_other_times_makes_no_room(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    unit = TellingUnit(old=b"old" * 1000)
    finish(unit.pull(tmp_path))
    unit.files = {f"boot/{name}.mcap": bytes(400) for name in "ab"}
    unit.pieces.clear()
    free_bytes = fetching._SPARED_BYTES + 500
    monkeypatch.setattr(shutil, "disk_usage", lambda _: SimpleNamespace(free=free_bytes))
    fetch = unit.pull(tmp_path)
    for _ in range(5):
        fetch.step()
    fetch.close()
    assert fetch.state is FetchState.WAITING
    assert unit.pieces == []


def listed(folder: Path) -> dict[str, str]:
    """The hashes that stand beside the files, by name."""
    lines = (folder / U / fetching.HASHES).read_text(encoding="utf-8").splitlines()
    pairs = (line.split("  ") for line in lines)
    return {name.removeprefix("boot/"): digest for digest, name in pairs}


def test_what_is_given_up_while_a_pull_waits_is_gone(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """It asks anew what there is, and is not told of it any more."""
    unit = TellingUnit(a=b"a" * 500, b=b"b" * 5000, c=b"c" * 500)
    fetch = unit.pull(tmp_path)
    while not (tmp_path / U / "boot" / "a.mcap").exists():
        fetch.step()
    with monkeypatch.context() as patched:
        patched.setattr(fetching, "_SPARED_BYTES", 1 << 62)
        for _ in range(3):
            fetch.step()
        assert fetch.state is FetchState.WAITING
    del unit.files["boot/a.mcap"], unit.files["boot/b.mcap"]
    fetch = finish(fetch)
    assert fetch.state is FetchState.DONE
    assert fetch.problem == "1 of 3 files are gone: the unit needed the room"
    assert pulled(tmp_path)["a.mcap"] == b"a" * 500
    assert listed(tmp_path).keys() == {"a.mcap", "c.mcap"}


def test_what_has_come_is_listed_with_its_hash_though_the_rest_never_comes(
    tmp_path: Path,
) -> None:
    unit = TellingUnit(a=b"half")
    finish(unit.pull(tmp_path))
    whole = unit.files["boot/a.mcap"] = b"half of it"
    unit.files["boot/b.mcap"] = b"another"

    def spoil(question: str) -> None:
        if "digest?path=boot/b" in question:
            unit.files["boot/b.mcap"] = os.urandom(7)

    unit.before = spoil
    fetch = finish(unit.pull(tmp_path))
    assert (fetch.state, "different" in fetch.problem) == (FetchState.FAILED, True)
    assert pulled(tmp_path) == {"a.mcap": whole}
    assert listed(tmp_path) == {"a.mcap": hashlib.sha256(whole).hexdigest()}
