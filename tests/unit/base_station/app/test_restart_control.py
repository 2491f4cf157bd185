"""Restart of a running station: once, on request or with a stale state."""

from __future__ import annotations

import pytest

from base_station.app.restart_control import Restart, RestartControl
from base_station.core.log_position import LogPosition


class Station:
    """Inputs of the decision."""

    def __init__(self) -> None:
        self.leads, self.has_standby, self.in_incident, self.stops = True, False, False, 0
        self.control = RestartControl(
            self.stop,
            is_leader=lambda: self.leads,
            has_standby=lambda: self.has_standby,
            is_in_incident=lambda: self.in_incident,
        )

    def stop(self) -> None:
        self.stops += 1


def test_first_request_is_kept() -> None:
    station = Station()
    station.control.request(LogPosition(5, 1))
    station.control.request(None)
    assert station.control.requested == Restart(LogPosition(5, 1))
    assert station.stops == 2


@pytest.mark.parametrize(
    ("leads", "has_standby", "in_incident", "restarts"),
    [
        (False, False, True, True),
        (True, True, False, True),
        (True, True, True, False),
        (True, False, False, False),
    ],
)
def test_stale_state_restarts_where_no_station_stays_alone(
    leads: bool, has_standby: bool, in_incident: bool, restarts: bool
) -> None:
    station = Station()
    station.leads, station.has_standby, station.in_incident = leads, has_standby, in_incident
    station.control.stale.note_stepped(10, 20)
    station.control.restart_if_stale()
    assert station.stops == 0, "nothing was missing"
    station.control.note_repaired(15)
    assert station.control.requested == (Restart(None, is_repaired=True) if restarts else None)


def test_repair_before_the_checkpoint_changes_nothing() -> None:
    station = Station()
    station.leads = False
    station.control.stale.note_stepped(10, 20)
    station.control.note_repaired(10)
    assert station.control.requested is None
