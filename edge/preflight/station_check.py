"""Check of the link with the station, and of the unit's clock against the station's."""

from __future__ import annotations

import logging
import time
from collections.abc import Iterator
from contextlib import suppress

from edge.agent.link import StationConnector
from edge.clocks.station import StationClock
from edge.preflight.finding import CheckFinding, Severity
from shared.bus import Bus, ReplyHandler
from shared.channels import HEARTBEAT, clock_key
from shared.clock import Clock
from shared.errors import BusError

logger = logging.getLogger(__name__)

_ATTEMPTS = 4
_LINK_WAIT_S = 10.0
_CLOCK_WAIT_S = 6.0  # some exchanges, one a second
_ANSWER_WAIT_S = 1.0
_POLL_S = 0.1
_CLOCK_AHEAD_MAX_S = 60.0  # the station's time is used all the same, once the link is there
_NO_LINK = "messages are kept and sent later; until then the commander sees nothing of this wearer"


def station_findings(
    unit_id: str, station: StationConnector, machine: Clock
) -> Iterator[CheckFinding]:
    """Open the link as the unit would, and close it again."""
    try:
        bus = _opened(station)
    except BusError as error:
        yield CheckFinding("link", Severity.FAILED, str(error), _NO_LINK)
        return
    try:
        began_s = time.monotonic()
        if not _wait_for_subscriber(bus, HEARTBEAT.key(unit_id)):
            yield CheckFinding("link", Severity.FAILED, station.link_failure_reason(), _NO_LINK)
            return
        yield CheckFinding("link", Severity.OK, f"linked within {time.monotonic() - began_s:.1f} s")
        yield _clock_finding(unit_id, bus, machine)
    finally:
        bus.close()


def _opened(station: StationConnector) -> Bus:
    """Each attempt tries another of the places where the station may be."""
    for _ in range(_ATTEMPTS - 1):
        with suppress(BusError):
            return station.open_bus()
    return station.open_bus()


def _wait_for_subscriber(bus: Bus, key: str) -> bool:
    """Wait until the station subscribes to this unit's messages; False when it does not in time."""
    end_s = time.monotonic() + _LINK_WAIT_S
    while time.monotonic() < end_s:
        if bus.is_linked() and bus.has_subscriber(key):
            return True
        time.sleep(_POLL_S)
    return False


def _clock_finding(unit_id: str, bus: Bus, machine: Clock) -> CheckFinding:
    clock = StationClock(machine)

    def ask(on_reply: ReplyHandler) -> None:
        try:
            bus.ask(clock_key(unit_id), b"", _ANSWER_WAIT_S, on_reply, urgent=True)
        except Exception as error:  # noqa: BLE001  # the bus may fail in any way; it is asked again
            logger.debug("the station cannot be asked for the time: %s", error)

    end_s = time.monotonic() + _CLOCK_WAIT_S
    while time.monotonic() < end_s and clock.estimate() is None:
        clock.turn(ask)
        time.sleep(_POLL_S)
    if clock.estimate() is None:
        return CheckFinding(
            "clock",
            Severity.WARNING,
            "the station did not tell its time",
            "times of this unit are those of its own clock",
        )
    ahead_s = clock.machine_ahead_s()
    text = f"{abs(ahead_s):.3f} s {'ahead of' if ahead_s > 0 else 'behind'} the station's"
    if abs(ahead_s) > _CLOCK_AHEAD_MAX_S:
        return CheckFinding(
            "clock", Severity.WARNING, text, "set it: without a link its times would be wrong"
        )
    return CheckFinding("clock", Severity.OK, text)
