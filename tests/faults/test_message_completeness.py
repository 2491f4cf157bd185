"""An agent and a station that are killed in turn: in the end the log has every message once."""

from __future__ import annotations

import random
import sqlite3
import time
from collections import Counter
from contextlib import closing
from functools import partial
from pathlib import Path

from shared.channels import is_backfilled, parse_key
from shared.codec import decode
from shared.mcap_log import read_log
from tests.rig.station_command import Agent, Browser, Command
from tests.rig.station_process import free_port
from tests.rig.waiting import until

UNIT = "anna"
COMPILING_S = 200.0  # the first agent on a machine compiles its tracker
Message = tuple[int, int]  # boot id, sequence number


class Wearable:
    """``muster edge run`` with a simulated wearer; it goes on in the same folder."""

    def __init__(self, folder: Path, bus: str) -> None:
        self._journal = folder / UNIT / "journal.sqlite"
        self._flags = ["--unit", UNIT, "--source", "simulated:search-ground-floor"]
        self._flags += ["--connect", bus, "--data", str(folder)]
        self._output = folder.with_suffix(".txt")
        self._agent: Agent | None = None

    def start(self) -> None:
        self._agent = Agent(self._output, *self._flags)

    def kill(self) -> None:
        if self._agent is not None:
            self._agent.kill()

    def journalled(self) -> set[Message]:
        """All messages of the agent, by its journal."""
        with closing(sqlite3.connect(f"file:{self._journal}?mode=ro", uri=True)) as journal:
            rows = journal.execute(
                "SELECT boot_id, seq FROM message JOIN boot ON boot.number = message.boot"
            ).fetchall()
        return {(boot_id % 2**64, seq) for boot_id, seq in rows}


def logged(data: Path) -> tuple[Counter[Message], int]:
    """Count in the log of each of the unit's messages, and the number fetched from its journal."""
    messages: Counter[Message] = Counter()
    fetched = 0
    for _, key, payload in read_log(data / "log"):
        unit_id, channel = parse_key(key)
        if unit_id == UNIT:
            header = decode(channel, payload).header
            messages[header.boot_id, header.seq] += 1
            fetched += is_backfilled(key)
    return messages, fetched


def has_logged(data: Path, count: int) -> bool:
    return len(logged(data)[0]) >= count


def test_every_message_is_in_the_log_once_after_kills(tmp_path: Path) -> None:
    chance = random.Random(11)
    data, bus = tmp_path / "station", f"tcp/127.0.0.1:{free_port()}"
    serve = ["serve", "--data", str(data), "--listen", bus, "--insecure"]
    serve += ["--http", f"127.0.0.1:{free_port()}"]
    wearable = Wearable(tmp_path / "agent", bus)
    try:
        for count in (20, 40):
            with Command(tmp_path / f"station-{count}.txt", *serve) as station:
                with Browser(station.wait_ready(), data) as browser:
                    browser.call("POST", "/units", json={"unit_id": UNIT})
                wearable.kill()  # nothing the first time
                wearable.start()
                until(partial(has_logged, data, count), "the unit is heard", COMPILING_S)
                time.sleep(chance.random())
                station.kill()
            time.sleep(1.0 + chance.random())  # the unit goes on alone

        with Command(tmp_path / "station-last.txt", *serve) as station:
            station.wait_ready()
            reported = wearable.journalled()
            assert len({boot_id for boot_id, _ in reported}) == 2
            until(lambda: reported <= logged(data)[0].keys(), "the log has all")
            messages, fetched = logged(data)
            assert fetched > 0
            assert [message for message, count in messages.items() if count != 1] == []
    finally:
        wearable.kill()
