"""An agent with two sensors on one person, of which one dies, on a real Zenoh router."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import closing
from pathlib import Path

import numpy as np
import pytest

from edge.samples import ImuBatch
from edge.sources.black_box import BlackBoxSource
from edge.sources.registry import open_sensors, open_source
from edge.storage.journal.journal import Journal
from shared.bus_zenoh import StationEndpoint, ZenohBus
from shared.channels import ROOT, parse_key
from shared.codec import decode
from shared.messages import EventKind, Message, Position, Status, UnitDescription, UnitEvent
from tests.rig.station_command import Agent
from tests.rig.waiting import until

FOOT_DIES_S, BACK_DIES_S = 8.0, 20.0
WALK = "simulated:search-ground-floor?seed=3"
COLUMNS = "t_s,accel_x_mps2,accel_y_mps2,accel_z_mps2,gyro_x_radps,gyro_y_radps,gyro_z_radps"


@pytest.fixture
def messages(port: int) -> Iterator[list[Message]]:
    """Messages of the unit."""
    received: list[Message] = []
    with closing(ZenohBus(StationEndpoint((f"tcp/127.0.0.1:{port}",)))) as bus:
        bus.subscribe(
            f"{ROOT}/u1/**", lambda key, data: received.append(decode(parse_key(key)[1], data))
        )
        yield received


def recording(folder: Path, name: str, end_s: float) -> Path:
    """Write what one sensor of a simulated person samples, until it dies."""
    sources = {"foot": WALK, "lower_back": WALK}
    parts: list[ImuBatch] = []
    for batch in open_sensors(sources, {one: one for one in sources}).batches():
        if batch.imu.t_ns[0] >= end_s * 1e9:
            break
        if batch.sensor == name:
            parts.append(batch.imu)
    rows = np.vstack(
        [np.column_stack((one.t_ns * 1e-9, one.accel_mps2, one.gyro_radps)) for one in parts]
    )
    path = folder / f"{name}.csv"
    np.savetxt(path, rows, delimiter=",", header=COLUMNS, comments="")
    return path


def details(messages: list[Message], kind: EventKind) -> list[str]:
    return [one.detail for one in messages if isinstance(one, UnitEvent) and one.kind is kind]


def journalled(path: Path) -> list[Message]:
    """Return all that the unit has published, also before its link was made."""
    with closing(Journal(path, lambda: 1, 0, 10**9)) as journal:
        (boot, *_) = journal.boots()
        return [
            decode(parse_key(f"{ROOT}/u1/{one.suffix}")[1], one.payload)
            for one in journal.read(boot.boot_id, 1, boot.last_seq)
        ]


def test_unit_continues_with_one_of_two_sensors(
    port: int, tmp_path: Path, messages: list[Message]
) -> None:
    foot = recording(tmp_path, "foot", FOOT_DIES_S)
    back = recording(tmp_path, "lower_back", BACK_DIES_S)
    agent = Agent(
        tmp_path / "agent.txt",
        *("--unit", "u1", "--data", str(tmp_path / "data"), "--speed", "4"),
        *("--sensor", f"foot=recording:{foot}", "--sensor", f"lower_back=recording:{back}"),
        *("--tracker", "eskf", "--connect", f"tcp/127.0.0.1:{port}"),
    )
    try:
        until(lambda: not agent.runs(), "the end of the walk")
        gone = "foot has given no samples for 2 s; lower_back goes on"
        until(lambda: gone in details(messages, EventKind.SENSOR_FAULT), "the foot is missed")
    finally:
        agent.kill()
        print(agent.output())
    kept_messages = journalled(tmp_path / "data" / "u1" / "journal.sqlite")
    description = next(one for one in kept_messages if isinstance(one, UnitDescription))
    assert [(one.name, one.place) for one in description.sensors] == [
        ("foot", "foot"),
        ("lower_back", "lower_back"),
    ]
    faults = details(kept_messages, EventKind.SENSOR_FAULT)
    for fault in faults:
        assert f"SENSOR_FAULT: {fault}" in agent.output(), "a person at the unit reads it, too"
    assert "tracker eskf tracks by foot; lower_back is recorded only" in faults
    assert "foot: its source has no more" in faults
    tracked = [one for one in kept_messages if isinstance(one, Position)]
    assert tracked[-1].distance_m > 3.0
    statuses = [one for one in kept_messages if isinstance(one, Status)]
    last_ns, tracked_ns = statuses[-1].header.t_mono_ns, tracked[-1].header.t_mono_ns
    assert last_ns - tracked_ns > 1_000_000_000, "the back still says that its wearer moves"
    (boot,) = (tmp_path / "data" / "u1" / "black_box").iterdir()
    kept: dict[str, list[ImuBatch]] = {"foot": [], "lower_back": []}
    for batch in BlackBoxSource(boot).batches():
        kept[batch.sensor].append(batch.imu)
    for name, path in (("foot", foot), ("lower_back", back)):
        samples = sum(len(one.imu) for one in open_source(f"recording:{path}").batches())
        assert sum(map(len, kept[name])) == samples
