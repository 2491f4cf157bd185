"""A station of a department that reports what a test gives it, over a link of its own."""

from __future__ import annotations

import time

import msgspec

from base_station.department_wire import (
    Event,
    EventBatch,
    EventBody,
    EventReceipt,
    Summary,
    pack,
    unpack,
)
from shared.bus_zenoh import UnitEndpoint, ZenohBus
from shared.channels import Qos, department_events_key, department_summary_key
from shared.enrolment import Enrolment
from tests.rig.waiting import until

_TIMEOUT_S = 10.0


class DepartmentReporter:
    def __init__(self, enrolment: Enrolment) -> None:
        self.name = enrolment.name
        self._bus = ZenohBus(UnitEndpoint(enrolment.connect, enrolment.identity))
        self._seq = 0

    @property
    def is_received(self) -> bool:
        """The department listens."""
        return self._bus.has_subscriber(department_summary_key(self.name))

    def publish(self, summary: Summary) -> None:
        self._bus.publish(department_summary_key(self.name), pack(summary), Qos.LIVE)

    def hand_over(self, *bodies: EventBody) -> None:
        """Until there is a receipt, as a station does."""
        after_seq, now_ms = self._seq, self.now_ms()
        self._seq += len(bodies)
        events = tuple(
            Event(seq, f"{self.name}/{seq}", now_ms, msgspec.Raw(pack(body)))
            for seq, body in enumerate(bodies, start=after_seq + 1)
        )
        batch = pack(EventBatch(1, now_ms, after_seq, events))
        until(lambda: self._stored_seq(batch) >= self._seq, "a receipt")

    def close(self) -> None:
        self._bus.close()

    @staticmethod
    def now_ms() -> int:
        return time.time_ns() // 1_000_000

    def _stored_seq(self, batch: bytes) -> int:
        replies = self._bus.query(department_events_key(self.name), batch, _TIMEOUT_S)
        return max((unpack(one, EventReceipt).stored_seq for one in replies), default=0)
