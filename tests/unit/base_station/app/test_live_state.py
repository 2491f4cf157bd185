"""Live state of other parts, before and after the log has been read."""

from __future__ import annotations

from base_station.app.live_state import LiveState
from base_station.core.state import Incident, StationState

CONFIGURED = {"heat.caution_degc": 90.0}


def test_live_state_before_the_log_is_read_comes_from_the_settings() -> None:
    live = LiveState(CONFIGURED, "gps-switching")
    assert live.fuser == "gps-switching"
    assert not live.is_in_incident()
    assert (live.problems, live.thresholds) == ({}, CONFIGURED)


def test_live_state_follows_the_log() -> None:
    live, state = LiveState(CONFIGURED, "gps-switching"), StationState()
    live.begin(state)
    assert live.fuser == "gps-inertial"
    state.fuser = "gps-switching"
    assert live.fuser == "gps-switching"
    assert not live.is_in_incident()
    state.incidents["i1"] = Incident("i1", "Fire", 1, closed_ns=None)
    assert live.is_in_incident()
    state.incidents["i1"] = Incident("i1", "Fire", 1, closed_ns=2)
    assert not live.is_in_incident()
    state.problems["log"] = "the disk is full"
    state.thresholds = {"heat.caution_degc": 95.0}
    assert live.problems == {"log": "the disk is full"}
    assert live.thresholds == {"heat.caution_degc": 95.0}
    assert live.configured_thresholds == CONFIGURED
