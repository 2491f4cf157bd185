"""The unit's link to the bus: up, down, and what it carries while it is up.

Nothing in the unit waits for it.  Opening takes half a second and may fail for hours, so a
thread does it; publishing without a link drops the bytes, which the journal keeps.
"""

from __future__ import annotations

import logging
import time
from collections.abc import Iterable
from contextlib import ExitStack
from threading import Condition, Lock, Thread
from typing import Protocol

from shared.bus import Bus, QueryHandler, ReplyHandler, SampleHandler
from shared.channels import COMMAND, EVERY_UNIT, HEARTBEAT, Qos, alive_key
from shared.errors import BusError

logger = logging.getLogger(__name__)

_RETRY_S = 1.0
_LOOK_EVERY_S = 0.5
_LOOKS_UNTIL_TOLD = 4  # connecting takes a moment
_LOST_LOOKS = 2  # without the link that was there: probe until the station is back
_UNHEARD = "no station listens to this unit: it is starting, or the unit has been revoked there"
_REOPEN_AFTER_S = 15.0  # a session has been seen to stop trying
_CLOSING_S = 10.0  # a bus may take seconds where its link leads nowhere


class OtherEnd(Protocol):
    """The station as seen from a unit."""

    def open_bus(self) -> Bus:
        """Raises BusError when it cannot be opened."""
        ...

    def is_reachable(self, timeout_s: float) -> bool:
        """True as soon as somebody takes connections there; False when the time is over."""
        ...

    def why_no_link(self) -> str:
        """For a person, when a bus stays without a link; may take some seconds."""
        ...


class Link:
    """Opens and closes a bus as told, and declares the unit on it each time."""

    def __init__(
        self,
        unit_id: str,
        station: OtherEnd,
        on_command: SampleHandler,
        served: Iterable[tuple[str, QueryHandler]],
    ) -> None:
        self._unit_id = unit_id
        self._station = station
        self._on_command = on_command
        self._served = tuple(served)
        self._bus: Bus | None = None
        self._wanted_up = True
        self._ended = False
        self._changed = Condition()
        self._using = Lock()
        self._failure_told = False
        self._heard_told: bool | None = None
        self._looks_unheard = 0
        self._closing: Thread | None = None  # of the bus before
        self._away = False  # the link was lost: it makes no sense to try until it may be back
        self._thread = Thread(target=self._run, name="link", daemon=True)
        self._thread.start()

    @property
    def is_working(self) -> bool:
        """Whether it holds the link or seeks it, as it does until it is closed."""
        return self._thread.is_alive()

    def set_up(self, *, up: bool) -> None:
        """Bring the link up or down, soon."""
        with self._changed:
            if self._wanted_up != up:
                logger.info("radio %s", "back" if up else "down")
            self._wanted_up = up
            self._changed.notify_all()

    def publish(self, key: str, payload: bytes, qos: Qos) -> None:
        """Send if there is a bus."""
        with self._using:
            if self._bus is not None:
                self._bus.publish(key, payload, qos)

    def ask(self, selector: str, timeout_s: float, on_reply: ReplyHandler) -> None:
        """Ask the station, ahead of live data, if there is a bus; see ``shared.bus``."""
        with self._using:
            if self._bus is not None:
                self._bus.ask(selector, b"", timeout_s, on_reply, urgent=True)

    def close(self) -> None:
        """What still answers the station out of a journal whose disk hangs is left to the end of
        the process.
        """
        with self._changed:
            self._ended = True
            self._changed.notify_all()
        end_s = time.monotonic() + _CLOSING_S
        for thread in filter(None, (self._thread, self._closing)):
            thread.join(max(0.0, end_s - time.monotonic()))
            if thread.is_alive():
                logger.error("the link is not closed: an answer to the station hangs")
                return

    def _run(self) -> None:
        while True:
            with self._changed:
                self._changed.wait_for(lambda: self._wanted_up or self._ended)
                if self._ended:
                    return
            if self._away and not self._is_reachable():
                continue
            if not self._hold():
                with self._changed:
                    self._changed.wait_for(lambda: self._ended, timeout=_RETRY_S)

    def _hold(self) -> bool:
        """Keep the link up for as long as it is wanted; False when it cannot be opened."""
        declared = ExitStack()
        try:
            bus = self._station.open_bus()
            declared.callback(bus.close)
            self._declare(bus, declared)
        except BusError as error:
            declared.close()
            if not self._failure_told:
                logger.warning("%s; trying again every second", error)
            self._failure_told = True
            self._tell(None)
            return False
        self._failure_told = False
        self._bus = bus
        self._watch(bus)
        self._forget_bus()
        if self._away:  # closing what leads nowhere may take seconds, in which the link may be back
            self._closing = Thread(target=declared.close, name="link-closing", daemon=True)
            self._closing.start()
        else:
            declared.close()
        return True

    def _watch(self, bus: Bus) -> None:
        """Until the link is no longer wanted, is lost, or did not come about in good time."""
        looks_without = 0
        was_linked = False
        most_looks = _REOPEN_AFTER_S / _LOOK_EVERY_S
        while looks_without < (_LOST_LOOKS if was_linked else most_looks):
            linked = bus.is_linked()
            was_linked = was_linked or linked
            looks_without = 0 if linked else looks_without + 1
            self._tell(bus if linked else None)
            with self._changed:
                if self._changed.wait_for(
                    lambda: self._ended or not self._wanted_up, timeout=_LOOK_EVERY_S
                ):
                    return
        self._away = True
        logger.debug("opening the bus anew")

    def _is_reachable(self) -> bool:
        """Probe for the station for as long as a look takes."""
        self._away = not self._station.is_reachable(_LOOK_EVERY_S)
        if self._away:
            self._tell(None)
        return not self._away

    def _tell(self, bus: Bus | None) -> None:
        """Say once when the station comes, and once when it goes; None: there is no link."""
        heard = bus is not None and bus.is_heard(HEARTBEAT.key(self._unit_id))
        self._looks_unheard = 0 if heard else self._looks_unheard + 1
        if heard and self._heard_told is not True:
            self._heard_told = True
            logger.info("linked to the station")
        elif self._looks_unheard >= _LOOKS_UNTIL_TOLD and self._heard_told is not False:
            self._heard_told = False
            # Finding out takes seconds, in which the link may be back.
            Thread(target=self._tell_why, args=(bus is not None,), daemon=True).start()

    def _tell_why(self, is_linked: bool) -> None:
        why = _UNHEARD if is_linked else self._station.why_no_link()
        if self._heard_told is False:
            logger.warning("no link: %s; messages are kept and sent later", why)

    def _declare(self, bus: Bus, declared: ExitStack) -> None:
        for unit_id in (self._unit_id, EVERY_UNIT):
            declared.callback(bus.subscribe(COMMAND.key(unit_id), self._on_command).close)
        for key_expression, handler in self._served:
            declared.callback(bus.serve(key_expression, handler).close)
        declared.callback(bus.declare_alive(alive_key(self._unit_id)).close)

    def _forget_bus(self) -> None:
        """From here on nobody publishes on a bus that is about to close."""
        with self._using:
            self._bus = None
