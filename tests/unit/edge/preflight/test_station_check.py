"""Link and clock in the start check."""

from __future__ import annotations

import pytest

from base_station.unit_sync.clock_server import ClockServer
from edge.preflight.finding import CheckFinding, Severity
from edge.preflight.station_check import station_findings
from shared.bus import Bus
from shared.bus_memory import MemoryRouter
from shared.channels import HEARTBEAT, clock_key
from shared.clock import NS_PER_S, SystemClock
from shared.errors import BusError


class Endpoint:
    def __init__(self, router: MemoryRouter | None) -> None:
        self._router = router

    def open_bus(self) -> Bus:
        if self._router is None:
            raise BusError("the bus cannot be opened")
        return self._router.attach_unit()

    def is_reachable(self, timeout_s: float) -> bool:
        return True

    def link_failure_reason(self) -> str:
        return "nothing listens"


@pytest.fixture
def router() -> MemoryRouter:
    return MemoryRouter()


@pytest.fixture(autouse=True)
def hasty(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("edge.preflight.station_check._LINK_WAIT_S", 0.3)


def findings(router: MemoryRouter | None, machine: SystemClock) -> list[CheckFinding]:

    return list(station_findings("u1", Endpoint(router), machine))


def test_a_station_that_listens_and_tells_its_time_is_ok(router: MemoryRouter) -> None:
    station = router.attach_station()
    station.subscribe(HEARTBEAT.key("*"), lambda _key, _payload: None)
    station.serve(clock_key("*"), ClockServer(SystemClock()).replies)
    link, clock = findings(router, SystemClock())
    assert (link.level, clock.level) == (Severity.OK, Severity.OK)
    assert "the station's" in clock.text


def test_a_station_at_another_of_its_places_is_found(router: MemoryRouter) -> None:
    """Each attempt tries the next one: what the enrolment says may be out of date."""

    class MovedStation(Endpoint):
        attempts = 0

        def open_bus(self) -> Bus:
            self.attempts += 1
            if self.attempts < 3:
                raise BusError("the bus cannot be opened")
            return super().open_bus()

    station = router.attach_station()
    station.subscribe(HEARTBEAT.key("*"), lambda _key, _payload: None)
    link, *_ = station_findings("u1", MovedStation(router), SystemClock())
    assert link.level is Severity.OK


def test_a_clock_that_is_an_hour_off_is_a_warning(router: MemoryRouter) -> None:
    station = router.attach_station()
    station.subscribe(HEARTBEAT.key("*"), lambda _key, _payload: None)

    class HourBehind(SystemClock):
        def utc_ns(self) -> int:
            return super().utc_ns() - 3600 * NS_PER_S

    station.serve(clock_key("*"), ClockServer(HourBehind()).replies)
    _, clock = findings(router, SystemClock())
    assert clock.level is Severity.WARNING
    assert clock.text.startswith("3600.0")


def test_a_station_that_tells_no_time_is_a_warning(
    router: MemoryRouter, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("edge.preflight.station_check._CLOCK_WAIT_S", 0.3)
    router.attach_station().subscribe(HEARTBEAT.key("*"), lambda _key, _payload: None)
    link, clock = findings(router, SystemClock())
    assert (link.level, clock.level) == (Severity.OK, Severity.WARNING)


def test_no_station_and_no_bus_have_failed_with_the_reason(router: MemoryRouter) -> None:
    (no_listener,) = findings(router, SystemClock())
    assert (no_listener.level, no_listener.text) == (Severity.FAILED, "nothing listens")
    (no_bus,) = findings(None, SystemClock())
    assert (no_bus.level, no_bus.text) == (Severity.FAILED, "the bus cannot be opened")
