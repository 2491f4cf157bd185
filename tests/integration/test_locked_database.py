"""A database that another program has locked delays no action of a person."""

from __future__ import annotations

import sqlite3
from collections.abc import Callable, Iterator
from contextlib import closing, contextmanager
from pathlib import Path
from typing import Any

from base_station.core.events import Received, event_of
from base_station.storage.data_folder import DataFolder
from shared.mcap_log import read_log
from shared.messages import EventKind, OperatorAction, UnitEvent
from shared.messages.station import AcknowledgeAlarm, CheckIn, SendCommand
from tests.rig.served_station import MakePosition, greet, prepare, snapshot
from tests.rig.station_command import Browser, Command, Unit
from tests.rig.waiting import until

EVERYONE = {"target": {"everyone": True}}


@contextmanager
def locked(data: Path) -> Iterator[None]:
    """Nobody else writes meanwhile; who reads sees what was there before."""
    with closing(sqlite3.connect(DataFolder(data).database, isolation_level=None)) as other:
        other.execute("BEGIN IMMEDIATE")
        yield
        other.execute("ROLLBACK")


def maydays(browser: Browser) -> list[dict[str, Any]]:
    return [one for one in snapshot(browser)["alarms"] if one["rule"] == "mayday"]


def test_actions_are_answered_and_logged_while_the_database_is_locked(
    serve: Callable[..., Command], data: Path, unit: Unit, make_position: MakePosition
) -> None:
    station = serve()
    with Browser(station.wait_ready(), data) as browser:
        prepare(browser)
        greet(browser, unit, make_position)
        with locked(data):
            unit.say(UnitEvent(unit.header_factory.header(), EventKind.MAYDAY))
            until(lambda: maydays(browser), "the mayday is shown")
            (raised,) = maydays(browser)
            path = f"/alarms/{raised['alarm_id']}"
            seen = {"last_raised_ms": raised["last_raised_ms"]}
            browser.call("POST", f"{path}/acknowledge", json=seen)
            browser.call("POST", "/check-ins", json=EVERYONE)
            order = browser.call("POST", "/commands", json={"kind": "evacuate"} | EVERYONE)
            assert [one["state"] for one in maydays(browser)] == ["acknowledged"]

        def stored() -> list[str]:
            return [one["state"] for one in browser.call("GET", "/alarms")]

        until(lambda: stored() == ["acknowledged"], "the database has it")
        reported = browser.call("GET", path)
        assert [one["state"] for one in reported["changes"]] == ["raised", "acknowledged"]
    assert station.stop() == 0
    events = (event_of(*record) for record in read_log(DataFolder(data).log))
    messages = [event.message for event in events if isinstance(event, Received)]
    actions = [one.action for one in messages if isinstance(one, OperatorAction)]
    acknowledged = [one for one in actions if isinstance(one, AcknowledgeAlarm)]
    ordered = [one for one in actions if isinstance(one, SendCommand)]
    assert [one.alarm_id for one in acknowledged] == [raised["alarm_id"]]
    assert [one.command_id for one in ordered] == [order["command_id"]]
    assert any(isinstance(one, CheckIn) for one in actions)
