"""Lines of a reader of beacons, and such a reader beside a source."""

from __future__ import annotations

import math
import os
import socket
import threading
import time
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from edge.agent.source_reader import SourceReader
from edge.path_loss import FURTHEST_M, NEAREST_M, POWER_DBM, SHADOWING_DB, range_of
from edge.samples import ImuBatch, SensorBatch, SensorDescription, SightingSample
from edge.sources.interface import Outage
from edge.sources.sighting_format import sighting_of
from edge.sources.sighting_reader import SightingReader, open_reader
from shared.clock import SystemClock
from shared.errors import ConfigError, WireError
from tests.rig.waiting import PATIENCE_S


def test_a_line_says_what_was_seen_and_how_far_away() -> None:
    seen = sighting_of("beacon door-3 range=2.4 std=0.3\r", 7)
    assert seen == SightingSample(7, "beacon", "door-3", 2.4, 0.3)
    tag = sighting_of("tag 04:A2:B9", 7)
    assert tag is not None
    assert (tag.kind, tag.seen_id) == ("tag", "04:A2:B9")
    assert math.isnan(tag.range_m)
    assert math.isnan(tag.range_std_m)


def test_loudness_is_a_range_that_is_hardly_known() -> None:
    near, far = (sighting_of(f"beacon b rssi={rssi}", 0) for rssi in (-59, -81))
    assert near is not None
    assert far is not None
    assert near.range_m == pytest.approx(1.0)
    assert far.range_m == pytest.approx(10.0)
    assert far.range_std_m == pytest.approx(10.0 * near.range_std_m)
    louder = sighting_of("beacon b rssi=-81 power=-70", 0)
    assert louder is not None
    assert louder.range_m < far.range_m


def test_a_range_that_was_measured_goes_before_one_that_is_guessed() -> None:
    seen = sighting_of("unit FF-02 rssi=-40 range=3", 0)
    assert seen is not None
    assert seen.range_m == 3.0


@pytest.mark.parametrize("line", ["", "   ", "# a reader that introduces itself"])
def test_a_line_may_say_nothing(line: str) -> None:
    assert sighting_of(line, 0) is None


@pytest.mark.parametrize(
    ("line", "why"),
    [
        ("beacon", "an id"),
        ("door-3 range=2", "begins with beacon"),
        ("beacon ../etc range=2", "no id"),
        ("beacon b range=far", "no number"),
        ("beacon b range=nan", "no number"),
        ("beacon b range=-1", "0 to 1000"),
        ("beacon b range=1e9", "0 to 1000"),
        ("beacon b std=-1", "not negative"),
        ("beacon b rssi=900", "rssi=900 is no level in dBm"),
        ("beacon b rssi=-71 power=59", "power=59 is no level in dBm"),  # the sign is missing
        ("beacon b rssi=-71 power=1e9", "power=1e.09 is no level in dBm"),
        ("beacon b colour=3", "known are"),
        ("beacon b " + "x" * 300, "longer"),
    ],
)
def test_a_line_that_cannot_be_used_says_why(line: str, why: str) -> None:
    with pytest.raises(WireError, match=why):
        sighting_of(line, 0)


@pytest.mark.slow
@given(st.text(max_size=300))
def test_whatever_a_reader_says_it_is_a_sighting_or_a_reason(line: str) -> None:
    try:
        seen = sighting_of(line, 0)
    except WireError:
        return
    assert seen is None or seen.seen_id


@given(st.floats(-120.0, 20.0), st.floats(-100.0, 0.0))
def test_every_loudness_is_a_range(rssi_dbm: float, power_dbm: float) -> None:
    range_m, std_m = range_of(rssi_dbm, power_dbm)
    assert NEAREST_M <= range_m <= FURTHEST_M
    assert std_m > 0.0


@pytest.mark.parametrize(("quieter_db", "wanted_m"), [(0.0, 1.0), (22.0, 10.0), (11.0, 3.162)])
def test_a_range_is_as_unsure_as_a_body_in_the_way_makes_it(
    quieter_db: float, wanted_m: float
) -> None:
    range_m, std_m = range_of(POWER_DBM - quieter_db)
    assert range_m == pytest.approx(wanted_m, rel=1e-3)
    behind_person_m, _ = range_of(POWER_DBM - quieter_db - SHADOWING_DB)
    assert math.log(behind_person_m / range_m) == pytest.approx(std_m / range_m)


@pytest.mark.parametrize(
    "text",
    [
        "tcp:",
        "tcp:host",
        "tcp:host:0",
        "tcp:host:70000",
        "tcp::80",
        "tcp:no..name:80",
        "tcp:host:80/door",
    ],
)
def test_device_that_is_no_reader_is_refused(text: str) -> None:
    with pytest.raises(ConfigError, match="tcp:HOST:PORT"):
        open_reader(text)


class Still:
    """A sensor that lies on a table and is asked every tenth of a second."""

    def __init__(self, *, is_live: bool) -> None:
        self.is_live = is_live
        self.closed = threading.Event()
        self.description = SensorDescription("table", 10.0)
        self.radio_outages: tuple[Outage, ...] = ()

    def batches(self) -> Iterator[SensorBatch]:
        for t_ns in range(0, 10**12, 10**8):
            if self.closed.wait(0.02):
                return
            imu = ImuBatch(np.array([t_ns]), np.zeros((1, 3)), np.zeros((1, 3)))
            yield SensorBatch(imu)

    def close(self) -> None:
        self.closed.set()


def beside(reader: SightingReader, *, is_live: bool) -> SourceReader:
    return SourceReader(Still(is_live=is_live), SystemClock(), 1.0, (reader,))


def sightings(source: SourceReader, count: int) -> list[tuple[SensorBatch, SightingSample]]:
    """The first ones, each with the batch with which it came."""
    found: list[tuple[SensorBatch, SightingSample]] = []
    until = time.monotonic() + PATIENCE_S
    source.start()
    while len(found) < count and time.monotonic() < until:
        timed = source.take(0.1)
        if timed is not None:
            batch = timed.batch
            found += [(batch, one) for one in batch.others if isinstance(one, SightingSample)]
    source.close()
    return found


def test_a_pipes_sightings_come_with_the_batches(tmp_path: Path) -> None:
    """Halves of lines and nonsense between them cost nothing else."""
    pipe = tmp_path / "reader"
    os.mkfifo(pipe)
    reader = SightingReader(str(pipe), SystemClock())

    def talk() -> None:
        with pipe.open("wb", buffering=0) as writer:
            for part in (b"beacon do", b"or-3 range=2\n\xff\xfe\n", b"tag t1\n"):
                writer.write(part)

    threading.Thread(target=talk, daemon=True).start()
    found = sightings(beside(reader, is_live=False), 2)
    assert [one.seen_id for _, one in found] == ["door-3", "t1"]
    assert all(one.t_ns == int(batch.imu.t_ns[-1]) for batch, one in found)
    assert reader.bad_lines == 1


@pytest.mark.parametrize("slashes", ["", "//"])
def test_a_reader_that_is_gone_is_opened_again(slashes: str) -> None:
    with socket.create_server(("127.0.0.1", 0)) as server:

        def talk() -> None:
            for name in ("one", "two"):
                connection, _ = server.accept()
                with connection:
                    connection.sendall(f"beacon {name} range=1\n".encode())

        threading.Thread(target=talk, daemon=True).start()
        port = server.getsockname()[1]
        reader = SightingReader(f"tcp:{slashes}127.0.0.1:{port}", SystemClock())
        found = sightings(beside(reader, is_live=True), 2)
    assert [one.seen_id for _, one in found] == ["one", "two"]
    assert 0 < found[0][1].t_ns <= time.monotonic_ns()


def test_missing_reader_is_reported_once_until_it_returns(caplog) -> None:
    reader = SightingReader("/dev/nowhere", SystemClock())
    cable_is_out = FileNotFoundError(2, "No such file or directory")
    reader.on_close(cable_is_out)
    reader.on_close(cable_is_out)
    reader.on_close(None)  # whoever said the last line has closed a pipe, as is usual
    assert len(caplog.records) == 1
    reader.on_open()
    reader.on_close(cable_is_out)
    assert [one.levelname for one in caplog.records].count("WARNING") == 2


def test_a_reader_that_is_closed_reads_no_more(tmp_path: Path) -> None:
    before = set(threading.enumerate())
    reader = SightingReader(str(tmp_path / "nowhere"), SystemClock())
    reader.start()
    reader.close()
    assert set(threading.enumerate()) <= before


def test_a_reader_that_is_not_there_delays_nothing(tmp_path: Path) -> None:
    source = beside(SightingReader(str(tmp_path / "nowhere"), SystemClock()), is_live=True)
    source.start()
    timed = [source.take(PATIENCE_S) for _ in range(3)]
    assert all(one is not None and one.batch.others == () for one in timed)
    source.close()
