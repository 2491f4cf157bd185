"""Messages that wait for an acknowledgement: acknowledged once they are on the disk, and not
before.
"""

from __future__ import annotations

from collections.abc import Callable

import pytest

from base_station.core.events import event_of, number_of
from base_station.core.pipeline import StationPipeline
from base_station.engine.admission import Admission, classify, mark_missing
from base_station.engine.delivery_queue import DeliveryQueue
from shared.channels import POSITION
from shared.clock import ManualClock
from shared.codec import encode
from shared.errors import StoreError
from shared.messages import Position
from tests.rig.live_station import make_pipeline

KEY = POSITION.key("FF-01")


class Disk:
    """A log that keeps every record until it is set not to."""

    problem = ""
    low_disk_space = ""
    is_behind = False
    refuses = False

    def __init__(self) -> None:
        self.is_full = False
        self.flushes_in_time = True
        self.flushed = 0

    def write(self, t_ns: int, key: str, payload: bytes) -> bool:
        return not self.is_full

    def flush(self) -> bool:
        self.flushed += 1
        return self.flushes_in_time


class Engine:
    """An engine that admits every message."""

    def __init__(self, clock: ManualClock) -> None:
        self.disk = Disk()
        self.pipeline: StationPipeline = make_pipeline()
        self.queue = DeliveryQueue(self.pipeline, self.disk, clock)

    def admit(self, t_ns: int, key: str, payload: bytes) -> Admission:
        event = event_of(t_ns, key, payload)
        admission = classify(key, event, self.pipeline.state)
        if admission is Admission.ACCEPT:
            is_kept = self.disk.write(t_ns, key, payload)
            self.pipeline.step(event)
            if not is_kept:
                mark_missing(number_of(event), self.pipeline.state)
        return admission


@pytest.fixture
def engine(clock: ManualClock) -> Engine:
    return Engine(clock)


def test_message_is_acknowledged_once_it_is_on_the_disk(
    engine: Engine, make_position: Callable[..., Position]
) -> None:
    message = (KEY, encode(make_position()))
    first = engine.queue.put([message, (KEY, encode(make_position()))])
    again = engine.queue.put([message])
    assert not first.done()
    engine.queue.admit_waiting(engine.admit)
    assert first.result(0.0).admissions == (Admission.ACCEPT, Admission.ACCEPT)
    assert again.result(0.0).count(Admission.DUPLICATE) == 1
    assert engine.disk.flushed == 1
    engine.queue.admit_waiting(engine.admit)
    assert engine.disk.flushed == 1


def test_message_refused_by_a_full_disk_can_be_sent_again(
    engine: Engine, make_position: Callable[..., Position]
) -> None:
    message = (KEY, encode(make_position()))
    engine.disk.is_full, engine.disk.problem = True, "the disk is full"
    refused = engine.queue.put([message])
    engine.queue.admit_waiting(engine.admit)
    with pytest.raises(StoreError, match="the disk is full; send it again"):
        refused.result(0.0)
    engine.disk.is_full = False
    taken = engine.queue.put([message])
    engine.queue.admit_waiting(engine.admit)
    assert taken.result(0.0).count(Admission.ACCEPT) == 1


def test_message_not_on_the_disk_in_time_is_not_acknowledged(
    engine: Engine, make_position: Callable[..., Position]
) -> None:
    engine.disk.flushes_in_time = False
    late = engine.queue.put([(KEY, encode(make_position()))])
    engine.queue.admit_waiting(engine.admit)
    with pytest.raises(StoreError, match="slow"):
        late.result(0.0)


def test_stopping_engine_refuses_waiting_messages(engine: Engine) -> None:
    waiting = engine.queue.put([(KEY, b"")])
    engine.queue.refuse_waiting()
    with pytest.raises(StoreError, match="stopping"):
        waiting.result(0.0)
