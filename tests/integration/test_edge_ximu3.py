"""An agent with an x-IMU3, as a process, before the sensor is connected and after its removal."""

from __future__ import annotations

import time
from collections.abc import Iterator
from contextlib import closing
from pathlib import Path

from shared.bus_zenoh import StationEndpoint, ZenohBus
from shared.channels import COMMAND, ROOT, parse_key
from shared.codec import decode
from shared.messages import EventKind, Message, Position, Status, UnitEvent
from tests.rig.station_command import Agent
from tests.rig.station_process import free_port
from tests.rig.waiting import until
from tests.rig.ximu3_device import TcpDevice, at_rest, paced

SECONDS = 4


def at_its_pace() -> Iterator[bytes]:
    """Every 50 ms what came meanwhile."""
    parts = [b"".join(at_rest(20, first=k)) for k in range(0, 400 * SECONDS, 20)]
    return paced((0.05 * number, part) for number, part in enumerate(parts, start=1))


def test_agent_reports_a_removed_sensor_and_continues(port: int, tmp_path: Path) -> None:
    received: list[Message] = []

    def take(key: str, payload: bytes) -> None:
        channel = parse_key(key)[1]
        if channel is not COMMAND:
            received.append(decode(channel, payload))

    def faults() -> str:
        events = [message for message in list(received) if isinstance(message, UnitEvent)]
        return "\n".join(e.detail for e in events if e.kind is EventKind.SENSOR_FAULT)

    sensor_port = free_port()
    flags = ("--unit", "u1", "--source", f"ximu3:tcp://127.0.0.1:{sensor_port}")
    where = ("--data", str(tmp_path / "data"), "--connect", f"tcp/127.0.0.1:{port}")
    with closing(ZenohBus(StationEndpoint((f"tcp/127.0.0.1:{port}",)))) as station:
        station.subscribe(f"{ROOT}/u1/**", take)
        with Agent(tmp_path / "agent.txt", *flags, *where) as agent:
            until(lambda: received, "the agent without its sensor")
            with closing(TcpDevice(at_its_pace(), port=sensor_port)):
                until(
                    lambda: any(isinstance(one, Position) for one in list(received)), "a position"
                )
            until(lambda: "it has ended the connection" in faults(), "that it is gone")
            until(lambda: "the connection is refused" in faults(), "that it does not come back")
            assert agent.runs()
            assert agent.stop() == 0
    positions = [one for one in received if isinstance(one, Position)]
    assert all(0 < one.header.t_mono_ns < time.monotonic_ns() for one in positions)
    assert any(one.battery == 0.875 for one in received if isinstance(one, Status))
