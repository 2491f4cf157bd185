"""A unit that only posts samples, over a station that is killed: it moves on the map, and the log
has every acknowledged sample once.
"""

from __future__ import annotations

import json
import time
import urllib.error
import urllib.request
from collections import Counter
from functools import partial
from itertools import islice
from math import dist
from pathlib import Path
from typing import Any

from google.protobuf.internal.encoder import _VarintBytes  # type: ignore[attr-defined]  # untyped

from edge.sample_codec.codec import raw_imu
from edge.sources.registry import open_source
from shared.channels import IMU, parse_key
from shared.codec import encode
from shared.mcap_log import read_log
from shared.messages import Header, RawImu
from tests.rig.loaded_program import launch_loaded
from tests.rig.pacing import PATIENCE_S
from tests.rig.program import end_hard
from tests.rig.station_process import StationProcess, free_port, station_process
from tests.rig.waiting import until

U, BOOT = "PHONE-1", 4711
WALK = "simulated:search-ground-floor"
WALKS_S = 30
SPEED = 3.0  # as fast as it was walked
WALKED_M = 15.0  # from its start; the second half of the walk leads there
COMPILING_S = 200.0  # the first agent on a machine compiles its tracker


def walk() -> list[RawImu]:
    """The samples of the walk, 50 ms a message."""
    batches = islice(open_source(WALK).batches(), WALKS_S * 20)
    return [
        raw_imu(Header(U, BOOT, seq, int(batch.imu.t_ns[0])), batch.imu)
        for seq, batch in enumerate(batches, start=1)
    ]


def delimited(messages: list[RawImu]) -> bytes:
    payloads = map(encode, messages)
    return b"".join(_VarintBytes(len(payload)) + payload for payload in payloads)


class Node:
    """A node that keeps what is not acknowledged, and sends it again."""

    def __init__(self, token: str) -> None:
        self._token = token
        self.url = ""
        self.acknowledged: list[RawImu] = []
        self.repeated = 0

    def post(self, messages: list[RawImu]) -> bool:
        """True once it is acknowledged."""
        request = urllib.request.Request(  # our own station's address
            f"{self.url}/api/v1/units/{U}/samples",
            data=delimited(messages),
            headers={
                "Content-Type": "application/x-protobuf",
                "Authorization": f"Bearer {self._token}",
            },
        )
        try:
            with urllib.request.urlopen(request, timeout=PATIENCE_S) as answer:
                receipt = json.load(answer)
        except (urllib.error.URLError, ConnectionError):
            return False
        assert receipt["accepted"] + receipt["repeated"] == len(messages)
        self.repeated += receipt["repeated"]
        self.acknowledged += messages
        return True

    def walk(self, messages: list[RawImu]) -> None:
        """Post a second at a time, as time goes by."""
        for first in range(0, len(messages), 20):
            until(partial(self.post, messages[first : first + 20]), "an acknowledgement")
            time.sleep(1.0 / SPEED)


def track(station: StationProcess) -> list[dict[str, Any]]:
    points: list[dict[str, Any]] = station.api.get(f"/units/{U}/track")["points"]
    return points


def moved_m(points: list[dict[str, Any]]) -> float:
    """Distance from the first position."""
    places = [(point["north_m"], point["east_m"]) for point in points]
    return max((dist(places[0], place) for place in places), default=0.0)


def test_acknowledged_samples_are_tracked_and_survive_a_kill(tmp_path: Path) -> None:
    address = f"tcp/127.0.0.1:{free_port()}"
    data, messages = tmp_path / "station", walk()
    data.mkdir()
    half = len(messages) // 2
    following = ["run", "--source", f"bus:{U}", "--connect", address]
    agent = launch_loaded(
        "edge", [*following, "--data", str(tmp_path / "agent")], tmp_path / "agent.txt"
    )
    try:
        with station_process(data, address, launch=launch_loaded) as station:
            station.api.post("/units", {"unit_id": U})
            made = station.api.post(f"/units/{U}/sample-tokens", {})
            node = Node(made["token"])
            node.url = station.api.origin
            until(lambda: "waiting for the raw stream" in agent_output(tmp_path), "the agent")
            node.walk(messages[:half])
            until(lambda: track(station), "it is on the map", COMPILING_S)
        # The station is killed here; it had perhaps taken what it did not acknowledge.
        assert not node.post(messages[half : half + 20])
        with station_process(data, address, launch=launch_loaded) as station:
            node.url = station.api.origin
            assert node.post(messages[half - 40 : half])  # the node has missed the answer, say
            assert node.repeated == 40
            node.walk(messages[half:])
            until(lambda: moved_m(track(station)) > WALKED_M, "it moves", COMPILING_S)
            assert station.stop() == 0
    finally:
        end_hard(agent)
    logged = logged_samples(data / "log")
    assert set(logged.values()) == {1}
    assert logged.keys() == {encode(message) for message in node.acknowledged}


def agent_output(folder: Path) -> str:
    return (folder / "agent.txt").read_text()


def logged_samples(log: Path) -> Counter[bytes]:
    """Count in the log of each message of raw samples."""
    return Counter(payload for _, key, payload in read_log(log) if parse_key(key) == (U, IMU))
