"""Markers of other systems become log records in the order of their arrival."""

from __future__ import annotations

import pytest

from base_station.engine.external_queue import ExternalQueue
from shared.channels import EXTERNAL
from shared.clock import ManualClock
from shared.codec import decode
from shared.header_factory import HeaderFactory
from shared.messages import STATION_ID, ExternalMarkers


class Log:
    """Queue of markers with the records that it appended."""

    def __init__(self, clock: ManualClock) -> None:
        self.records: list[tuple[int, str, bytes]] = []
        self.queue = ExternalQueue(
            lambda *record: self.records.append(record), HeaderFactory(STATION_ID, 7, clock)
        )

    @property
    def removed(self) -> list[tuple[str, ...]]:
        messages = [decode(EXTERNAL, payload) for _, _, payload in self.records]
        return [one.removed for one in messages if isinstance(one, ExternalMarkers)]


def test_batches_are_applied_in_order_and_not_before_the_last_action() -> None:
    clock = ManualClock()
    log = Log(clock)
    log.queue.put((), ("a",))
    log.queue.put((), ("b",))
    not_before_ns = clock.utc_ns() + 5
    log.queue.apply_waiting(not_before_ns)
    log.queue.apply_waiting(not_before_ns)  # each batch once
    key = EXTERNAL.key(STATION_ID)
    assert [record[:2] for record in log.records] == [(not_before_ns, key)] * 2
    assert log.removed == [("a",), ("b",)]


def test_full_queue_drops_its_oldest_batch_and_logs_it(caplog: pytest.LogCaptureFixture) -> None:
    log = Log(ManualClock())
    for number in range(21):
        log.queue.put((), (str(number),))
    log.queue.apply_waiting(0)
    assert log.removed == [(str(number),) for number in range(1, 21)]
    assert "some are left out" in caplog.text
