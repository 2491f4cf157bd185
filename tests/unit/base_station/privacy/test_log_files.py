"""A log as an erasure reads it before it is rewritten."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest

from base_station.privacy.log_files import ClosedLog, LogReading
from base_station.storage.data_folder import DataFolder
from shared.channels import OPERATOR, TEMPERATURE
from shared.codec import encode
from shared.mcap_log import SegmentPolicy, SegmentWriter, segment_paths
from shared.messages import STATION_ID, Header, OperatorAction, Temperature
from shared.messages.station import Action, OpenIncident, RegisterUnit

NS_PER_S = 1_000_000_000


def action(number: int, made: Action) -> tuple[str, bytes]:
    message = OperatorAction(Header(STATION_ID, 1, number, 0), f"a{number}", "ada", made)
    return OPERATOR.key(STATION_ID), encode(message)


def temperature(unit_id: str, number: int) -> tuple[str, bytes]:
    return TEMPERATURE.key(unit_id), encode(Temperature(Header(unit_id, 1, number, 0), 20.0))


@pytest.fixture
def data(tmp_path: Path) -> DataFolder:
    """Two incidents at once; unit A sends a message before it is registered, B only afterwards."""
    data = DataFolder(tmp_path)
    writer = SegmentWriter(data.log, SegmentPolicy(chunk_bytes=4096))
    records = [
        action(1, OpenIncident("i1", "Oak Street")),
        temperature("A", 1),
        action(2, OpenIncident("i2", "Mill Lane", beside_others=True)),
        action(3, RegisterUnit("A", "")),
        action(4, RegisterUnit("B", "")),
        temperature("A", 2),
        temperature("B", 1),
    ]
    for at_s, (key, payload) in enumerate(records, start=1):
        writer.write(at_s * NS_PER_S, key, payload)
        writer.end_segment()
    writer.close()
    return data


def test_first_messages_are_those_before_the_registration(data: DataFolder) -> None:
    reading = LogReading(ClosedLog(data.log))
    assert reading.first_message_ns(reading.actions()) == {"A": 2 * NS_PER_S}


def test_first_messages_are_not_searched_with_one_incident_at_a_time(data: DataFolder) -> None:
    reading = LogReading(ClosedLog(data.log))
    alone = [one for one in reading.actions() if one[0] != 3 * NS_PER_S]
    assert reading.first_message_ns(alone) == {}


@pytest.mark.parametrize("lost", [0, 2])
def test_log_without_one_of_its_segments_is_not_whole(data: DataFolder, lost: int) -> None:
    reading = LogReading(ClosedLog(data.log))
    assert reading.is_whole()
    segment_paths(data.log)[lost].unlink()
    assert not reading.is_whole()


def test_log_without_any_segment_is_not_whole(data: DataFolder) -> None:
    for path in segment_paths(data.log):
        path.unlink()
    assert not LogReading(ClosedLog(data.log)).is_whole()


def test_logs_set_aside_are_found_and_recordings_are_not(data: DataFolder) -> None:
    reading = LogReading(ClosedLog(data.log))
    assert reading.set_aside() == []
    first = segment_paths(data.log)[0]
    aside = data.path / "log-aside"
    for folder in (aside, data.recordings / "A", data.radio):
        folder.mkdir(parents=True)
        shutil.copy(first, folder)
    assert reading.set_aside() == [aside / first.name]
    assert [t_ns for t_ns, _, _ in reading.actions_set_aside()] == [NS_PER_S]
