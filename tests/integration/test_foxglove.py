"""A client of Foxglove's protocol sees a station live, and plays, pauses and seeks a replay."""

from __future__ import annotations

import time
from collections.abc import Iterator
from contextlib import ExitStack
from pathlib import Path
from threading import Event, Thread

import pytest
from foxglove_schemas_protobuf.Log_pb2 import Log
from typer.testing import CliRunner

from base_station.cli import app
from base_station.foxglove.live import follow
from base_station.foxglove.replay import LogReplay
from base_station.foxglove.server import EVERY_ALARM, FoxgloveServer
from shared.channels import POSITION, TICK
from shared.clock import NS_PER_S
from shared.mcap_log import PLAN_TOPIC, SegmentWriter, location_topic, log_topic
from shared.messages import STATION_ID
from tests.rig.foxglove_client import (
    ENDED,
    PAUSE,
    PAUSED,
    PLAY,
    PLAYING,
    FoxgloveClient,
    foxglove_client,
)
from tests.rig.logged_walk import DURATION_S, walk_with_mayday
from tests.rig.program import launch_installed
from tests.rig.station_process import free_port
from tests.rig.waiting import until

PLACE, ALARMS = location_topic("FF-01"), log_topic("FF-01")
POSITIONS = POSITION.key("FF-01")


@pytest.fixture
def closing() -> Iterator[ExitStack]:
    with ExitStack() as stack:
        yield stack


def write_walk(folder: Path) -> tuple[int, int]:
    """The window of the records."""
    records = walk_with_mayday()
    writer = SegmentWriter(folder)
    for t_ns, key, payload in records:
        writer.write(t_ns, key, payload)
    writer.close()
    return records[0][0], records[-1][0]


def serve_replay(log: Path, window_ns: tuple[int, int], closing: ExitStack) -> FoxgloveClient:
    server = FoxgloveServer("127.0.0.1", 0, "test", window_ns)
    closing.callback(server.close)
    stop = Event()

    def run() -> None:
        replay = LogReplay(log, window_ns, server, time.monotonic_ns(), print)
        while not stop.is_set():
            if not replay.step(time.monotonic_ns()):
                stop.wait(0.01)

    thread = Thread(target=run)
    thread.start()
    closing.callback(thread.join)
    closing.callback(stop.set)
    return closing.enter_context(foxglove_client(server.port))


def test_client_gets_recorded_messages_and_first_the_newest(
    tmp_path: Path, closing: ExitStack
) -> None:
    writer = SegmentWriter(tmp_path)
    t_ns = time.time_ns()
    for topic, payload in (
        (PLAN_TOPIC, b"an older plan"),
        (PLAN_TOPIC, b"the plan"),
        (ALARMS, Log(message="a mayday").SerializeToString()),
    ):
        writer.write(t_ns, topic, payload, urgent=True)
    server = FoxgloveServer("127.0.0.1", 0, "test")
    closing.callback(server.close)
    stop = Event()
    following = Thread(target=follow, args=(tmp_path, server, stop))
    following.start()
    closing.callback(following.join)
    closing.callback(stop.set)
    client = closing.enter_context(foxglove_client(server.port))
    received = client.received
    until(lambda: {PLAN_TOPIC, ALARMS, EVERY_ALARM} <= client.receive().topics())
    until(lambda: all(map(client.receive().on, (PLAN_TOPIC, EVERY_ALARM))))
    assert {payload for _, payload in received.on(PLAN_TOPIC)} == {b"the plan"}
    assert Log.FromString(received.on(EVERY_ALARM)[0][1]).message == "a mayday"

    writer.write(t_ns + 1, PLACE, b"a place", urgent=True)
    until(lambda: client.receive().on(PLACE))
    assert set(received.on(PLACE)) == {(t_ns + 1, b"a place")}
    writer.close()


def test_the_time_bar_plays_pauses_and_seeks(tmp_path: Path, closing: ExitStack) -> None:
    window_ns = write_walk(tmp_path)
    client = serve_replay(tmp_path, window_ns, closing)
    received = client.received
    until(lambda: client.receive().info)
    assert "playbackControl" in received.info["capabilities"]
    start = received.info["dataStartTime"]
    assert start["sec"] * NS_PER_S + start["nsec"] == window_ns[0]
    until(lambda: client.receive().topics())
    assert set(received.times_ns) <= {window_ns[0]}  # paused

    middle_ns = (window_ns[0] + window_ns[1]) // 2
    client.control(PAUSE, seek_ns=middle_ns, request="seek")
    until(lambda: client.receive().on(POSITIONS))
    sought = received.states[-1]
    assert (sought.status, sought.at_ns, sought.did_seek) == (PAUSED, middle_ns, True)
    assert sought.request_id == "seek"
    assert 0 <= middle_ns - received.on(POSITIONS)[-1][0] <= NS_PER_S  # as it stood there

    before = len(received.on(POSITIONS))
    client.control(PLAY, speed=50.0, request="play")
    until(lambda: client.receive().states[-1].status == ENDED)
    assert received.states[-2].status == PLAYING
    played = [t_ns for t_ns, _ in received.on(POSITIONS)[before:] if t_ns > middle_ns]
    assert played == [t for t, key, _ in walk_with_mayday() if key == POSITIONS and t > middle_ns]
    assert received.times_ns == sorted(received.times_ns)
    assert received.times_ns[-1] == window_ns[1]

    client.control(PLAY, speed=1.0, request="again")
    until(lambda: client.receive().states[-1].request_id == "again")
    assert (received.states[-1].at_ns, received.states[-1].did_seek) == (window_ns[0], True)


def test_the_command_replays_an_incident_of_a_log_without_a_database(
    tmp_path: Path, closing: ExitStack
) -> None:
    window_ns = write_walk(tmp_path / "log")
    port, output = free_port(), tmp_path / "output"
    arguments = ["foxglove", "replay", "i1", "--data", str(tmp_path)]
    program = launch_installed(
        "base_station", [*arguments, "--listen", f"127.0.0.1:{port}"], output
    )
    closing.callback(program.wait)
    closing.callback(program.kill)
    until(lambda: f"ready ws://127.0.0.1:{port}" in output.read_text())
    client = closing.enter_context(foxglove_client(port))
    until(lambda: client.receive().info)
    until(lambda: TICK.key(STATION_ID) in client.receive().topics())
    client.control(PLAY, speed=100.0)
    until(lambda: client.receive().states and client.received.states[-1].status == ENDED)
    ticks = client.received.on(TICK.key(STATION_ID))
    assert len(ticks) == DURATION_S
    assert ticks[-1][0] == window_ns[1]


def test_command_writes_a_layout_with_all_units_of_the_log(tmp_path: Path) -> None:
    write_walk(tmp_path / "log")
    out = tmp_path / "layout.json"
    arguments = ["foxglove", "layout", str(out), "--data", str(tmp_path)]
    result = CliRunner().invoke(app, arguments, catch_exceptions=False)
    assert "1 unit(s)" in result.output
    assert "FF-01" in out.read_text()


@pytest.mark.parametrize("command", [["live"], ["replay", "i1"]])
def test_other_machines_are_refused_unless_that_is_accepted(command: list[str]) -> None:
    result = CliRunner().invoke(app, ["foxglove", *command, "--listen", "0.0.0.0:0"])
    assert result.exit_code != 0
    assert "without a login" in str(result.exception)


def test_a_missing_library_is_named_with_its_remedy(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("base_station.foxglove.library.find_spec", lambda _: None)
    result = CliRunner().invoke(app, ["foxglove", "live"])
    assert "requirements-foxglove.lock" in str(result.exception)
