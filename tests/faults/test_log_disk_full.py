"""A writer on a full disk continues, reports it, and loses no accepted record."""

from __future__ import annotations

import os
import resource
import time
from collections.abc import Callable
from datetime import UTC, datetime
from pathlib import Path

import pytest

from base_station.storage.checkpoints import Checkpoints
from base_station.storage.recorder import Recorder
from shared.channels import POSITION, Qos, backfilled_key
from shared.clock import NS_PER_S, SystemClock
from shared.codec import encode
from shared.errors import LogError, StoreError
from shared.mcap_log import (
    SegmentInfo,
    SegmentPolicy,
    SegmentWriter,
    read_log,
    rewrite_segment,
    segment_paths,
)
from shared.messages import CommandKind, EventKind, Header, Position, UnitEvent
from shared.messages.station import RegisterUnit, SendCommand
from shared.sequence_set import Run
from tests.rig.full_disk import files_of_at_most
from tests.rig.live_station import LiveStation, make_pipeline
from tests.rig.waiting import until

KEY = POSITION.key("anna")
T0_NS = 1_700_000_000 * NS_PER_S


def write_seconds(writer: SegmentWriter, seconds: range) -> int:
    """Ten records a second; how many were accepted."""
    return sum(
        writer.write(T0_NS + second * NS_PER_S + tenth, KEY, b"%d.%d" % (second, tenth) * 50)
        for second in seconds
        for tenth in range(10)
    )


def payloads(folder: Path) -> list[bytes]:
    return [payload for _, _, payload in read_log(folder)]


def expected(seconds: range) -> list[bytes]:
    return [b"%d.%d" % (second, tenth) * 50 for second in seconds for tenth in range(10)]


def test_waiting_records_are_written_in_order_when_there_is_room(tmp_path: Path) -> None:
    writer = SegmentWriter(tmp_path)
    write_seconds(writer, range(20))
    assert writer.problem == ""
    with files_of_at_most(segment_paths(tmp_path)[0].stat().st_size + 100):
        assert write_seconds(writer, range(20, 60)) == 400
        assert "cannot be written" in writer.problem
        assert "free or mend the disk" in writer.problem
        assert writer.waiting_bytes > 0
    write_seconds(writer, range(60, 62))
    assert writer.problem == ""
    writer.close()
    assert payloads(tmp_path) == expected(range(62))
    assert writer.lost == 0


def test_segments_that_end_on_a_full_disk_are_completed_later(tmp_path: Path) -> None:
    closed: list[SegmentInfo] = []
    writer = SegmentWriter(tmp_path, SegmentPolicy(segment_s=10.0), closed.append)
    with files_of_at_most(0):
        write_seconds(writer, range(35))
        assert closed == []
        assert writer.problem
    writer.close()
    assert [info.path for info in closed] == segment_paths(tmp_path)
    assert len(closed) == 4
    assert payloads(tmp_path) == expected(range(35))


def test_records_beyond_what_memory_may_hold_are_refused_and_counted(tmp_path: Path) -> None:
    writer = SegmentWriter(tmp_path, SegmentPolicy(waiting_bytes_max=2000))
    with files_of_at_most(0):
        accepted = write_seconds(writer, range(100))
        assert 0 < accepted < 1000
        assert writer.lost == 1000 - accepted
        assert f"{writer.lost} records are lost" in writer.problem
    write_seconds(writer, range(100, 102))
    writer.close()
    kept = payloads(tmp_path)
    assert len(kept) + writer.lost == 1020
    assert kept[:accepted] == expected(range(100))[:accepted]


def test_closing_on_a_full_disk_reports_the_lost_records(tmp_path: Path) -> None:
    writer = SegmentWriter(tmp_path)
    with files_of_at_most(0):
        write_seconds(writer, range(3))
        writer.close()
    assert writer.problem


def test_lost_records_are_reported_until_the_recorder_restarts(tmp_path: Path) -> None:
    recorder = Recorder(tmp_path, SystemClock(), SegmentPolicy(waiting_bytes_max=2000))
    with files_of_at_most(0):
        for number in range(100):
            recorder.write(T0_NS + number * NS_PER_S, KEY, bytes(200), urgent=True)
    assert recorder.flush()
    assert recorder.lost > 0
    first = 100 - recorder.lost
    assert recorder.problem == (
        f"the disk did not keep up: {recorder.lost} records are missing in the log, from "
        f"{_clock_time(T0_NS, first)} to {_clock_time(T0_NS, 99)} UTC"
    )
    recorder.close()
    assert len(payloads(tmp_path / "log")) + recorder.lost == 100


def _clock_time(t_ns: int, later_s: int) -> str:
    return f"{datetime.fromtimestamp(t_ns // NS_PER_S + later_s, UTC):%H:%M:%S}"


def test_a_recorder_on_a_full_disk_is_behind_until_there_is_room(tmp_path: Path) -> None:
    recorder = Recorder(tmp_path, SystemClock())
    with files_of_at_most(0):
        assert recorder.write(T0_NS, KEY, b"1", urgent=True)
        assert (recorder.flush(), recorder.is_behind) == (False, True)
        assert "cannot be written" in recorder.problem
    assert (recorder.flush(), recorder.is_behind) == (True, False)
    recorder.close()
    assert payloads(tmp_path / "log") == [b"1"]


def north_of_one_m(station: LiveStation) -> float | None:
    (shown,) = station.snapshot().units
    return None if shown.position is None else shown.position.north_m


def test_messages_refused_by_the_log_are_backfilled_when_there_is_room(
    tmp_path: Path, make_position: Callable[..., Position]
) -> None:
    unit, boot, policy = "FF-01", 0xB007, SegmentPolicy(waiting_bytes_max=1_000_000)

    def stated(seq: int) -> Position:
        return make_position(header=Header(unit, boot, seq, seq * NS_PER_S), north_m=float(seq))

    def reported() -> list[Run]:
        return [run for held in station.reported.get(unit, ()) for run in held.runs]

    with LiveStation(tmp_path, policy) as station:
        station.act(RegisterUnit(unit, "one"))
        station.publish(stated(1))
        until(lambda: reported() == [Run(1, 1)])
        with files_of_at_most(0):
            for _ in range(6):  # what nobody can read is logged, too
                station.bus.publish(POSITION.key("FF-02"), os.urandom(200_000), Qos.LIVE)
                time.sleep(0.1)
            until(lambda: station.recorder.problem)
            for seq in range(2, 100):
                station.publish(stated(seq))
            until(lambda: station.recorder.lost >= 98)
            # nobody goes blind because a disk is full
            until(lambda: north_of_one_m(station) == pytest.approx(99.0))
            assert reported() == [Run(1, 1)]  # and no unit is told to forget
        until(lambda: not station.recorder.is_behind)
        seen = station.pipeline.state.units[unit].boots[0].seen
        missing = list(seen.missing(1, 99))
        assert missing == [Run(2, 99)]
        for run in missing:
            for seq in range(run.first, run.last + 1):
                station.feed.deliver(backfilled_key(unit, POSITION.suffix), encode(stated(seq)))
        until(lambda: list(seen.runs()) == [Run(1, 99)])
    with LiveStation(tmp_path) as again:  # what is counted as there is on the disk
        seen = again.pipeline.state.units[unit].boots[0].seen
        assert list(seen.runs()) == [Run(1, 99)]
    keys = [key for _, key, _ in read_log(tmp_path / "log")]
    backfilled = keys.count(backfilled_key(unit, POSITION.suffix))
    assert keys.count(POSITION.key(unit)) + backfilled == 99


def test_station_started_on_a_full_disk_acknowledges_nothing(
    tmp_path: Path, make_position: Callable[..., Position]
) -> None:
    unit, boot = "FF-01", 0xB007

    def stated(seq: int) -> Position:
        return make_position(header=Header(unit, boot, seq, seq * NS_PER_S), north_m=float(seq))

    with LiveStation(tmp_path) as station:
        station.act(RegisterUnit(unit, "one"))
    (path,) = segment_paths(tmp_path / "log")
    path.write_bytes(path.read_bytes()[:-50])  # it was killed, and cannot even mend that
    with files_of_at_most(0):
        station = LiveStation(tmp_path)
        with station:
            station.publish(stated(1))
            until(lambda: north_of_one_m(station) == pytest.approx(1.0))
            until(lambda: station.recorder.problem)
            assert unit not in station.reported
            resource.setrlimit(resource.RLIMIT_FSIZE, (resource.RLIM_INFINITY,) * 2)
            until(lambda: station.reported.get(unit))
    with LiveStation(tmp_path) as again:
        assert list(again.pipeline.state.units[unit].boots[0].seen.runs()) == [Run(1, 1)]


def test_operator_actions_are_logged_on_a_nearly_full_disk(
    tmp_path: Path, make_position: Callable[..., Position]
) -> None:
    """No unit's journal has it: it would be gone when the station starts again."""
    with LiveStation(tmp_path, SegmentPolicy(waiting_bytes_max=1_000_000)) as station:
        station.act(RegisterUnit("FF-01", "one"))
        with files_of_at_most(0):
            until_it_refuses(station)
            lost = station.recorder.lost
            station.act(RegisterUnit("FF-03", "of now"))
            station.publish(UnitEvent(Header("FF-01", 0xB007, 1, 1), EventKind.MAYDAY))
            until(lambda: station.snapshot().alarms)
            assert station.recorder.lost - lost < 10  # ticks and what is said of the log itself
        until(lambda: not station.recorder.is_behind)
    with LiveStation(tmp_path) as again:
        assert again.pipeline.state.units["FF-03"].label == "of now"
        assert any(alarm.rule == "mayday" for alarm in again.snapshot().alarms)


def test_unloggable_operator_actions_are_refused_except_orders(tmp_path: Path) -> None:
    with LiveStation(tmp_path, SegmentPolicy(waiting_bytes_max=1_000_000)) as station:
        with files_of_at_most(0):
            until_it_refuses(station)
            with pytest.raises(StoreError, match=r"this is not done.*cannot be recorded.*disk"):
                register_many(station)
            station.act(SendCommand("out", CommandKind.EVACUATE, "FF-0", "", False, "", 0.0, 600.0))
            assert [one.command_id for one in station.snapshot().commands] == ["out"]
            shown = {unit.unit_id for unit in station.snapshot().units}
            until(lambda: "log" in station.pipeline.state.problems)  # people hear of it
        until(lambda: not station.recorder.is_behind)
        station.act(RegisterUnit("FF-last", "when there is room"))
    with LiveStation(tmp_path) as again:
        assert {*again.pipeline.state.units} == {*shown, "FF-last"}


def register_many(station: LiveStation) -> None:
    for number in range(100):
        station.act(RegisterUnit(f"FF-{number}", os.urandom(20_000).hex()))


def until_it_refuses(station: LiveStation) -> None:
    """Publishes unreadable messages, which are logged too, until memory is full."""
    while not station.recorder.refuses:
        station.bus.publish(POSITION.key("FF-02"), os.urandom(200_000), Qos.LIVE)
        time.sleep(0.1)


def test_segment_that_cannot_be_rewritten_leaves_no_temporary_file(tmp_path: Path) -> None:
    writer = SegmentWriter(tmp_path)
    write_seconds(writer, range(20))
    writer.close()
    (path,) = segment_paths(tmp_path)
    before = path.read_bytes()
    with files_of_at_most(2000), pytest.raises(LogError, match="free or mend the disk"):
        rewrite_segment(path, lambda record: [(record[0], record[1], os.urandom(300))])
    assert list(tmp_path.iterdir()) == [path]
    assert path.read_bytes() == before


def test_checkpoint_that_cannot_be_saved_leaves_no_temporary_file(tmp_path: Path) -> None:
    checkpoints = Checkpoints(tmp_path)
    checkpoints.save(100, 1, make_pipeline().checkpoint())
    (saved,) = tmp_path.iterdir()
    with files_of_at_most(1000), pytest.raises(OSError, match="too large"):
        checkpoints.save(200, 1, os.urandom(10_000))
    assert list(tmp_path.iterdir()) == [saved]
    latest = checkpoints.latest()
    assert latest is not None
    assert latest.t_ns == 100


def test_full_disk_is_reported_also_after_a_nearly_full_one(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A user who ignores the warning of little room must be notified of the full disk."""
    monkeypatch.setattr("base_station.storage.recorder._LITTLE_FREE_BYTES", 1 << 62)
    with LiveStation(tmp_path, SegmentPolicy(waiting_bytes_max=1_000_000)) as station:

        def stated(words: str) -> bool:
            return words in "; ".join(list(station.pipeline.state.problems.values()))

        until(lambda: stated("MB are free for the log"))
        with files_of_at_most(0):
            station.bus.publish(POSITION.key("FF-02"), os.urandom(200_000), Qos.LIVE)
            until(lambda: stated("cannot be written"))
            for _ in range(6):
                station.bus.publish(POSITION.key("FF-02"), os.urandom(200_000), Qos.LIVE)
            until(lambda: stated("records are missing in the log"))
        alarms = [key for key, one in station.pipeline.state.alarms.items() if one.is_open]
        assert alarms == ["station|disk", "station|log"]
