"""Link of the unit to the bus: opened, watched, and reopened when it is lost.

Nothing in the unit waits for it.  Opening takes half a second and may fail for hours, so a
thread does it; publishing without a link drops the bytes, which the journal keeps.
"""

from __future__ import annotations

import logging
import time
from collections.abc import Iterable
from contextlib import ExitStack
from threading import Lock, Thread
from typing import Protocol

from shared.bus import Bus, QueryHandler, ReplyHandler, SampleHandler
from shared.channels import COMMAND, EVERY_UNIT, HEARTBEAT, Qos, alive_key
from shared.errors import BusError
from shared.worker import UNTIL_WOKEN, Worker

logger = logging.getLogger(__name__)

_RETRY_S = 1.0
_CHECK_S = 0.5
_CHECKS_UNTIL_REPORTED = 4  # connecting takes a moment
_LOST_CHECKS = 2  # without the link that was there: probe until the station is back
_NO_SUBSCRIBER = (
    "no station listens to this unit: it is starting, or the unit has been revoked there"
)
_REOPEN_AFTER_S = 15.0  # some sessions stop trying to reconnect
_CLOSING_S = 10.0  # a bus may take seconds to close without a station


class StationConnector(Protocol):
    """The station as seen from a unit."""

    def open_bus(self) -> Bus:
        """Raises BusError when it cannot be opened."""
        ...

    def is_reachable(self, timeout_s: float) -> bool:
        """Return True as soon as the station takes a connection; False when the time is over."""
        ...

    def link_failure_reason(self) -> str:
        """Return the reason for a person when a bus stays without a link; may take some seconds."""
        ...


class Link:
    """Opens and closes a bus as wanted, and declares the unit on it each time."""

    def __init__(
        self,
        unit_id: str,
        station: StationConnector,
        on_command: SampleHandler,
        served: Iterable[tuple[str, QueryHandler]],
    ) -> None:
        self._unit_id = unit_id
        self._station = station
        self._on_command = on_command
        self._served = tuple(served)
        self._bus: Bus | None = None
        self._wanted_up = True
        self._using = Lock()
        self._failure_reported = False
        self._reported_linked: bool | None = None
        self._checks_unlinked = 0
        self._closing: Thread | None = None  # of the bus before
        self._link_lost = False  # the link was lost: probe before it is opened again
        self._worker = Worker("link", self._step, "the link fails; trying again")
        self._worker.start()

    @property
    def is_working(self) -> bool:
        """True while the thread runs, which holds or opens the link until ``close``."""
        return self._worker.is_working

    @property
    def is_lost(self) -> bool:
        """True from the report that the link is gone until it is back."""
        return self._reported_linked is False

    def set_up(self, *, up: bool) -> None:
        """Bring the link up or down, soon."""
        if self._wanted_up == up:  # nearly always; waking would shorten the link's checks
            return
        logger.info("radio %s", "back" if up else "down")
        self._wanted_up = up
        self._worker.wake()

    def publish(self, key: str, payload: bytes, qos: Qos) -> None:
        """Send if there is a bus."""
        with self._using:
            if self._bus is not None:
                self._bus.publish(key, payload, qos)

    def ask(self, selector: str, timeout_s: float, on_reply: ReplyHandler) -> None:
        """Query the station, ahead of live data, if there is a bus; see ``shared.bus``."""
        with self._using:
            if self._bus is not None:
                self._bus.ask(selector, b"", timeout_s, on_reply, urgent=True)

    def close(self) -> None:
        """Stop and close the bus, without waiting for a query handler that hangs on the disk."""
        end_s = time.monotonic() + _CLOSING_S
        closed = self._worker.close(_CLOSING_S)
        if closed and self._closing is not None:
            self._closing.join(max(0.0, end_s - time.monotonic()))
            closed = not self._closing.is_alive()
        if not closed:
            logger.error("the link is not closed: an answer to the station hangs")

    def _step(self) -> float:
        """Open the bus where it is wanted, and hold it until it is lost."""
        if not self._wanted_up:
            return UNTIL_WOKEN
        if self._link_lost and not self._is_reachable():
            return 0.0
        return 0.0 if self._maintain() else _RETRY_S

    def _maintain(self) -> bool:
        """Keep the link up for as long as it is wanted; False when it cannot be opened."""
        declared = ExitStack()
        try:
            bus = self._station.open_bus()
            declared.callback(bus.close)
            self._declare(bus, declared)
        except BusError as error:
            declared.close()
            if not self._failure_reported:
                logger.warning("%s; trying again every second", error)
            self._failure_reported = True
            self._report_state(None)
            return False
        self._failure_reported = False
        self._bus = bus
        self._watch(bus)
        self._forget_bus()
        if (
            self._link_lost
        ):  # closing a bus without a station may take seconds, in which the link may be back
            self._closing = Thread(target=declared.close, name="link-closing", daemon=True)
            self._closing.start()
        else:
            declared.close()
        return True

    def _watch(self, bus: Bus) -> None:
        """Check the link until it is no longer wanted, is lost, or was not made in time."""
        checks_without = 0
        was_linked = False
        max_checks = _REOPEN_AFTER_S / _CHECK_S
        while checks_without < (_LOST_CHECKS if was_linked else max_checks):
            linked = bus.is_linked()
            was_linked = was_linked or linked
            checks_without = 0 if linked else checks_without + 1
            self._report_state(bus if linked else None)
            if self._worker.wait(_CHECK_S) or not self._wanted_up:
                return
        self._link_lost = True
        logger.debug("opening the bus anew")

    def _is_reachable(self) -> bool:
        """Probe for the station, for the time of one check."""
        self._link_lost = not self._station.is_reachable(_CHECK_S)
        if self._link_lost:
            self._report_state(None)
        return not self._link_lost

    def _report_state(self, bus: Bus | None) -> None:
        """Log once when the station comes, and once when it goes; None: there is no link."""
        is_subscribed = bus is not None and bus.has_subscriber(HEARTBEAT.key(self._unit_id))
        self._checks_unlinked = 0 if is_subscribed else self._checks_unlinked + 1
        if is_subscribed and self._reported_linked is not True:
            self._reported_linked = True
            logger.info("linked to the station")
        elif self._checks_unlinked >= _CHECKS_UNTIL_REPORTED and self._reported_linked is not False:
            self._reported_linked = False
            # Finding the reason takes seconds, in which the link may be back.
            Thread(target=self._report_reason, args=(bus is not None,), daemon=True).start()

    def _report_reason(self, is_linked: bool) -> None:
        reason = _NO_SUBSCRIBER if is_linked else self._station.link_failure_reason()
        if self._reported_linked is False:
            logger.warning("no link: %s; messages are kept and sent later", reason)

    def _declare(self, bus: Bus, declared: ExitStack) -> None:
        for unit_id in (self._unit_id, EVERY_UNIT):
            declared.callback(bus.subscribe(COMMAND.key(unit_id), self._on_command).close)
        for key_expression, handler in self._served:
            declared.callback(bus.serve(key_expression, handler).close)
        declared.callback(bus.declare_alive(alive_key(self._unit_id)).close)

    def _forget_bus(self) -> None:
        """Drop the bus, so that no thread publishes on it while it closes."""
        with self._using:
            self._bus = None
