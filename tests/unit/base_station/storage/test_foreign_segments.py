"""Files in the folder of a log that are none of its segments are left out, and named."""

from __future__ import annotations

import shutil
from contextlib import closing
from pathlib import Path

import pytest
from mcap.reader import make_reader
from mcap.writer import Writer

from base_station.engine.log_feed import FolderFeed
from base_station.storage.data_folder import DataFolder
from base_station.storage.log_defects import LogDefects
from base_station.storage.recorder import Recorder
from shared.clock import NS_PER_S, ManualClock
from shared.mcap_log import (
    SegmentPolicy,
    SegmentReader,
    SegmentWriter,
    own_segments,
    recover_log,
    rewrite_segment,
    segment_number,
    segment_path,
    segment_paths,
)
from shared.mcap_log.identity import SegmentIdentity, identity_of
from shared.mcap_log.writing import Segment
from tests.rig.small_log import KEY, T0_NS

SEGMENTS, EACH = 4, 10
OTHER_LOG = "it is of another log"


def written(folder: Path, began_ns: int, segments: int = SEGMENTS) -> Path:
    with closing(SegmentWriter(folder, SegmentPolicy(segment_s=float(EACH)))) as log:
        for second in range(segments * EACH):
            log.write(began_ns + second * NS_PER_S, KEY, b"%d" % second)
    return folder


def by_earlier_version(path: Path) -> Path:
    """The same records in a segment that does not state its log."""
    with SegmentReader(path) as reader:
        records = list(reader.records())
    path.unlink()
    segment = Segment(path, SegmentPolicy().chunk_bytes, SegmentIdentity())
    for record in records:
        segment.add(*record)
    segment.finish()
    segment.file.sync()
    segment.file.close()
    return path


@pytest.fixture
def data(tmp_path: Path) -> DataFolder:
    written(tmp_path / "log", T0_NS)
    return DataFolder(tmp_path)


def elsewhere(tmp_path: Path, after_s: int) -> Path:
    """A segment of another station, ``after_s`` later."""
    return segment_paths(written(tmp_path / "other", T0_NS + after_s * NS_PER_S, 1))[0]


def by_others(path: Path) -> Path:
    """Files of any program, of the time in their name."""
    with path.open("wb") as file:
        writer = Writer(file)
        writer.start(profile="ros2")
        channel = writer.register_channel("/imu", "json", 0)
        writer.add_message(channel, T0_NS, b"{}", T0_NS)
        writer.finish()
    return path


def seconds(data: DataFolder, reported: list[str]) -> list[int]:
    return [
        int(payload) for _, _, payload in FolderFeed(data.log, on_damage=reported.append).records()
    ]


@pytest.mark.parametrize("is_earlier", [False, True])
def test_foreign_file_in_the_place_of_a_segment_is_left_out(
    is_earlier: bool, data: DataFolder, tmp_path: Path
) -> None:
    other = elsewhere(tmp_path, 6000)
    if is_earlier:
        for path in (*segment_paths(data.log), other):
            by_earlier_version(path)
    own = segment_paths(data.log)
    shutil.copy(other, own[1])
    reported: list[str] = []
    assert seconds(data, reported) == [*range(10), *range(20, 40)]
    reason = (
        "its records begin at 2023-11-14 23:53:20 UTC, which is not when its name says"
        if is_earlier
        else OTHER_LOG
    )
    assert reported == [f"{own[1].name} is no segment of this log and is left out: {reason}"]
    assert max(one.end_ns for one in data.segments()) == T0_NS + 39 * NS_PER_S


@pytest.mark.parametrize("number", [1, 3, 5, 99])
@pytest.mark.parametrize("after_s", [-6000, 6000])
def test_foreign_file_beside_the_segments_is_left_out(
    number: int, after_s: int, data: DataFolder, tmp_path: Path
) -> None:
    """Also behind all others, where the log may have continued by its names and times."""
    own = segment_paths(data.log)
    beside = segment_path(data.log, number, T0_NS + after_s * NS_PER_S)
    shutil.copy(elsewhere(tmp_path, after_s), beside)
    assert own_segments(data.log) == (own, {beside: OTHER_LOG})
    assert seconds(data, []) == [*range(40)]
    defects = LogDefects(data.log)
    while defects.check_next_chunk():
        pass
    assert defects() == (f"{beside.name} is no segment of this log and is left out: {OTHER_LOG}",)


@pytest.mark.parametrize("number", [1, 3, 99])
@pytest.mark.parametrize("after_s", [-6000, 6000])
def test_segments_of_earlier_versions_are_judged_by_names_and_times(
    number: int, after_s: int, data: DataFolder, tmp_path: Path
) -> None:
    """Only a later one behind all others may be a continuation of the log."""
    own = [by_earlier_version(path) for path in segment_paths(data.log)]
    other = by_earlier_version(elsewhere(tmp_path, after_s))
    beside = segment_path(data.log, number, T0_NS + after_s * NS_PER_S)
    shutil.copy(other, beside)
    if number == 99 and after_s > 0:
        assert own_segments(data.log) == ([*own, beside], {})
        return
    assert own_segments(data.log) == (own, {beside: "its name does not go with the others"})
    assert seconds(data, []) == [*range(40)]


def test_log_of_an_earlier_version_continues_and_takes_in_no_other(
    data: DataFolder, tmp_path: Path
) -> None:
    own = [by_earlier_version(path) for path in segment_paths(data.log)]
    beside = segment_path(data.log, 5, T0_NS + 6000 * NS_PER_S)
    shutil.copy(elsewhere(tmp_path, 6000), beside)
    assert own_segments(data.log) == (own, {beside: OTHER_LOG})
    written(data.log, T0_NS + 40 * NS_PER_S, 1)
    new = segment_path(data.log, 5, T0_NS + 40 * NS_PER_S)
    assert own_segments(data.log) == ([*own, new], {beside: OTHER_LOG})
    own[-1].unlink()
    assert own_segments(data.log) == ([*own[:-1], new], {beside: OTHER_LOG})
    behind = by_earlier_version(segment_paths(written(tmp_path / "old", T0_NS, 1))[0])
    late = segment_path(data.log, 6, T0_NS + 60 * NS_PER_S)
    shutil.copy(behind, late)
    assert "an earlier version" in own_segments(data.log)[1][late]


@pytest.mark.parametrize("beside_number", [1, 5])
def test_station_continues_as_without_the_foreign_file(
    beside_number: int, data: DataFolder, tmp_path: Path
) -> None:
    """With no number left out, and of the same log after each start."""
    own = segment_paths(data.log)
    beside = segment_path(data.log, beside_number, T0_NS + 6000 * NS_PER_S)
    shutil.copy(elsewhere(tmp_path, 6000), beside)
    for start in range(2):
        written(data.log, T0_NS + (60 + 20 * start) * NS_PER_S, 1)
    found, foreign = own_segments(data.log)
    assert [segment_number(path) for path in found] == [1, 2, 3, 4, 5, 6]
    assert found[:4] == own
    assert foreign == {beside: OTHER_LOG}


def test_rewritten_segment_stays_of_its_log(data: DataFolder) -> None:
    """Only the segments around it may identify it."""
    own = segment_paths(data.log)
    rewrite_segment(own[1], lambda record: [(record[0], KEY, b"redacted")])
    content = bytearray(own[2].read_bytes())
    content[8 + 9 + 30 : 8 + 9 + 60] = bytes(30)
    own[2].write_bytes(content)
    rewrite_segment(own[2], lambda record: [(record[0], KEY, b"redacted")])
    torn = own[3].read_bytes()
    own[3].write_bytes(torn[: len(torn) // 2])
    recover_log(data.log)
    assert own_segments(data.log) == (own, {})
    heads = [identity_of(path) for path in own]
    assert {head.log_id for head in heads if head} == {identity_of(own[0]).log_id}  # type: ignore[union-attr]


def test_lost_log_continues_as_the_same(data: DataFolder, tmp_path: Path) -> None:
    """Segments restored from a backup belong to it."""
    backup = shutil.copytree(data.log, tmp_path / "backup")
    with closing(Recorder(data.path, ManualClock())) as recorder:
        log_id = recorder.segments()[0].log_id
    assert log_id
    shutil.rmtree(data.log)
    with closing(Recorder(data.path, ManualClock())) as recorder:
        recorder.continue_log(4, log_id)
        recorder.write(T0_NS + 100 * NS_PER_S, KEY, b"100", urgent=True)
    shutil.copytree(backup, data.log, dirs_exist_ok=True)
    assert seconds(data, []) == [*range(40), 100]


@pytest.mark.parametrize("name", ["foreign.mcap", "empty.mcap"])
def test_file_without_number_is_left_out(name: str, data: DataFolder, tmp_path: Path) -> None:
    beside = data.log / name
    if name == "empty.mcap":
        beside.touch()
    else:
        shutil.copy(elsewhere(tmp_path, 6000), beside)
    reported: list[str] = []
    assert seconds(data, reported) == [*range(40)]
    why = "its name is not that of a segment"
    assert reported == [f"{name} is no segment of this log and is left out: {why}"]
    with closing(Recorder(data.path, ManualClock())) as recorder:
        assert recorder.foreign.keys() == {beside}


def test_any_reader_of_mcap_reads_the_log_of_a_segment(data: DataFolder) -> None:
    first, second, *_ = segment_paths(data.log)
    with second.open("rb") as file:
        (head,) = make_reader(file).iter_metadata()
    assert (head.name, head.metadata["follows"]) == ("muster.log", first.name)
    assert len(head.metadata["log_id"]) == 16


def test_file_of_another_program_is_left_out(data: DataFolder) -> None:
    beside = by_others(segment_path(data.log, 5, T0_NS + 60 * NS_PER_S))
    reported: list[str] = []
    assert seconds(data, reported) == [*range(40)]
    assert "written by another program (ros2)" in reported[0]
    assert own_segments(data.log)[1].keys() == {beside}


def test_station_that_starts_beside_one_continues_and_its_clock_too(
    data: DataFolder, tmp_path: Path
) -> None:
    own = segment_paths(data.log)
    shutil.copy(elsewhere(tmp_path, 6000), own[-1])
    with closing(Recorder(data.path, ManualClock())) as recorder:
        assert [one.path for one in recorder.segments()] == own[:-1]
        assert recorder.foreign.keys() == {own[-1]}


def test_damaged_segment_is_no_foreign_one(data: DataFolder) -> None:
    """Damage in its first chunk, or in its times."""
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
