"""Stations and a department in networks of their own: cut off, killed, refused.

Nothing is lost and nothing comes twice; what was sent and how long it took is printed.
"""

from __future__ import annotations

import time
from contextlib import ExitStack
from pathlib import Path

import pytest

from tests.bench.department_faults import AHEAD_S, Faults, suffer_all
from tests.rig.database_server import database_server
from tests.rig.loaded_program import launch_loaded

FAULT_S = 4.0

pytestmark = pytest.mark.usefixtures("links")


def test_link_faults_and_kills_lose_and_repeat_no_event(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    with database_server() as server, ExitStack() as closing:
        faults = Faults(tmp_path, closing, launch_loaded, server)
        rows = suffer_all(faults, FAULT_S, FAULT_S)
        with capsys.disabled():
            print("", *rows, sep="\n")
        assert all(row.sent > 0 and row.station.count > 0 for row in rows)
        assert [(row.lost, row.twice) for row in rows] == [(0, 0)] * len(rows)
        faults.end()
        roof = faults.roof
        sent = roof.decided()
        foreign = set().union(*(one.alarm_events() for one in faults.strangers))
        arrived, view = roof.department.alarm_events(), faults.view()
        assert set(arrived) == sent  # none lost, and none of a stranger
        assert len(arrived) == len(sent)  # none twice
        assert foreign
        stations = {one["station"]: one for one in view["stations"]}
        assert [one["missing"] for one in stations.values()] == [0, 0, 0]
        assert [one["state"] for one in stations.values()] == ["live"] * 3
        ahead_s = stations["engine-9"]["clock_ahead_ms"] / 1000.0
        assert ahead_s == pytest.approx(AHEAD_S, abs=60.0)
        assert any("The clock of engine-9 is 3 h 0 min ahead" in one for one in view["problems"])
        opened_ms = [one["opened_ms"] for one in view["incidents"]]
        now_ms = time.time_ns() // 1_000_000
        assert all(abs(now_ms - one) < AHEAD_S * 1000 / 2 for one in opened_ms)
