"""``kill -9`` of a program that writes its black box: at most a second of samples is lost."""

from __future__ import annotations

import os
import random
import signal
import subprocess
import sys
import time
from pathlib import Path

from edge.sources.black_box import BlackBoxSource
from shared.clock import NS_PER_S

# Records in real time, and tells the time of the newest sample that it has handed over.
WRITER = """
import sys, time
from pathlib import Path
from edge.storage.black_box.black_box import BlackBox
from edge.sample_codec.codec import SampleEncoder
from edge.sample_codec.descriptions import unit_sensor
from edge.sources.registry import open_source
from shared.clock import SystemClock
source = open_source("simulated:straight")
raw = SampleEncoder("u1", 7)
description = raw.description(0, (unit_sensor("", source.description),), source="", tracker="")
box = BlackBox(Path(sys.argv[1]), description, 10**9, SystemClock())
started = time.monotonic()
for batch in source.batches():
    t_ns = int(batch.imu.t_ns[-1])
    time.sleep(max(0.0, started + t_ns / 1e9 - time.monotonic()))
    box.write(raw.messages(batch))
    print(t_ns, flush=True)
"""


def kill_a_writer(folder: Path, after_s: float) -> int:
    """Time of the newest sample that was handed to the black box."""
    writer = subprocess.Popen(
        [sys.executable, "-c", WRITER, str(folder)], stdout=subprocess.PIPE, text=True
    )
    assert writer.stdout is not None
    writer.stdout.readline()
    time.sleep(after_s)
    os.kill(writer.pid, signal.SIGKILL)
    reported = writer.stdout.read().split()
    writer.stdout.close()
    writer.wait()
    return int(reported[-2])  # the last one may be cut


def test_at_most_a_second_of_samples_is_lost(tmp_path):
    rng = random.Random(11)
    for number in range(3):
        folder = tmp_path / str(number)
        handed_over_ns = kill_a_writer(folder, rng.uniform(1.5, 3.0))
        (boot,) = folder.iterdir()
        batches = list(BlackBoxSource(boot).batches())
        assert batches[0].imu.t_ns[0] == 0
        assert handed_over_ns - int(batches[-1].imu.t_ns[-1]) <= NS_PER_S
