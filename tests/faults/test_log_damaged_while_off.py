"""Records that a disk lost while the station was off are reported, and fetched from journals
again.
"""

from __future__ import annotations

import os
import shutil
import time
from collections import Counter
from collections.abc import Callable, Iterable, Iterator
from contextlib import ExitStack, closing
from pathlib import Path

import pytest

from edge.storage.journal.journal import Journal, JournalRow
from edge.storage.journal.server import JournalServer
from shared.channels import POSITION, alive_key, parse_key
from shared.clock import SystemClock
from shared.codec import decode, encode
from shared.header_factory import HeaderFactory
from shared.mcap_log import LogRecord, SegmentReader, own_segments, read_log, segment_paths
from shared.messages import Position
from tests.rig.station_command import Browser, Command, Unit
from tests.rig.station_process import free_port
from tests.rig.waiting import until

U = "FF-01"
APART_S = 0.1
SEGMENTS = 5  # with messages; a busy machine takes few messages a second, or all of them at once
MakePosition = Callable[..., Position]


class Site:
    """A unit with all its messages in its journal, and a station whose segments last a second."""

    def __init__(self, folder: Path, journal: Journal, held: ExitStack) -> None:
        self.data, self._port = folder / "station", free_port()
        self._stated, self._held = folder / "said.txt", held
        self._config = folder / "station.toml"
        self._config.write_text(
            f'data = "{self.data}"\n[log]\nsegment_s = 1.0\n'
            f'[bus]\nlisten = ["tcp/127.0.0.1:{self._port}"]\n'
            f'[http]\nlisten = "127.0.0.1:{free_port()}"\n'
        )
        self.journal = journal
        self.messages = 0  # of the unit
        self.start()
        self.unit = Unit(self._port, U)
        held.callback(self.unit.close)
        server = JournalServer(U, journal)
        held.callback(self.unit.bus.serve(server.key_expression, server.replies).close)
        held.callback(self.unit.bus.declare_alive(alive_key(U)).close)
        self.browser.call("POST", "/units", json={"unit_id": U})

    def start(self) -> None:
        self.station = self._held.enter_context(
            Command(self._stated, "serve", "--config", str(self._config))
        )
        self.browser = self._held.enter_context(Browser(self.station.wait_ready(), self.data))

    def logged(self) -> Counter[int]:
        return numbers(read_log(self.data / "log"))

    def has_all(self) -> bool:
        return set(self.logged()) == set(range(1, self.messages + 1))

    def problems(self) -> str:
        until(lambda: self.browser.status("GET", "/health") == 200, "it has begun")
        return "\n".join(self.browser.call("GET", "/health")["problems"])


def numbers(records: Iterable[LogRecord]) -> Counter[int]:
    """Sequence numbers of the unit's messages among these records."""
    found = Counter[int]()
    for _, key, payload in records:
        unit_id, channel = parse_key(key)
        if unit_id == U:
            found[decode(channel, payload).header.seq] += 1
    return found


@pytest.fixture
def site(tmp_path: Path, make_position: MakePosition) -> Iterator[Site]:
    with (
        ExitStack() as held,
        closing(Journal(tmp_path / "journal.sqlite", lambda: 7, 0, 10**9)) as journal,
    ):
        site = Site(tmp_path, journal, held)
        header_factory = HeaderFactory(U, 7, SystemClock())
        while len(with_messages(site)) < SEGMENTS:
            position = make_position(header=header_factory.header())
            header = position.header
            journal.append([JournalRow(header.seq, POSITION, header.t_mono_ns, encode(position))])
            site.unit.say(position)
            site.messages += 1
            time.sleep(APART_S)
        until(site.has_all, "all of it is in the log", poll_interval_s=0.5)
        time.sleep(1.5)  # the last of it is not in the newest segment
        assert site.station.stop() == 0
        yield site


def with_messages(site: Site) -> dict[Path, set[int]]:
    """Complete segments with messages of the unit, and the numbers of these."""
    found = {}
    for path in segment_paths(site.data / "log")[:-1]:
        with SegmentReader(path) as reader:
            if within := set(numbers(reader.records())):
                found[path] = within
    return found


def test_truncated_emptied_or_exchanged_segments_are_reported(site: Site, tmp_path: Path) -> None:
    messages_of = with_messages(site)
    cut, zeroed, exchanged, gone, *_ = messages_of
    with SegmentReader(cut) as reader:
        os.truncate(cut, reader._contents.chunks[-1].offset + 20)
    zeroed.write_bytes(bytes(zeroed.stat().st_size))
    shutil.copy(segment_paths(site.data / "log")[-1], exchanged)
    gone.unlink()
    lost = set(range(1, site.messages + 1)) - set(site.logged()) - messages_of[cut]
    assert lost == messages_of[zeroed] | messages_of[exchanged] | messages_of[gone]
    site.start()
    damaged = {path.name for path in (cut, zeroed, exchanged, gone)}
    # The contents are read after the start, segment by segment.
    until(lambda: all(name in site.problems() for name in damaged), "all four are reported")
    assert "is missing: what happened from 20" in site.problems()
    until(site.has_all, "what is lost is fetched again", poll_interval_s=0.5)
    assert site.station.stop() == 0
    assert set(site.logged().values()) == {1}
    site.start()
    assert gone.name in site.problems(), "it is said as long as it is so"


def test_missing_log_is_reported_and_backfilled(site: Site) -> None:
    shutil.rmtree(site.data / "log")
    site.start()
    assert "is missing" in site.problems()
    assert [one["unit_id"] for one in site.browser.call("GET", "/units")] == [U]
    until(site.has_all, "all is fetched again", poll_interval_s=0.5)
    assert site.station.stop() == 0
    own, foreign = own_segments(site.data / "log")
    assert own
    assert not foreign
    site.start()  # and takes what there is for its own
    assert "is missing" in site.problems()
