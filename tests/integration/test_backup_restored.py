"""A backup of a running station, restored for another station: people continue from there."""

from __future__ import annotations

import shutil
from collections.abc import Callable
from pathlib import Path

from tests.rig.served_station import MakePosition, greet, prepare, snapshot, trail, walk
from tests.rig.station_command import Browser, Command, Unit


def test_station_continues_from_a_backup_made_while_running(
    serve: Callable[..., Command],
    tmp_path: Path,
    data: Path,
    unit: Unit,
    make_position: MakePosition,
) -> None:
    target = tmp_path / "backup"
    station = serve()
    with Browser(station.wait_ready(), data) as browser:
        incident_id = prepare(browser)
        greet(browser, unit, make_position)
        walk(unit, make_position, 0, 20)  # the log on the disk is a second behind
        assert trail(browser)["points"]
        with Command(
            tmp_path / "said.txt", "backup", str(target), "--data", str(data)
        ) as backing_up:
            assert backing_up.wait() == 0, backing_up.output()
    shutil.copy(data / "first-login.txt", tmp_path)  # whoever knows the password logs in again
    station.kill()
    shutil.rmtree(data)

    shutil.copytree(target, data)
    again = serve()
    with Browser(again.wait_ready(), tmp_path) as browser:
        picture = snapshot(browser)
        assert picture["incident"]["incident_id"] == incident_id
        (card,) = picture["units"]
        assert card["person"]["name"] == "Ada"
        assert card["position"]["north_m"] > 5.0
    assert again.stop() == 0
