"""What is sent is on disk before; what the disk refuses is sent all the same."""

from __future__ import annotations

import itertools
from collections.abc import Sized
from contextlib import contextmanager
from functools import partial

import pytest

from edge.outbox import Outbox
from edge.spool import Spool
from shared.channels import Qos
from shared.errors import BusError, StoreError
from shared.messages import EventKind, Temperature, UnitEvent
from tests.waiting import until


@pytest.fixture
def spool(tmp_path):
    spool = Spool(tmp_path / "journal.sqlite", itertools.count(1).__next__, 0, 10**9)
    yield spool
    spool.close()


@pytest.fixture
def full_disk(spool, monkeypatch):
    """While it is entered, the disk takes nothing."""

    def refuse(messages):
        raise StoreError("the disk is full")

    @contextmanager
    def full():
        with monkeypatch.context() as patch:
            patch.setattr(spool, "append", refuse)
            yield

    return full


def test_everything_is_sent_in_order_and_was_on_disk_before(spool, stamper):
    sent = []

    def publish(key: str, payload: bytes, qos: Qos) -> None:
        on_disk = [entry.payload for entry in spool.read(spool.boot_id, 1, 10**6)]
        assert payload in on_disk
        sent.append((key, payload, qos))

    outbox = Outbox("FF-01", spool, publish)
    for degc in range(40):
        outbox.put((Temperature(stamper.header(), degc), Temperature(stamper.header(), degc)))
    outbox.put((UnitEvent(stamper.header(), EventKind.MAYDAY),))
    outbox.close()
    assert len(sent) == 81
    assert [payload for _, payload, _ in sent] == [
        entry.payload for entry in spool.read(spool.boot_id, 1, 81)
    ]
    assert sent[0][0] == "muster/v1/FF-01/up/temperature"
    assert sent[-1][0::2] == ("muster/v1/FF-01/alert/event", Qos.ALERT)


def test_what_is_on_disk_is_not_written_again(spool, stamper, monkeypatch):
    written: list[int] = []
    sent: list[bytes] = []
    append = spool.append

    def count(messages):
        written.extend(message.seq for message in messages)
        append(messages)

    monkeypatch.setattr(spool, "append", count)
    outbox = Outbox("FF-01", spool, lambda key, payload, qos: sent.append(payload))
    for number in (1, 2, 3):
        outbox.put((UnitEvent(stamper.header(), EventKind.MAYDAY),))
        until(partial(holds, sent, number))
    outbox.close()
    assert written == [1, 2, 3]
    assert outbox.never_saved == 0


def test_a_disk_that_refuses_stops_nothing_and_is_made_good(spool, stamper, full_disk):
    sent = []
    outbox = Outbox("FF-01", spool, lambda key, payload, qos: sent.append(payload))
    with full_disk():
        outbox.put((Temperature(stamper.header(), 20.0), Temperature(stamper.header(), 21.0)))
        until(lambda: len(sent) == 2)
        assert "the disk is full" in str(outbox.storage_fault)
        assert outbox.is_working
    outbox.put((Temperature(stamper.header(), 22.0),))
    outbox.close()
    assert [entry.payload for entry in spool.read(spool.boot_id, 1, 9)] == sent
    assert outbox.never_saved == 0
    assert not outbox.storage_fault


def test_a_disk_that_has_just_refused_is_not_asked_at_every_message(spool, stamper, monkeypatch):
    """Thousands wait: to offer them ten times a second leaves the tracker no processor."""
    offered: list[int] = []
    sent: list[bytes] = []
    append = spool.append

    def refuse(messages):
        offered.append(len(messages))
        raise StoreError("the disk is full")

    monkeypatch.setattr("edge.outbox._AGAIN_S", 600.0)
    monkeypatch.setattr(spool, "append", refuse)
    outbox = Outbox("FF-01", spool, lambda key, payload, qos: sent.append(payload))
    for number in range(1, 6):
        outbox.put((UnitEvent(stamper.header(), EventKind.MAYDAY),))
        until(partial(holds, sent, number))
    assert offered == [1]
    monkeypatch.setattr(spool, "append", append)
    outbox.close()
    assert [entry.seq for entry in spool.read(spool.boot_id, 1, 9)] == [1, 2, 3, 4, 5]


def test_an_alert_is_not_ousted_by_what_came_after_it(spool, stamper, monkeypatch, full_disk):
    """Neither a disk nor a link for minutes: the mayday is what must not be missing."""
    monkeypatch.setattr("edge.outbox._UNSAVED_KEPT", 3)
    sent = []
    outbox = Outbox("FF-01", spool, lambda key, payload, qos: sent.append(payload))
    with full_disk():
        outbox.put((UnitEvent(stamper.header(), EventKind.MAYDAY),))
        outbox.put(Temperature(stamper.header(), degc) for degc in range(5))
        until(partial(holds, sent, 6))
    outbox.put((Temperature(stamper.header(), 5.0),))
    outbox.close()
    assert [entry.seq for entry in spool.read(spool.boot_id, 1, 9)] == [1, 5, 6, 7]
    assert outbox.never_saved == 3


def test_what_a_full_disk_cost_is_counted_and_said(spool, stamper, monkeypatch, caplog, full_disk):
    monkeypatch.setattr("edge.outbox._UNSAVED_KEPT", 3)
    sent = []
    outbox = Outbox("FF-01", spool, lambda key, payload, qos: sent.append(payload))
    with full_disk():
        for number in range(1, 6):
            outbox.put((UnitEvent(stamper.header(), EventKind.MAYDAY),))
            until(partial(holds, sent, number))
    outbox.put((UnitEvent(stamper.header(), EventKind.MAYDAY),))
    outbox.close()
    assert [entry.payload for entry in spool.read(spool.boot_id, 1, 9)] == sent[3:]
    assert outbox.never_saved == 3
    said = [record.getMessage() for record in caplog.records]
    assert said[1:] == [
        "the journal can be written again; 3 messages were sent and not kept since the start"
    ]


def test_a_bus_that_fails_ends_nothing(spool, stamper, caplog):
    sent = []

    def publish(key: str, payload: bytes, qos: Qos) -> None:
        sent.append(key)
        if len(sent) in (2, 3):
            raise BusError("the bus is closed")

    outbox = Outbox("FF-01", spool, publish)
    for number in range(1, 6):
        outbox.put((UnitEvent(stamper.header(), EventKind.MAYDAY),))
        until(partial(holds, sent, number))
    assert outbox.is_working
    outbox.close()
    assert [entry.seq for entry in spool.read(spool.boot_id, 1, 9)] == [1, 2, 3, 4, 5]
    assert len(caplog.records) == 1


def test_what_cannot_be_put_into_bytes_does_not_cost_the_alert_behind_it(spool, stamper):
    sent = []
    outbox = Outbox("FF-01", spool, lambda key, payload, qos: sent.append(key))
    nonsense = Temperature(stamper.header(), float("nan"))
    outbox.put((nonsense, UnitEvent(stamper.header(), EventKind.MAYDAY)))
    outbox.close()
    assert sent == ["muster/v1/FF-01/alert/event"]
    assert [entry.seq for entry in spool.read(spool.boot_id, 1, 9)] == [2]


def test_an_alert_does_not_wait_for_the_group(spool, stamper, monkeypatch):
    monkeypatch.setattr("edge.outbox._GROUP_S", 60.0)
    sent = []
    outbox = Outbox("FF-01", spool, lambda key, payload, qos: sent.append(key))
    for count in range(1, 6):
        outbox.put((UnitEvent(stamper.header(), EventKind.MAYDAY),))
        until(partial(holds, sent, count), "the alert is sent")
    outbox.close()


def test_what_is_not_urgent_is_written_with_what_comes_next(spool, stamper, monkeypatch):
    """Each commit waits for the disk, and wears it."""
    monkeypatch.setattr("edge.outbox._GROUP_S", 600.0)
    written: list[int] = []
    sent: list[bytes] = []
    append = spool.append

    def count(messages):
        written.append(len(messages))
        append(messages)

    monkeypatch.setattr(spool, "append", count)
    outbox = Outbox("FF-01", spool, lambda key, payload, qos: sent.append(payload))
    outbox.put((Temperature(stamper.header(), 20.0),))
    until(partial(holds, sent, 1))
    for number in range(1, 11):
        outbox.put((Temperature(stamper.header(), 20.0),))
        until(outbox._waiting.empty, "the outbox has it at hand")
        outbox.put((UnitEvent(stamper.header(), EventKind.MAYDAY),))
        until(partial(holds, sent, 1 + 2 * number))
    outbox.close()
    assert written == [1, *[2] * 10]


def holds(sent: Sized, count: int) -> bool:
    return len(sent) == count
