"""``muster base smooth`` and ``muster base assess`` on the folder of a station that ran."""

from __future__ import annotations

import json
from pathlib import Path

import msgspec
import pytest
from typer.testing import CliRunner

from base_station.app import folder_commands as station_app
from base_station.cli import app
from shared.clock import NS_PER_S
from shared.errors import UserError
from shared.messages import Header, Position
from shared.messages.pins import SetPin
from shared.messages.station import CloseIncident, OpenIncident, RegisterUnit, SetStart
from tests.rig.live_station import LiveStation
from tests.rig.waiting import until


@pytest.fixture
def folder(tmp_path: Path, make_position) -> Path:
    position: Position = make_position()
    with LiveStation(tmp_path) as station:
        station.act(RegisterUnit("FF-01", ""))
        station.act(OpenIncident("i1", "Mill Lane"))
        station.act(SetStart("FF-01", 0.0, 0.0, 0.0, 0.0, 0.5, 0.1))
        for step in range(40):
            header = Header("FF-01", 7, step + 1, step * NS_PER_S // 10)
            station.publish(
                msgspec.structs.replace(position, header=header, north_m=0.1 * step, east_m=0.0)
            )
        until(lambda: station.pipeline.state.counts.messages >= 40)
        station.act(SetPin("p", "FF-01", 0, 0.5, 0.5, 0.5, None, None, 0.0, "door"))
        station.act(CloseIncident("i1"))
    station_app.rebuild(tmp_path, lambda _: None)
    return tmp_path


def test_trails_are_smoothed_and_assessed(folder: Path, tmp_path: Path) -> None:
    smoothed = CliRunner().invoke(app, ["smooth", "i1", "--data", str(folder)])
    assert smoothed.exit_code == 0, smoothed.output
    assert "FF-01" in smoothed.output
    assert "1 trails by path-graph; kept" in smoothed.output
    report = tmp_path / "report.json"
    judged = CliRunner().invoke(app, ["assess", "i1", "--data", str(folder), "--json", str(report)])
    assert judged.exit_code == 0, judged.output
    assert "ISO/IEC 18305" in judged.output
    (unit,) = json.loads(report.read_text())["units"]
    assert unit["pin_residuals"][0]["note"] == "door"


def test_unknown_incident_is_refused_with_the_known_ones(folder: Path) -> None:
    for command in ("smooth", "assess"):
        result = CliRunner().invoke(app, [command, "i9", "--data", str(folder)])
        assert isinstance(result.exception, UserError)
        assert "no incident i9" in str(result.exception)
        assert "i1 (Mill Lane)" in str(result.exception)
