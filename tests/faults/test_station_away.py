"""A station that was away for an hour fetches a full journal of that time soon."""

from __future__ import annotations

import time
from collections import Counter
from collections.abc import Callable, Iterator
from contextlib import ExitStack, closing
from pathlib import Path

import pytest

from edge.storage.journal.journal import Journal, JournalRow
from edge.storage.journal.server import JournalServer
from shared.channels import HEARTBEAT, POSITION, alive_key, is_backfilled, parse_key
from shared.clock import NS_PER_S
from shared.codec import decode, encode
from shared.mcap_log import read_log
from shared.messages import Header, Heartbeat, Position
from tests.rig.station_command import Browser, Command, Unit
from tests.rig.station_process import free_port
from tests.rig.waiting import until

U, BOOT = "FF-01", 0xB007
AWAY_S = 3600
POSITIONS_HZ = 5
SOON_S = 30.0  # of a busy machine, which here is the unit and the test, too
MakePosition = Callable[..., Position]


@pytest.fixture
def journal(tmp_path: Path, make_position: MakePosition) -> Iterator[Journal]:
    """As the unit left it: it has said all of it, and nobody was there."""
    began_ns = time.time_ns() - AWAY_S * NS_PER_S
    with closing(Journal(tmp_path / "journal.sqlite", lambda: BOOT, 0, 10**9)) as journal:
        seq = 0
        for second in range(AWAY_S):
            stated: list[JournalRow] = []
            for number in range(POSITIONS_HZ + 1):
                seq += 1
                since_ns = second * NS_PER_S + number * NS_PER_S // POSITIONS_HZ
                header = Header(U, BOOT, seq, since_ns, began_ns + since_ns, 0.01)
                if number < POSITIONS_HZ:
                    position = encode(make_position(header=header))
                    stated.append(JournalRow(seq, POSITION, since_ns, position))
                else:
                    beat = encode(Heartbeat(header, 1, seq))
                    stated.append(JournalRow(seq, HEARTBEAT, since_ns, beat))
            journal.append(stated)
        yield journal


def test_returned_station_has_all_messages_within_seconds(tmp_path: Path, journal: Journal) -> None:
    """The unit says nothing more, or nothing of it gets through: it only holds its link."""
    data, port = tmp_path / "station", free_port()
    serve = ["serve", "--data", str(data), "--listen", f"tcp/127.0.0.1:{port}"]
    serve += ["--http", f"127.0.0.1:{free_port()}"]
    server = JournalServer(U, journal)
    with ExitStack() as held:
        station = held.enter_context(Command(tmp_path / "said.txt", *serve))
        browser = held.enter_context(Browser(station.wait_ready(), data))
        unit = Unit(port, U)
        held.callback(unit.close)
        held.callback(unit.bus.serve(server.key_expression, server.replies).close)
        held.callback(unit.bus.declare_alive(alive_key(U)).close)
        browser.call("POST", "/units", json={"unit_id": U})
        until(lambda: len(logged(data)) == journal.last_seq, "the log has all", SOON_S, 0.5)
        assert station.stop() == 0
    assert set(logged(data).values()) == {1}


def logged(data: Path) -> Counter[int]:
    """Sequence numbers of what was fetched, as often as they are there."""
    found = Counter[int]()
    for _, key, payload in read_log(data / "log"):
        unit_id, channel = parse_key(key)
        if unit_id == U and is_backfilled(key):
            found[decode(channel, payload).header.seq] += 1
    return found
