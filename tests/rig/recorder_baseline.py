"""Throughput of the log alone: the recorder with nothing else beside it."""

from __future__ import annotations

import time
from pathlib import Path
from tempfile import TemporaryDirectory

from base_station.storage.recorder import Recorder
from shared.channels import channel_of
from shared.clock import ManualClock, SystemClock
from shared.codec import encode
from tests.rig.simulated_units import Wearer, unit_names

_UNITS = 100
_TURNS = 70  # different messages of each
_PAUSE_EVERY = 10_000  # messages, so that the queue is not what is measured
_STEP_NS = 5_000  # between two messages: 200,000 a second


def recording_hz(count: int) -> float:
    """Messages of usual kinds a second of processor time, from ``write`` until on the disk."""
    clock = ManualClock()
    wearers = [Wearer(name, clock) for name in unit_names(_UNITS)]
    reported = [wearer.next_message() for _ in range(_TURNS) for wearer in wearers]
    messages = [(channel_of(one).key(one.header.unit_id), encode(one)) for one in reported]
    with TemporaryDirectory(prefix="muster-bench-") as folder:
        recorder = Recorder(Path(folder), SystemClock())
        first_ns, before_s = clock.utc_ns(), time.process_time()
        for number in range(count):
            key, payload = messages[number % len(messages)]
            recorder.write(first_ns + number * _STEP_NS, key, payload)
            if number % _PAUSE_EVERY == 0:
                recorder.flush()
        recorder.close()
        return count / (time.process_time() - before_s)
