"""The complete segments of a running station's log are packed, each by a process of its own."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from base_station.storage.recorder import Recorder
from base_station.storage.segment_packer import SegmentPacker
from shared.channels import POSITION
from shared.clock import NS_PER_S, SystemClock
from shared.mcap_log import SegmentPolicy, SegmentState, can_be_packed, read_log, rewrite_segment

pytestmark = pytest.mark.slow

T0 = 1_800_000_000 * NS_PER_S
SEGMENTS = 3


@pytest.fixture
def recorder(tmp_path: Path) -> Iterator[Recorder]:
    recorder = Recorder(tmp_path, SystemClock(), SegmentPolicy(segment_s=1.0))
    for number in range(30 * SEGMENTS + 1):
        recorder.write(T0 + number * NS_PER_S // 30, POSITION.key("anna"), bytes(100))
        recorder.flush()
    yield recorder
    recorder.close()


def complete(recorder: Recorder) -> list[Path]:
    return [one.path for one in recorder.segments() if one.state is SegmentState.CLOSED]


def wait_for(holds: Callable[[], bool]) -> None:
    until_s = time.monotonic() + 60.0
    while not holds():
        assert time.monotonic() < until_s, "it did not come to be"
        time.sleep(0.05)


def test_complete_segments_are_packed_and_listed_with_their_new_sizes(recorder: Recorder) -> None:
    records = list(read_log(recorder.folder))
    size_bytes = recorder.log_bytes
    paths = complete(recorder)
    assert len(paths) == SEGMENTS
    assert all(map(can_be_packed, paths))
    with SegmentPacker(recorder):
        wait_for(lambda: not any(map(can_be_packed, paths)))
        wait_for(lambda: recorder.log_bytes == _bytes_in(recorder.folder))
        assert recorder.log_bytes < 0.7 * size_bytes
        rewrite_segment(paths[0], lambda record: [(*record[:2], bytes(300_000))])
        recorder.note_rewritten(paths[0])
        wait_for(lambda: not can_be_packed(paths[0]))
    assert list(read_log(recorder.folder))[30:] == records[30:]
    assert complete(recorder) == paths


def test_segment_that_is_damaged_stays_and_the_others_are_packed(
    recorder: Recorder, caplog: pytest.LogCaptureFixture
) -> None:
    paths = complete(recorder)
    flipped = bytearray(paths[1].read_bytes())
    flipped[len(flipped) // 3] ^= 0xFF
    paths[1].write_bytes(flipped)
    with SegmentPacker(recorder):
        wait_for(lambda: not can_be_packed(paths[2]))
    assert not can_be_packed(paths[0])
    assert paths[1].read_bytes() == flipped
    assert "Traceback" not in caplog.text


def test_segment_waits_for_room_on_the_disk(
    recorder: Recorder, monkeypatch: pytest.MonkeyPatch
) -> None:
    paths = complete(recorder)
    sizes = [path.stat().st_size for path in paths]
    free_bytes = 2 * max(sizes)
    monkeypatch.setattr(Recorder, "disk_free_bytes", property(lambda _: free_bytes))
    packer = SegmentPacker(recorder)
    assert packer._step() > 1.0
    free_bytes = 4 * max(sizes)
    packer._step()
    assert not can_be_packed(paths[0])
    assert [path.stat().st_size for path in paths[1:]] == sizes[1:]


def test_end_of_the_station_leaves_whole_segments(recorder: Recorder) -> None:
    records = list(read_log(recorder.folder))
    with SegmentPacker(recorder):
        time.sleep(0.05)
    assert list(read_log(recorder.folder)) == records


def _bytes_in(folder: Path) -> int:
    return sum(one.stat().st_size for one in folder.glob("*.mcap"))
