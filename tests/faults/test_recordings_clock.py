"""A unit whose clock began in 1970, or in 2100, finds its recording by station time."""

from __future__ import annotations

import time
from pathlib import Path

import pytest

from edge.clocks.station import StationClock
from edge.sample_codec.codec import SampleEncoder
from edge.sample_codec.descriptions import unit_sensor
from edge.sources.registry import open_source
from edge.storage.black_box.black_box import BlackBox
from edge.storage.black_box.server import RecordingServer
from edge.storage.data_folder import UnitDataFolder
from shared.bus import ReplyHandler
from shared.clock import NS_PER_S, ManualClock
from shared.mcap_log import SegmentReader, segment_began_ns, segment_paths
from shared.messages.clock import ClockAnswer
from shared.messages.recording import RecordingIndex

U = "FF-01"
STATION_NS = 1_800_000_000 * NS_PER_S
SECONDS, BATCHES = 800, 400
WINDOW_S = 10


class Machine(ManualClock):
    """A unit's clock, which somebody may set."""

    def set_to(self, utc_ns: int) -> None:
        self._utc_offset_ns = utc_ns - self._monotonic_ns


def link(clock: StationClock, station_ns: int) -> None:
    """It hears what time it is at the station."""

    def answer(reply: ReplyHandler) -> None:
        reply(ClockAnswer(station_ns, station_ns).to_bytes())

    clock.turn(answer)


def record(
    folder: UnitDataFolder, machine: Machine, began_ns: int, set_at_s: float
) -> StationClock:
    """The unit begins at this station time, and somebody sets its clock later."""
    clock = StationClock(machine)
    source = open_source("simulated:climbs-stairs?seed=3")
    raw = SampleEncoder(U, 7)
    description = raw.description(0, (unit_sensor("", source.description),), source="", tracker="")
    box = BlackBox(folder.black_box, description, 10**9, clock, clock.utc_std_s)
    for number, batch in zip(range(BATCHES), source.batches(), strict=False):
        at_s = number * SECONDS / BATCHES
        if at_s == set_at_s:
            machine.set_to(began_ns + round(at_s * NS_PER_S))
        box.write(raw.messages(batch))
        if number == 0:
            link(clock, began_ns)
        while not box._waiting.empty():  # each is written at its own time
            time.sleep(0)
        machine.advance(SECONDS / BATCHES)
    box.close()
    return clock


def found(server: RecordingServer, from_s: float) -> list[str]:
    """The segments of a window that begins so long behind the recording's start."""
    from_ns = STATION_NS + round(from_s * NS_PER_S)
    question = f"from={from_ns};to={from_ns + WINDOW_S * NS_PER_S}"
    (answer,) = server.replies(f"muster/v1/{U}/recording/index", question, b"")
    return [file.path for file in RecordingIndex.from_bytes(answer).files]


@pytest.mark.parametrize("began_ns", [60 * NS_PER_S, 4_102_444_800 * NS_PER_S])
@pytest.mark.parametrize("set_at_s", [400.0, -1.0], ids=["set right", "never set"])
def test_window_is_found_after_changes_of_the_clock(
    tmp_path: Path, began_ns: int, set_at_s: float
) -> None:
    folder, machine = UnitDataFolder(tmp_path), Machine(utc_ns=began_ns)
    clock = record(folder, machine, STATION_NS, set_at_s)
    (boot,) = folder.black_box.iterdir()
    segments = segment_paths(boot)
    assert len(segments) > 3
    starts_s = [(segment_began_ns(one) - began_ns) / NS_PER_S for one in segments]
    again = StationClock(Machine(utc_ns=90 * NS_PER_S))  # it was off, and has no battery
    link(again, STATION_NS + 3600 * NS_PER_S)
    for server in (RecordingServer(U, folder, one) for one in (clock, again)):
        for number, start_s in enumerate(starts_s):
            name = f"{boot.name}/{segments[number].name}"
            assert found(server, start_s + 20.0) == [name], "and no other"
        assert found(server, -60.0) == []
        assert found(server, SECONDS + 60.0) == []
    folder.close()


def test_earlier_boots_are_not_read(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The end of one that was switched off costs reading it, and the station waits five seconds."""
    read: list[Path] = []

    class Counted(SegmentReader):
        def __init__(self, path: Path) -> None:
            read.append(path)
            super().__init__(path)

    folder, machine = UnitDataFolder(tmp_path), Machine(utc_ns=STATION_NS)
    clock = record(folder, machine, STATION_NS, set_at_s=-1.0)
    last = segment_paths(next(folder.black_box.iterdir()))[-1]
    last.write_bytes(last.read_bytes()[:-100])
    monkeypatch.setattr("edge.storage.black_box.server.SegmentReader", Counted)
    server = RecordingServer(U, folder, clock)
    assert found(server, SECONDS - 20.0) == [f"{last.parent.name}/{last.name}"]
    assert found(server, SECONDS - 1.0) == [f"{last.parent.name}/{last.name}"], "it may go on"
    assert found(server, SECONDS + 60.0) == []
    assert read == [last] * 3
    assert found(server, SECONDS + 1000.0) == []
    assert read == [last] * 3
    folder.close()


def test_oldest_recording_is_deleted_first_independent_of_its_date(tmp_path: Path) -> None:
    folder = UnitDataFolder(tmp_path)
    for boot, began_s in enumerate((4_102_444_800, 60)):  # first of all a clock in 2100
        machine = Machine(utc_ns=began_s * NS_PER_S)
        record(folder, machine, STATION_NS + boot * 3600 * NS_PER_S, set_at_s=-1.0)
    first, second = sorted(folder.black_box.iterdir(), reverse=True)
    kept_bytes = sum(one.stat().st_size for one in segment_paths(second))
    source = open_source("simulated:climbs-stairs?seed=3")
    sent = (unit_sensor("", source.description),)
    description = SampleEncoder(U, 9).description(0, sent, source="", tracker="")
    BlackBox(folder.black_box, description, kept_bytes, Machine()).close()
    assert not first.exists()
    assert segment_paths(second)
    folder.close()
