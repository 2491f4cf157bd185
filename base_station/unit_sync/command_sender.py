"""Sender of commands to the units, which repeats them until they are answered or expire.  The
engine reports the open commands once a second, and at once when there is a new one (``report``); a
thread of this module publishes them on the bus.  The station receives its own messages there, so
the log has each sending of a command.  A unit without a link gets the command when it is back.
Names are inserted for the unit only: the log has none.
"""

from __future__ import annotations

import logging
from collections.abc import Callable, Sequence
from contextlib import suppress

import msgspec

from base_station.core.state.command import Order
from shared.bus import Bus
from shared.channels import COMMAND
from shared.clock import NS_PER_S, Clock
from shared.codec import decode, encode
from shared.errors import WireError
from shared.header_factory import HeaderFactory
from shared.log_on_change import LogOnChange
from shared.messages import Command
from shared.worker import UNTIL_WOKEN, Worker

logger = logging.getLogger(__name__)

_AGAIN_AFTER_NS = 2 * NS_PER_S  # a reply takes a second on a bad link
_POLL_INTERVAL_S = 0.2  # whether a unit is back
_COMMANDS = f"/{COMMAND.suffix}"

Offer = Callable[[str, bytes], None]  # takes key and payload


def without_text_of_commands(offer: Offer) -> Offer:
    """Commands to units have names in their texts, which do not belong in the log: there the action
    has the text that the command was sent for.
    """

    def take(key: str, payload: bytes) -> None:
        if key.endswith(_COMMANDS):
            with suppress(WireError):
                sent = decode(COMMAND, payload)
                if isinstance(sent, Command) and sent.text:
                    payload = encode(msgspec.structs.replace(sent, text=""))
        offer(key, payload)

    return take


class CommandSender:
    """``start`` it with a bus; ``report`` may be called from any thread and never waits.

    ``header_factory`` is this module's own; ``clock`` gives station time.
    """

    def __init__(
        self,
        bus: Bus,
        header_factory: HeaderFactory,
        clock: Clock,
        shown: Callable[[str], str] = str,
    ) -> None:
        """``shown`` puts the names into a text."""
        self._bus = bus
        self._shown = shown
        self._header_factory = header_factory
        self._clock = clock
        self._sent_ns: dict[tuple[str, str], int] = {}  # unit and command: when last
        self._orders: Sequence[Order] = ()
        self._fault_log = LogOnChange(logger, "a command cannot be sent; trying again")
        self._worker = Worker("downlink", self._step, "commands are not sent")

    def start(self) -> None:
        self._worker.start()

    def report(self, orders: Sequence[Order]) -> None:
        """Replace the unanswered orders."""
        self._orders = orders
        self._worker.wake()

    def close(self) -> None:
        self._worker.close()

    def _step(self) -> float:
        orders = self._orders
        self.send_due(orders)
        return _POLL_INTERVAL_S if orders else UNTIL_WOKEN

    def send_due(self, orders: Sequence[Order]) -> None:
        """Send all due orders; one that cannot be sent does not delay the others."""
        now_ns = self._clock.monotonic_ns()
        sent_ns = {}
        failure: Exception | None = None
        for order in orders:
            name = order.unit_id, order.command_id
            try:
                last_ns = self._send(order, self._sent_ns.get(name), now_ns)
            except Exception as error:  # noqa: BLE001  # logged behind the other orders
                failure = error
                continue
            if last_ns is not None:
                sent_ns[name] = last_ns
        self._sent_ns = sent_ns
        if failure is None:
            self._fault_log.note_success()
        else:
            self._fault_log.note_failure(failure)

    def _send(self, order: Order, before_ns: int | None, now_ns: int) -> int | None:
        """Send an order if it is due; gives the time of its last sending, None: never yet."""
        key = COMMAND.key(order.unit_id)
        if self._clock.utc_ns() >= order.expires_ns or not self._bus.has_subscriber(key):
            return None  # without a last time, it is sent at once when the unit is back
        if before_ns is not None and now_ns - before_ns < _AGAIN_AFTER_NS:
            return before_ns
        self._bus.publish(key, encode(self._command(order)), COMMAND.qos)
        return now_ns

    def _command(self, order: Order) -> Command:
        return Command(
            header=self._header_factory.header(),
            command_id=order.command_id,
            kind=order.kind,
            issued_by=order.issued_by,
            expires_utc_ns=order.expires_ns,
            text=self._shown(order.text),
            position_rate_hz=order.position_rate_hz,
            ended_command_id=order.ended_command_id,
            mayday_boot_id=order.mayday_boot_id,
            mayday_seq=order.mayday_seq,
            repeats=order.repeats,
        )
