"""A recorded walk encoded as messages of an x-IMU3 is tracked to the path of the recording."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from edge.app.track import run_tracker
from edge.samples import ImuBatch
from edge.sources.recording import RecordingSource
from edge.sources.transport.address import TransportAddress
from edge.sources.ximu3.source import Ximu3Source
from shared.clock import ManualClock
from tests.rig.ximu3_device import played

CHUNK = 16  # messages that come at once


class PlayedLine:
    """Line that plays a recording in real time; at its end the source is closed."""

    def __init__(self, imu: ImuBatch, binary: bool) -> None:
        self.clock = ManualClock()
        self.clock.advance(1000.0)
        self.source = Ximu3Source("/dev/played", self.clock)
        reported = list(played(imu, binary))
        self._chunks = [reported[k : k + CHUNK] for k in range(0, len(reported), CHUNK)]
        self._now_s = 0.0

    def read(self) -> bytes | None:
        if not self._chunks:
            self.source.close()
            return None
        chunk = self._chunks.pop(0)
        due_s = chunk[-1][0]
        self.clock.advance(max(0.0, due_s - self._now_s))
        self._now_s = max(self._now_s, due_s)
        return b"".join(message for _, message in chunk)

    def close(self) -> None:
        """Nothing is held open."""


@pytest.mark.parametrize("binary", [False, True])
def test_decoded_path_agrees_with_the_recording(
    binary: bool, walks: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    recording = RecordingSource(walks / "xio" / "short_walk")
    line = PlayedLine(recording.imu, binary)
    monkeypatch.setattr(TransportAddress, "open", lambda _: line)
    live = run_tracker(line.source, "eskf", quiet=True)
    meant = run_tracker(recording, "eskf", quiet=True)
    distinct = len(np.unique(recording.imu.t_ns))
    assert line.source.taken == distinct
    assert line.source.repeated == len(recording.imu) - distinct
    assert (line.source.garbled, line.source.take_faults()) == (0, ())
    assert live.steps[-1] == meant.steps[-1]
    since_s, meant_s = ((t - t[0]) * 1e-9 for t in (live.t_ns, meant.t_ns))
    for axis in range(3):
        there_m = np.interp(meant_s, since_s, live.position_n_m[:, axis])
        off_m = np.abs(there_m - meant.position_n_m[:, axis])
        assert off_m[meant.stationary].max() < 0.03
        assert off_m.max() < 0.1  # in the air a stamp that is put right otherwise shows more
