"""Rebuilding of projections from a log, some seconds of it at a time."""

from __future__ import annotations

from base_station.replay.rebuild import project_log
from base_station.storage.projection import Projection
from shared.clock import NS_PER_S
from tests.rig.live_station import make_pipeline
from tests.rig.logged_walk import walk_with_mayday
from tests.rig.station_script import START_NS, Record


def projected(records: list[Record]) -> tuple[list[Projection], list[int], int]:
    written: list[Projection] = []
    applied_ns: list[int] = []
    count = project_log(records, make_pipeline(), written.append, applied_ns.append)
    return written, applied_ns, count


def test_whole_log_is_projected_ten_seconds_at_a_time() -> None:
    records = [one for one in walk_with_mayday() if one[0] <= START_NS + 117 * NS_PER_S]
    written, applied_ns, count = projected(records)
    assert count == len(records)
    seconds = [(t_ns - START_NS) // NS_PER_S for t_ns in applied_ns]
    assert seconds == [*range(0, 120, 10), 117], "the rest at its end"
    assert [one.t_ns for one in written] == applied_ns
    tracks_s = [fused.t_meas_ns // NS_PER_S for one in written for fused in one.tracks]
    assert len(tracks_s) == len(set(tracks_s)) == 117
    assert [alarm.rule for one in written for alarm in one.alarms] == ["mayday"]


def test_gap_of_the_log_takes_no_step() -> None:
    records = [one for one in walk_with_mayday() if not 20 < (one[0] - START_NS) / NS_PER_S < 95]
    _, applied_ns, _ = projected(records)
    assert [(t_ns - START_NS) // NS_PER_S for t_ns in applied_ns] == [0, 10, 20, 95, 105, 115, 120]


def test_empty_log_writes_nothing() -> None:
    assert projected([]) == ([], [0], 0)
