"""A recording reaches the station whole, whoever is ended on the way and whatever is in the way."""

from __future__ import annotations

import hashlib
import os
import random
import subprocess
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from base_station.recordings import fetch as fetching
from base_station.recordings.desk import RecordingDesk
from base_station.recordings.fetch import HASHES, Ask, Fetch, FetchState, Wanted
from edge.black_box import BlackBox
from edge.data_folder import DataFolder
from edge.raw_stream import RawStream
from edge.recording_server import RecordingServer
from edge.sources import open_source
from edge.sources.black_box import BlackBoxSource
from edge.station_clock import StationClock
from shared.clock import NS_PER_S, ManualClock, SystemClock
from shared.errors import DataFolderInUseError, UserError
from shared.messages.recording import RecordedFile, RecordingIndex, RecordingPiece
from tests.waiting import until

U = "FF-01"
BATCHES = 600
SECONDS = 4000  # of clock time that the recording takes: many segments


class Unit:
    """A unit with a black box and the server that gives it away."""

    def __init__(self, folder: Path) -> None:
        self.machine = ManualClock(utc_ns=time.time_ns() - SECONDS * NS_PER_S)
        self.folder = DataFolder(folder)
        self.began_ns = self.machine.utc_ns()
        source = open_source("simulated:climbs-stairs?seed=3")
        raw = RawStream(U, 7)
        description = raw.description(0, source.description, source="", tracker="")
        box = BlackBox(self.folder.black_box, description, 10**9, self.machine)
        for _, batch in zip(range(BATCHES), source.batches(), strict=False):
            box.write(raw.messages(batch))
            while not box._waiting.empty():  # each is written at its own time
                time.sleep(0)
            self.machine.advance(SECONDS / BATCHES)
        box.close()
        (self.boot,) = self.folder.black_box.iterdir()
        self.folder.calibrations.mkdir()
        (self.folder.calibrations / "c1.toml").write_text("x = 1\n")
        self.server = RecordingServer(U, self.folder, StationClock(self.machine))
        self.linked = True
        self.spoil: Callable[[str, bytes], bytes] = lambda _, reply: reply
        self.questions: list[str] = []

    def ask(self, unit_id: str, question: str) -> bytes | None:
        what, _, parameters = question.partition("?")
        self.questions.append(what)
        if not self.linked or unit_id != U:
            return None
        replies = self.server.replies(f"muster/v1/{U}/recording/{what}", parameters, b"")
        reply = next(iter(replies), None)
        return None if reply is None else self.spoil(what, reply)

    def window(self, from_s: float = 0.0, to_s: float = SECONDS) -> Wanted:
        return Wanted(
            U, self.began_ns + round(from_s * NS_PER_S), self.began_ns + round(to_s * NS_PER_S)
        )


@pytest.fixture(scope="module")
def recorded(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Unit]:
    unit = Unit(tmp_path_factory.mktemp("unit"))
    yield unit
    unit.folder.close()


@pytest.fixture
def unit(recorded: Unit) -> Unit:
    recorded.linked = True
    recorded.spoil = lambda _, reply: reply
    recorded.questions.clear()
    return recorded


def begin(unit: Unit, folder: Path, wanted: Wanted | None = None) -> Fetch:
    return Fetch(unit.ask, folder, wanted or unit.window(), SystemClock())


def finish(fetch: Fetch, steps: int = 20_000) -> Fetch:
    for _ in range(steps):
        if fetch.state.is_over:
            break
        fetch.step()
    fetch.close()
    return fetch


def test_all_of_it_is_the_unit_s_to_the_last_bit_and_replays(unit: Unit, tmp_path: Path) -> None:
    fetch = finish(begin(unit, tmp_path))
    assert (fetch.state, fetch.problem) == (FetchState.DONE, "")
    assert fetch.done_bytes == fetch.total_bytes > 0
    pulled = tmp_path / U / unit.boot.name
    assert {one.name for one in pulled.iterdir()} == {one.name for one in unit.boot.iterdir()}
    for one in unit.boot.iterdir():
        assert (pulled / one.name).read_bytes() == one.read_bytes()
    assert (tmp_path / U / "calibrations" / "c1.toml").read_text() == "x = 1\n"
    batches = sum(1 for _ in BlackBoxSource(pulled).batches())
    assert batches == sum(1 for _ in BlackBoxSource(unit.boot).batches()) > 0


def test_the_hashes_stand_beside_it_as_the_usual_tool_reads_them(
    unit: Unit, tmp_path: Path
) -> None:
    finish(begin(unit, tmp_path, unit.window(0.0, 500.0)))
    finish(begin(unit, tmp_path, unit.window(3000.0, 3500.0)))
    checked = subprocess.run(
        ["sha256sum", "--check", HASHES],
        cwd=tmp_path / U,
        capture_output=True,
        text=True,
        check=True,
    )
    assert checked.stdout.count(": OK") == len(list((tmp_path / U).rglob("*.mcap"))) + 1


def test_of_a_window_only_its_segments_are_pulled(unit: Unit, tmp_path: Path) -> None:
    fetch = finish(begin(unit, tmp_path, unit.window(1000.0, 1300.0)))
    pulled = sorted(one.name for one in (tmp_path / U / unit.boot.name).iterdir())
    assert 3 <= len(pulled) <= 5
    assert fetch.total_bytes < sum(one.stat().st_size for one in unit.boot.iterdir()) / 5


@pytest.mark.parametrize("seed", range(5))
def test_a_station_that_is_killed_again_and_again_asks_for_no_byte_twice(
    unit: Unit, tmp_path: Path, seed: int
) -> None:
    chance = random.Random(seed)
    given: list[tuple[int, int]] = []

    def note(what: str, reply: bytes) -> bytes:
        if what == "piece":
            piece = RecordingPiece.from_bytes(reply)
            given.append((piece.offset, len(piece.data)))
        return reply

    unit.spoil = note
    for _ in range(8):
        fetch = begin(unit, tmp_path)
        for _ in range(chance.randrange(1, 40)):
            fetch.step()
        os.close(fetch._lock._descriptor)  # all that the system does for a program that dies
    fetch = finish(begin(unit, tmp_path))
    assert fetch.state is FetchState.DONE
    assert sum(length for _, length in given) == fetch.total_bytes


def test_a_unit_that_goes_away_is_waited_for(unit: Unit, tmp_path: Path) -> None:
    fetch = begin(unit, tmp_path)
    for _ in range(15):
        fetch.step()
    came = fetch.done_bytes
    unit.linked = False
    for _ in range(5):
        fetch.step()
    assert fetch.state is FetchState.WAITING
    assert "FF-01 does not answer" in fetch.problem
    unit.linked = True
    assert finish(fetch).state is FetchState.DONE
    assert fetch.done_bytes > came


def test_flipped_bits_on_the_way_are_asked_for_again(unit: Unit, tmp_path: Path) -> None:
    chance = random.Random(3)

    def flip(what: str, reply: bytes) -> bytes:
        if what == "piece" and chance.random() < 0.3:
            place = chance.randrange(len(reply))
            return reply[:place] + bytes([reply[place] ^ 4]) + reply[place + 1 :]
        return reply

    unit.spoil = flip
    assert finish(begin(unit, tmp_path)).state is FetchState.DONE
    for one in unit.boot.iterdir():
        assert (tmp_path / U / unit.boot.name / one.name).read_bytes() == one.read_bytes()


def test_what_was_spoiled_on_the_station_s_disk_is_pulled_anew(unit: Unit, tmp_path: Path) -> None:
    fetch = begin(unit, tmp_path)
    for _ in range(12):
        fetch.step()
    fetch.close()
    (part,) = tmp_path.rglob("*.part")
    part.write_bytes(bytes(part.stat().st_size))
    assert finish(begin(unit, tmp_path)).state is FetchState.DONE


def test_a_unit_whose_answers_never_agree_is_given_up_in_words(unit: Unit, tmp_path: Path) -> None:
    def wrong(what: str, reply: bytes) -> bytes:
        if what != "piece":
            return reply
        piece = RecordingPiece.from_bytes(reply)
        data = bytes(len(piece.data))
        return RecordingPiece(piece.offset, data, hashlib.sha256(data).digest()).to_bytes()

    unit.spoil = wrong
    fetch = finish(begin(unit, tmp_path))
    assert fetch.state is FetchState.FAILED
    assert "different" in fetch.problem
    assert not list(tmp_path.rglob("*.mcap"))


def test_a_recording_that_grows_is_gone_on_with(unit: Unit, tmp_path: Path) -> None:
    first = sorted(unit.boot.iterdir())[0]
    whole = first.read_bytes()
    try:
        first.write_bytes(whole[:1000])
        assert finish(begin(unit, tmp_path, unit.window(0.0, 10.0))).state is FetchState.DONE
        first.write_bytes(whole)
        asked = len(unit.questions)
        fetch = finish(begin(unit, tmp_path, unit.window(0.0, 10.0)))
    finally:
        first.write_bytes(whole)
    assert fetch.state is FetchState.DONE
    assert (tmp_path / U / unit.boot.name / first.name).read_bytes() == whole
    assert len(unit.questions) > asked


@pytest.mark.parametrize(("from_s", "to_s"), [(-900.0, -800.0), (SECONDS + 900, SECONDS + 1900)])
def test_a_window_without_a_recording_is_said(
    unit: Unit, tmp_path: Path, from_s: float, to_s: float
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
def test_a_station_gets_nothing_but_the_recording(unit: Unit, question: str) -> None:
    answer = unit.ask(U, question)
    assert answer is not None
    piece = RecordingPiece.from_bytes(answer)
    assert piece.gone
    assert piece.data == b""


@pytest.mark.parametrize(
    "question",
    ["piece?path=a", "index?from=x;to=2", "what?", "piece?path=a/b;offset=-1;length=3", "digest?"],
)
def test_questions_that_make_no_sense_are_not_answered(unit: Unit, question: str) -> None:
    answer = unit.ask(U, question)
    assert answer is None or RecordingPiece.from_bytes(answer).gone


def test_a_disk_that_has_no_room_is_said_before_anything_is_pulled(
    unit: Unit, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(fetching, "_SPARED_BYTES", 1 << 62)
    fetch = finish(begin(unit, tmp_path))
    assert fetch.state is FetchState.FAILED
    assert "free the disk" in fetch.problem
    assert "piece" not in unit.questions


def test_a_disk_that_gets_full_on_the_way_is_said_and_what_came_is_kept(
    unit: Unit, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
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


def test_two_pulls_from_one_unit_do_not_write_over_each_other(unit: Unit, tmp_path: Path) -> None:
    fetch = begin(unit, tmp_path)
    with pytest.raises(DataFolderInUseError, match="pull"):
        begin(unit, tmp_path)
    fetch.close()


def desk(ask: Ask, folder: Path) -> RecordingDesk:
    return RecordingDesk(ask, folder, SystemClock())


def test_a_station_that_is_started_again_goes_on(unit: Unit, tmp_path: Path) -> None:
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


def test_a_unit_that_is_away_holds_up_no_other(unit: Unit, tmp_path: Path) -> None:
    away = Wanted("FF-02", 1, 2)
    with desk(unit.ask, tmp_path) as both:
        both.add("chief", away)
        both.add("chief", unit.window(0.0, 600.0))
        until(lambda: both.pulls()[1].state is FetchState.DONE)
        assert both.pulls()[0].state is FetchState.WAITING


def test_a_pull_can_be_stopped_and_asked_for_again(unit: Unit, tmp_path: Path) -> None:
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


def test_a_window_that_ends_before_it_begins_is_refused(unit: Unit, tmp_path: Path) -> None:
    with desk(unit.ask, tmp_path) as one, pytest.raises(UserError, match="before it begins"):
        one.add("chief", Wanted(U, 2, 1))
