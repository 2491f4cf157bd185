"""The outbox: messages are on disk before they are sent, in order; a failing bus or message costs
no other.
"""

from __future__ import annotations

from collections.abc import Sized
from functools import partial

from edge.agent.outbox import Outbox
from shared.channels import Qos
from shared.errors import BusError
from shared.messages import EventKind, Temperature, UnitEvent
from tests.rig.waiting import until


def test_messages_are_sent_in_order_and_were_on_disk_before(
    journal, journal_writer, header_factory
):
    sent = []

    def publish(key: str, payload: bytes, qos: Qos) -> None:
        on_disk = [entry.payload for entry in journal.read(journal.boot_id, 1, 10**6)]
        assert payload in on_disk
        sent.append((key, payload, qos))

    outbox = Outbox("FF-01", journal_writer, publish)
    for degc in range(40):
        outbox.put(
            (Temperature(header_factory.header(), degc), Temperature(header_factory.header(), degc))
        )
    outbox.put((UnitEvent(header_factory.header(), EventKind.MAYDAY),))
    outbox.close()
    assert len(sent) == 81
    assert [payload for _, payload, _ in sent] == [
        entry.payload for entry in journal.read(journal.boot_id, 1, 81)
    ]
    assert sent[0][0] == "muster/v1/FF-01/up/temperature"
    assert sent[-1][0::2] == ("muster/v1/FF-01/alert/event", Qos.ALERT)


def test_messages_put_together_are_written_together(
    journal, journal_writer, header_factory, monkeypatch
):
    """A latched mayday is sent with the start: a boot that ends between the two would leave a start
    without its mayday.
    """
    written: list[list[int]] = []
    append = journal.append

    def note(messages):
        written.append([message.seq for message in messages])
        append(messages)

    monkeypatch.setattr(journal, "append", note)

    def first_words():
        yield UnitEvent(header_factory.header(), EventKind.STARTED)
        outbox.put((UnitEvent(header_factory.header(), EventKind.FALL),))
        until(lambda: written)  # the outbox has taken all of them
        yield UnitEvent(header_factory.header(), EventKind.MAYDAY)

    outbox = Outbox("FF-01", journal_writer, lambda key, payload, qos: None)
    outbox.put(first_words())
    outbox.close()
    assert written == [[2], [1, 3]]


def test_failing_bus_ends_nothing(journal, journal_writer, header_factory, caplog):
    sent = []

    def publish(key: str, payload: bytes, qos: Qos) -> None:
        sent.append(key)
        if len(sent) in (2, 3):
            raise BusError("the bus is closed")

    outbox = Outbox("FF-01", journal_writer, publish)
    for number in range(1, 6):
        outbox.put((UnitEvent(header_factory.header(), EventKind.MAYDAY),))
        until(partial(holds, sent, number))
    assert outbox.is_working
    outbox.close()
    assert [entry.seq for entry in journal.read(journal.boot_id, 1, 9)] == [1, 2, 3, 4, 5]
    assert len(caplog.records) == 1


def test_unencodable_message_does_not_cost_the_alert_behind_it(
    journal, journal_writer, header_factory
):
    sent = []
    outbox = Outbox("FF-01", journal_writer, lambda key, payload, qos: sent.append(key))
    nonsense = Temperature(header_factory.header(), float("nan"))
    outbox.put((nonsense, UnitEvent(header_factory.header(), EventKind.MAYDAY)))
    outbox.close()
    assert sent == ["muster/v1/FF-01/alert/event"]
    assert [entry.seq for entry in journal.read(journal.boot_id, 1, 9)] == [2]


def test_alert_does_not_wait_for_the_group(journal, journal_writer, header_factory, monkeypatch):
    monkeypatch.setattr("edge.agent.outbox._GROUP_S", 60.0)
    sent = []
    outbox = Outbox("FF-01", journal_writer, lambda key, payload, qos: sent.append(key))
    for count in range(1, 6):
        outbox.put((UnitEvent(header_factory.header(), EventKind.MAYDAY),))
        until(partial(holds, sent, count), "the alert is sent")
    outbox.close()


def test_message_that_is_not_urgent_is_written_with_the_next(
    journal, journal_writer, header_factory, monkeypatch
):
    """Each commit waits for the disk, and wears it."""
    monkeypatch.setattr("edge.agent.outbox._GROUP_S", 600.0)
    written: list[int] = []
    sent: list[bytes] = []
    append = journal.append

    def count(messages):
        written.append(len(messages))
        append(messages)

    monkeypatch.setattr(journal, "append", count)
    outbox = Outbox("FF-01", journal_writer, lambda key, payload, qos: sent.append(payload))
    outbox.put((Temperature(header_factory.header(), 20.0),))
    until(partial(holds, sent, 1))
    for number in range(1, 11):
        outbox.put((Temperature(header_factory.header(), 20.0),))
        until(outbox._waiting.empty, "the outbox has it at hand")
        outbox.put((UnitEvent(header_factory.header(), EventKind.MAYDAY),))
        until(partial(holds, sent, 1 + 2 * number))
    outbox.close()
    assert written == [1, *[2] * 10]


def holds(sent: Sized, count: int) -> bool:
    return len(sent) == count
