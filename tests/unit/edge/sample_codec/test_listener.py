"""Messages that a tracking agent receives from its unit, and requests to its journal."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from threading import Event

import msgspec
import numpy as np
import pytest

from edge.sample_codec.codec import SampleEncoder
from edge.sample_codec.descriptions import unit_sensor
from edge.sample_codec.listener import RawStreamListener
from edge.samples import SensorDescription
from edge.sources.bus import BusSource
from shared.bus import Bus
from shared.bus_memory import MemoryRouter
from shared.channels import DESCRIPTION, IMU, NO_TRACKER, Qos, raw_journal_key
from shared.clock import ManualClock
from shared.codec import encode
from shared.errors import BusError, RecordingError
from shared.messages import Header, JournalChunk, JournalEntry, RawImu

U = "FF-01"
SENSOR = SensorDescription("weak", 200.0)
SPAN_MS = 50  # of samples in a message
Answer = Callable[[int, int], list[JournalChunk]]  # of what is asked: from, to


def raw(seq: int, boot_id: int = 7, ms: int | None = None) -> RawImu:
    """The message that begins at ``ms``; else the numbers have only raw samples."""
    began_ms = SPAN_MS * seq if ms is None else ms
    t_ns = (began_ms + np.arange(0, SPAN_MS, 5)) * 1_000_000
    at_rest = np.tile([0.0, 0.0, 9.81], (len(t_ns), 1))
    return RawImu(Header(U, boot_id, seq, int(t_ns[0])), t_ns, at_rest, np.zeros((len(t_ns), 3)))


def piece(first: int, last: int, *kept: RawImu) -> JournalChunk:
    entries = tuple(JournalEntry(one.header.seq, IMU.suffix, encode(one)) for one in kept)
    return JournalChunk(7, first, last, entries, raw_only=True)


class Unit:
    """A unit on a bus, and who listens to it."""

    def __init__(self) -> None:
        self.router = MemoryRouter()
        self.clock = ManualClock()
        self.listener = RawStreamListener(U, self.router.attach_station, self.clock)
        assert self.listener.open(Event())
        self._bus = self.router.attach_unit()
        self.asked: list[tuple[int, int]] = []
        self.journal: Answer = lambda _first, _last: []
        self._bus.serve(raw_journal_key(U), self._replies)

    def says(self, *messages: RawImu) -> None:
        for message in messages:
            self.publishes(encode(message))

    def publishes(self, payload: bytes) -> None:
        self._bus.publish(IMU.key(U), payload, Qos.LIVE)

    def describes(self, boot_id: int = 7, tracker: str = NO_TRACKER) -> None:
        sent = (unit_sensor("", SENSOR),)
        reported = SampleEncoder(U, boot_id).description(0, sent, source="", tracker=tracker)
        self._bus.publish(DESCRIPTION.key(U), encode(reported), Qos.LIVE)

    def publishes_description(self, payload: bytes) -> None:
        self._bus.publish(DESCRIPTION.key(U), payload, Qos.LIVE)

    def taken(self, boot_id: int = 7) -> list[int]:
        """The numbers of what is there of this run."""
        seqs = []
        while (message := self.listener.take(boot_id, 0.0)) is not None:
            seqs.append(message.header.seq)
        return seqs

    def fetched(self, after: int, before: int) -> list[int]:
        return [one.header.seq for one in self.listener.fetch(7, after, before)]

    def followed(self) -> BusSource:
        source = BusSource(U)
        assert source.follow(self.listener, Event())
        return source

    def _replies(self, _key: str, parameters: str, _payload: bytes) -> Iterator[bytes]:
        values = dict(pair.split("=") for pair in parameters.split(";"))
        first, last = int(values["from"]), int(values["to"])
        assert values["epoch"] == "7"
        self.asked.append((first, last))
        yield from (chunk.to_bytes() for chunk in self.journal(first, last))


@pytest.fixture
def unit() -> Iterator[Unit]:
    unit = Unit()
    yield unit
    unit.listener.close()


class StopAfterOneRound(Event):
    """To be stopped after one look."""

    def is_set(self) -> bool:
        has_looked = super().is_set()
        self.set()
        return has_looked


def test_messages_are_taken_in_the_order_in_which_they_came(unit: Unit) -> None:
    unit.describes()
    unit.says(raw(3), raw(1), raw(2), raw(1, boot_id=8), raw(2, boot_id=8))
    assert unit.taken() == [3, 1, 2]
    assert unit.listener.has_restarted(7)
    assert not unit.listener.has_restarted(8)
    assert unit.taken(boot_id=8) == [1, 2]
    assert not unit.listener.has_restarted(7), "of nothing nobody knows"


def test_messages_of_other_units_are_not_received(unit: Unit) -> None:
    other = unit.router.attach_unit()
    other.publish(IMU.key("FF-02"), encode(raw(1)), Qos.LIVE)
    assert unit.taken() == []


def test_a_run_begins_when_its_sensor_is_known(unit: Unit) -> None:
    unit.says(raw(1))
    assert unit.listener.next_boot(StopAfterOneRound()) is None
    unit.describes(boot_id=8)
    assert unit.listener.next_boot(StopAfterOneRound()) is None, "the sensor of another run"
    unit.describes()
    assert unit.listener.next_boot(Event()) == (7, {"": SENSOR})
    assert unit.taken() == [1], "waiting took nothing"


def test_a_description_alone_is_no_run(unit: Unit) -> None:
    unit.describes()
    assert unit.listener.next_boot(StopAfterOneRound()) is None


def test_for_a_unit_that_tracks_itself_nothing_is_tracked(unit: Unit) -> None:
    unit.describes(tracker="eskf")
    unit.says(raw(1))
    source = BusSource(U)
    assert not source.follow(unit.listener, StopAfterOneRound())


def test_unreadable_message_costs_nothing_else(unit: Unit) -> None:
    unit.publishes(b"\xff\xff")
    unit.publishes_description(b"\xff\xff")
    unit.describes()
    unit.says(raw(1))
    assert unit.listener.next_boot(Event()) == (7, {"": SENSOR})
    assert unit.listener.not_understood == 2


def test_batches_faster_than_their_consumer_are_dropped_newest_first(unit: Unit) -> None:
    payload = encode(raw(1))
    for _ in range(4096):
        unit.publishes(payload)
    unit.says(raw(2), raw(3))
    assert unit.listener.dropped == 2
    assert unit.taken() == [1] * 4096
    unit.says(raw(4))
    assert unit.taken() == [4]


def test_a_run_that_is_over_is_forgotten_where_it_was_not_described(unit: Unit) -> None:
    unit.describes(boot_id=5)
    unit.says(raw(1, boot_id=5), raw(1, boot_id=6), raw(2, boot_id=6), raw(1))
    assert unit.listener.dropped == 2
    assert unit.taken(boot_id=5) == [1]
    assert unit.taken() == [1]


def test_a_run_that_another_has_followed_is_received_when_that_one_has_been_silent(
    unit: Unit,
) -> None:
    for boot_id in (7, 8):
        unit.describes(boot_id)
        unit.says(raw(1, boot_id))
    unit.clock.advance(100.0)
    unit.says(raw(2, boot_id=8), raw(2))
    unit.clock.advance(4.9)
    unit.says(raw(3))
    unit.clock.advance(0.1)
    unit.says(raw(4), raw(3, boot_id=8))
    assert unit.taken() == [1]
    assert unit.taken(boot_id=8) == [1, 2]
    assert unit.taken() == [4]
    assert unit.listener.dropped == 3


def test_a_bus_that_cannot_be_opened_is_tried_again(unit: Unit) -> None:
    stop = Event()
    refusals = [BusError("no router")] * 3

    def open_bus() -> Bus:
        if refusals:
            raise refusals.pop()
        return unit.router.attach_station()

    assert not RawStreamListener(U, open_bus).open(StopAfterOneRound())
    listener = RawStreamListener(U, open_bus)
    stop.wait = lambda timeout=None: False  # type: ignore[method-assign]  # nobody waits here
    assert listener.open(stop)
    assert not refusals
    listener.close()


def test_closed_listener_receives_nothing_more(unit: Unit) -> None:
    unit.listener.close()
    unit.says(raw(1))
    assert unit.taken() == []


def test_a_journal_is_asked_until_all_is_there(unit: Unit) -> None:
    """A question brings as much as the link carries in good time."""
    unit.journal = lambda first, last: [
        piece(first, first + 1, raw(first), raw(first + 1)),
        piece(first + 2, min(first + 3, last), raw(first + 2)),
    ]
    assert unit.fetched(10, 19) == [11, 12, 13, 15, 16, 17]
    assert unit.asked == [(11, 18), (15, 18)]


def test_a_journal_that_has_nothing_is_asked_once(unit: Unit) -> None:
    assert unit.fetched(10, 19) == []
    assert unit.asked == [(11, 18)]
    assert unit.fetched(10, 11) == []
    assert unit.asked == [(11, 18)], "there is nothing between"


def test_a_journal_that_answers_slowly_is_left_alone_after_fifteen_seconds(unit: Unit) -> None:
    def slowly(first: int, _: int) -> list[JournalChunk]:
        unit.clock.advance(5.0)
        return [piece(first, first, raw(first))]

    unit.journal = slowly
    assert unit.fetched(10, 100) == [11, 12, 13]


def test_the_same_sensor_gives_its_samples(unit: Unit) -> None:
    unit.describes()
    unit.says(raw(1), raw(2), raw(1, boot_id=8))
    source = unit.followed()
    assert source.description == SENSOR
    assert [len(batch.imu) for batch in source.batches()] == [10, 10]


@pytest.mark.parametrize(
    ("seqs", "ms", "asked"),
    [
        ((1, 2), (0, 50), []),
        ((1, 9), (0, 50), []),  # other messages lie between
        ((1, 9), (0, 90), []),
        ((1, 9), (0, 91), [(2, 8)]),
        ((1, 2), (0, 5000), []),  # the sensor had nothing to say
        ((1, 9), (0, -5000), []),
    ],
)
def test_messages_lost_by_the_radio_are_requested_where_time_has_a_gap(
    unit: Unit, seqs: tuple[int, int], ms: tuple[int, int], asked: list[tuple[int, int]]
) -> None:
    unit.describes()
    unit.says(*map(lambda seq, at: raw(seq, ms=at), seqs, ms), raw(1, boot_id=8))
    assert len(list(unit.followed().batches())) == 2
    assert unit.asked == asked


def test_a_unit_that_is_silent_for_a_while_has_not_ended_its_run(
    unit: Unit, monkeypatch: pytest.MonkeyPatch
) -> None:
    unit.describes()
    unit.says(raw(0))
    source = unit.followed()
    comes = [raw(1), None, None, raw(2)]
    monkeypatch.setattr(unit.listener, "take", lambda *_: comes.pop(0) if comes else None)
    monkeypatch.setattr(unit.listener, "has_restarted", lambda _: not comes)
    assert len(list(source.batches())) == 2


def test_samples_before_joining_a_run_are_not_requested(unit: Unit) -> None:
    unit.describes()
    unit.says(raw(900), raw(1, boot_id=8))
    assert len(list(unit.followed().batches())) == 1
    assert unit.asked == []


def test_lost_batch_is_inserted_in_order_and_dropped_when_late(unit: Unit) -> None:
    unit.describes()
    unit.journal = lambda first, last: [piece(first, last, raw(2), raw(3))]
    unit.says(raw(1), raw(4), raw(3), raw(4), raw(5), raw(1, boot_id=8))
    source = unit.followed()
    began_ms = [int(batch.imu.t_ns[0]) // 1_000_000 for batch in source.batches()]
    assert began_ms == [50, 100, 150, 200, 250]
    assert (source.fetched, source.late) == (2, 2)
    assert unit.asked == [(2, 3)]


def test_invalid_answer_of_a_journal_leaves_the_gap(unit: Unit) -> None:
    unit.describes()
    spoilt = JournalChunk(7, 2, 3, (JournalEntry(2, IMU.suffix, b"\xff\xff"),))
    unit.journal = lambda _first, _last: [spoilt]
    unit.says(raw(1), raw(4), raw(1, boot_id=8))
    source = unit.followed()
    assert len(list(source.batches())) == 2
    assert source.fetched == 0


def test_a_source_that_is_closed_gives_nothing_more(unit: Unit) -> None:
    unit.describes()
    unit.says(raw(1), raw(2))
    source = unit.followed()
    batches = source.batches()
    next(batches)
    source.close()
    assert list(batches) == []


def test_before_the_unit_is_received_there_is_no_sensor() -> None:
    with pytest.raises(RecordingError, match="`muster edge run` only"):
        _ = BusSource(U).description


def test_lost_batches_of_two_sensors_are_fetched_once(unit: Unit) -> None:
    """Two of the left and one of the right were lost; another message of the right came."""
    names = ["left", "right", "left", "right", "left", "right", "left", "right"]
    messages = [
        msgspec.structs.replace(raw(seq, ms=SPAN_MS * (seq // 2)), sensor=name)
        for seq, name in enumerate(names, start=1)
    ]
    lost = [messages[2], messages[3], messages[4]]
    unit.journal = lambda first, last: [
        piece(first, last, *(one for one in messages if first <= one.header.seq <= last))
    ]
    unit.describes()
    unit.says(*(one for one in messages if one not in lost))
    source = unit.followed()
    batches = source.batches()
    taken = [next(batches) for _ in messages]
    assert source.fetched == len(lost)
    for name in ("left", "right"):
        times = np.concatenate([one.imu.t_ns for one in taken if one.sensor == name])
        assert len(times) == 40
        assert len(set(times.tolist())) == 40
