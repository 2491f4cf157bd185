"""Window of a unit's recording that is requested, beside a station whose clock was set back."""

from __future__ import annotations

from pathlib import Path

import pytest

from base_station.app.recordings_app import since, window_of
from base_station.config import StationConfig
from base_station.storage.data_folder import DataFolder
from base_station.storage.db.models import IncidentRow, LogSegment
from base_station.storage.db.records import Records
from base_station.storage.db.store import Store
from shared.clock import NS_PER_S, SystemClock

AHEAD_NS = 3600 * NS_PER_S


@pytest.fixture
def recorded_ns(tmp_path: Path) -> int:
    """An hour ahead of this machine's clock, which was set back; an incident is open."""
    recorded_ns = SystemClock().utc_ns() + AHEAD_NS
    with Store(DataFolder(tmp_path).database) as store:
        segment = LogSegment(
            name="a.mcap", first_ns=1, last_ns=recorded_ns, messages=1, size_bytes=1, note=""
        )
        Records(store, SystemClock()).put_segments([segment])
        with store.write() as session:
            session.add(
                IncidentRow(
                    incident_id="i1", name="Mill Lane", opened_ns=5, opened_by="", closed_by=""
                )
            )
            session.add(
                IncidentRow(
                    incident_id="i0",
                    name="Before",
                    opened_ns=2,
                    closed_ns=4,
                    opened_by="",
                    closed_by="",
                )
            )
    return recorded_ns


def test_window_until_now_ends_at_the_last_record(tmp_path: Path, recorded_ns: int) -> None:
    config = StationConfig(data=tmp_path)
    for from_ns, to_ns in (window_of(config, "i1"), since(config, 5)):
        assert from_ns == 5
        assert recorded_ns <= to_ns < recorded_ns + AHEAD_NS // 2


@pytest.mark.usefixtures("recorded_ns")
def test_window_of_a_closed_incident_ends_with_it(tmp_path: Path) -> None:
    assert window_of(StationConfig(data=tmp_path), "i0") == (2, 4)


def test_window_until_now_beside_an_ended_log_ends_now(tmp_path: Path) -> None:
    with Store(DataFolder(tmp_path).database):
        pass
    before_ns = SystemClock().utc_ns()
    assert before_ns <= since(StationConfig(data=tmp_path), 5)[1] <= SystemClock().utc_ns()
