"""A file in the folder of a log that is none of its segments is left out, and named."""

from __future__ import annotations

import shutil
from contextlib import closing
from pathlib import Path

import pytest
from mcap.writer import Writer

from base_station.engine.feed import LogFeed
from base_station.storage.data_folder import DataFolder
from base_station.storage.recorder import Recorder
from shared.clock import NS_PER_S, ManualClock
from shared.mcap_log import SegmentPolicy, SegmentWriter, own_segments, segment_path, segment_paths
from tests.rig.small_log import KEY, T0_NS

SEGMENTS, EACH = 4, 10


def written(folder: Path, began_ns: int, segments: int = SEGMENTS) -> Path:
    with closing(SegmentWriter(folder, SegmentPolicy(segment_s=float(EACH)))) as log:
        for second in range(segments * EACH):
            log.write(began_ns + second * NS_PER_S, KEY, b"%d" % second)
    return folder


@pytest.fixture
def data(tmp_path: Path) -> DataFolder:
    written(tmp_path / "log", T0_NS)
    return DataFolder(tmp_path)


def elsewhere(tmp_path: Path, after_s: int) -> Path:
    """A segment of another station, ``after_s`` later."""
    return segment_paths(written(tmp_path / "other", T0_NS + after_s * NS_PER_S, 1))[0]


def by_others(path: Path) -> Path:
    """What any program may write, of the time that its name says."""
    with path.open("wb") as file:
        writer = Writer(file)
        writer.start(profile="ros2")
        channel = writer.register_channel("/imu", "json", 0)
        writer.add_message(channel, T0_NS, b"{}", T0_NS)
        writer.finish()
    return path


def seconds(data: DataFolder, told: list[str]) -> list[int]:
    return [int(payload) for _, _, payload in LogFeed(data.log, on_damage=told.append).records()]


def test_what_stands_in_the_place_of_a_segment(data: DataFolder, tmp_path: Path) -> None:
    own = segment_paths(data.log)
    shutil.copy(elsewhere(tmp_path, 6000), own[1])
    told: list[str] = []
    assert seconds(data, told) == [*range(10), *range(20, 40)]
    assert told == [
        f"{own[1].name} is no segment of this log and is left out: its records begin at "
        "2023-11-14 23:53:20 UTC, which is not when its name says"
    ]
    assert max(one.end_ns for one in data.segments()) == T0_NS + 39 * NS_PER_S


@pytest.mark.parametrize("number", [1, 3, 99])
@pytest.mark.parametrize("after_s", [-6000, 6000])
def test_what_stands_beside_the_segments_under_a_name_of_its_own(
    number: int, after_s: int, data: DataFolder, tmp_path: Path
) -> None:
    """Only behind all others a later one is as the log may have gone on."""
    own = segment_paths(data.log)
    beside = segment_path(data.log, number, T0_NS + after_s * NS_PER_S)
    shutil.copy(elsewhere(tmp_path, after_s), beside)
    if number == 99 and after_s > 0:
        assert own_segments(data.log) == ([*own, beside], {})
        return
    assert own_segments(data.log) == (own, {beside: "its name does not go with the others"})
    assert seconds(data, []) == [*range(40)]


def test_what_another_program_wrote(data: DataFolder) -> None:
    beside = by_others(segment_path(data.log, 5, T0_NS + 60 * NS_PER_S))
    told: list[str] = []
    assert seconds(data, told) == [*range(40)]
    assert "written by another program (ros2)" in told[0]
    assert own_segments(data.log)[1].keys() == {beside}


def test_a_station_that_starts_beside_one_goes_on_and_its_clock_too(
    data: DataFolder, tmp_path: Path
) -> None:
    own = segment_paths(data.log)
    shutil.copy(elsewhere(tmp_path, 6000), own[-1])
    with closing(Recorder(data.path, ManualClock())) as recorder:
        assert [one.path for one in recorder.segments()] == own[:-1]
        assert recorder.foreign.keys() == {own[-1]}


def test_a_segment_that_is_damaged_is_no_foreign_one(data: DataFolder) -> None:
    """Where its first chunk is, or what that says of its times."""
    path = segment_paths(data.log)[2]
    whole = path.read_bytes()
    for at in range(0, 400, 3):
        content = bytearray(whole)
        content[at] ^= 0xFF
        path.write_bytes(content)
        (_, foreign) = own_segments(data.log)
        if at > 8 + 9 + 4 + 6:  # behind the name of the profile
            assert foreign == {}, at
    path.write_bytes(bytes(len(whole)))
    assert own_segments(data.log)[1] == {}
    path.write_bytes(b"")
    assert own_segments(data.log)[1] == {}
