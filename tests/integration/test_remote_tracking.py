"""A unit that sends its raw samples, and an agent that tracks for it, over a bus in memory."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from contextlib import closing
from functools import cache
from itertools import islice
from pathlib import Path
from threading import Event

import msgspec
import pytest

from edge.agent.fitted_sensor import FittedSensor
from edge.agent.pipeline import TrackerPipeline, UnitIdentity
from edge.sample_codec.codec import SampleEncoder, batch_of
from edge.sample_codec.listener import RawStreamListener
from edge.sample_codec.uplink import RawUplink
from edge.samples import SensorBatch, SensorDescription
from edge.sources.bus import BusSource
from edge.sources.registry import open_source
from edge.storage.journal.journal import Journal, JournalRow
from edge.storage.journal.server import JournalServer
from edge.tracker.choice.one_sensor import OneSensorTracker
from edge.tracker.registry import NoTracker, make_tracker
from shared.bus_memory import MemoryRouter
from shared.channels import IMU, NO_TRACKER, channel_of, tracker_id
from shared.clock import NS_PER_S, ManualClock
from shared.codec import encode
from shared.header_factory import HeaderFactory
from shared.messages import GpsFix, Message, Position, RawImu, Status, Temperature
from shared.quality import Reason

U = "FF-01"
WALK = "simulated:stairs?seed=3"
SENSOR = open_source(WALK).description
BATCHES = 800  # of the walk, 50 ms each


def batches(one_by_one: bool = False) -> Iterator[SensorBatch]:
    """Samples of a unit's pipeline, rounded as on the wire."""
    raw = SampleEncoder(U, 1)
    for batch in islice(open_source(WALK).batches(), BATCHES):
        if not one_by_one:
            yield batch_of(raw.messages(batch))
            continue
        for row in range(len(batch.imu)):
            others = batch.others if row == 0 else ()
            part = SensorBatch(batch.imu.part(slice(row, row + 1)), others)
            yield batch_of(raw.messages(part))


def run(pipeline: TrackerPipeline, from_: Iterable[SensorBatch]) -> list[Message]:
    messages = list(pipeline.start())
    for batch in from_:
        messages += pipeline.step(batch)
    return [*messages, *pipeline.finish()]


def pipeline(
    unit_id: str, tracker: str, boot_id: int = 7, sensor: SensorDescription = SENSOR
) -> TrackerPipeline:
    header_factory = HeaderFactory(unit_id, boot_id, ManualClock())
    weak = tracker == NO_TRACKER
    return TrackerPipeline(
        UnitIdentity("1", WALK, tracker, (FittedSensor(sensor),)),
        OneSensorTracker(NoTracker() if weak else make_tracker(tracker, sensor)),
        header_factory,
        5.0,
        raw_uplink=RawUplink(header_factory) if weak else None,
    )


class RadioBus:
    """The bus between the unit and its tracking agent."""

    def __init__(self) -> None:
        router = MemoryRouter()
        self._unit = router.attach_unit()
        self.clock = ManualClock()
        self.listener = RawStreamListener(U, router.attach_station, self.clock)
        assert self.listener.open(Event())

    def send(self, messages: Iterable[Message]) -> None:
        for message in messages:
            channel = channel_of(message)
            self._unit.publish(channel.key(U), encode(message), channel.qos)

    def keep(self, journal: Journal, messages: Iterable[Message]) -> None:
        """The unit has them in its journal, and answers for them."""
        journal.append(
            [JournalRow(one.header.seq, channel_of(one), 0, encode(one)) for one in messages]
        )
        server = JournalServer(U, journal)
        self._unit.serve(server.key_expression, server.replies)

    def track(self) -> list[Position]:
        """Positions of the agent for one ended run of the unit."""
        self.source = source = BusSource(U)
        assert source.follow(self.listener, Event())
        agent = pipeline(tracker_id(U), "eskf", boot_id=9, sensor=source.description)
        stated = run(agent, source.batches())
        return positions(stated)


def positions(messages: Iterable[Message]) -> list[Position]:
    return [message for message in messages if isinstance(message, Position)]


def contents(found: Iterable[Position]) -> list[tuple[object, ...]]:
    """All but who says it, to the last bit."""
    return [(p.header.t_mono_ns, *msgspec.structs.astuple(p)[1:]) for p in found]


@pytest.fixture
def radio() -> RadioBus:
    return RadioBus()


@pytest.fixture
def journal(tmp_path: Path) -> Iterator[Journal]:
    with closing(Journal(tmp_path / "journal.sqlite", lambda: 7, 0, 10**9)) as journal:
        yield journal


@cache
def weak_unit(one_by_one: bool = False, boot_id: int = 7) -> Sequence[Message]:
    return tuple(run(pipeline(U, NO_TRACKER, boot_id), batches(one_by_one)))


@cache
def strong_unit() -> Sequence[Message]:
    """It tracks itself."""
    return tuple(run(pipeline(U, "eskf"), batches()))


def end_of_run() -> Sequence[Message]:
    """The unit starts again, which ends the run before."""
    return weak_unit(boot_id=8)[:40]


def test_unit_sends_raw_batches_at_the_channels_rate_and_no_positions() -> None:
    stated = weak_unit(one_by_one=True)
    itself = strong_unit()
    raw = [message for message in stated if isinstance(message, RawImu)]
    assert not positions(stated)
    for kind in (Temperature, GpsFix, Status):
        count = sum(isinstance(message, kind) for message in itself)
        assert sum(isinstance(message, kind) for message in stated) == count
    duration_s = (raw[-1].t_ns[-1] - raw[0].t_ns[0]) / NS_PER_S
    assert len(raw) / duration_s == pytest.approx(IMU.rate_hz, rel=0.05)
    seqs = [message.header.seq for message in stated]
    assert seqs == list(range(1, len(stated) + 1))


@pytest.mark.parametrize("one_by_one", [False, True])
def test_positions_equal_those_of_tracking_on_the_unit(radio: RadioBus, one_by_one: bool) -> None:
    radio.send(weak_unit(one_by_one))
    radio.send(end_of_run())
    itself = positions(strong_unit())
    assert len(itself) > 50
    assert contents(radio.track()) == contents(itself)


def test_gap_in_the_raw_stream_is_flagged(radio: RadioBus) -> None:
    stated = weak_unit()
    raw = [message for message in stated if isinstance(message, RawImu)]
    lost = raw[200:240]
    radio.send(message for message in stated if not any(message is one for one in lost))
    radio.send(end_of_run())
    found = radio.track()
    doubted = [p for p in found if Reason.SAMPLE_GAP in p.reasons]
    assert doubted
    assert all(p.header.t_mono_ns >= lost[0].header.t_mono_ns - NS_PER_S for p in doubted)


@pytest.mark.parametrize("lost", [slice(50, 51), slice(100, 400)])
def test_lost_samples_are_fetched_from_the_journal(
    radio: RadioBus, journal: Journal, lost: slice
) -> None:
    stated = weak_unit()
    raw = [message for message in stated if isinstance(message, RawImu)]
    radio.keep(journal, stated)
    missed = {id(message) for message in raw[lost]}
    radio.send(message for message in stated if id(message) not in missed)
    radio.send(end_of_run())
    itself = positions(strong_unit())
    assert contents(radio.track()) == contents(itself)
    assert radio.source.fetched == len(missed)


def test_late_batch_that_was_already_fetched_is_dropped(radio: RadioBus, journal: Journal) -> None:
    stated = weak_unit()
    raw = [message for message in stated if isinstance(message, RawImu)]
    radio.keep(journal, stated)
    late = raw[100:110]
    for message in stated:
        if not any(message is one for one in late):
            radio.send((message,))
        if message is raw[130]:
            radio.send(late)
    radio.send(end_of_run())
    itself = positions(strong_unit())
    assert contents(radio.track()) == contents(itself)
    assert (radio.source.fetched, radio.source.late) == (10, 10)


def test_samples_missing_in_the_journal_stay_a_gap(radio: RadioBus, journal: Journal) -> None:
    stated = weak_unit()
    raw = [message for message in stated if isinstance(message, RawImu)]
    lost = raw[200:240]
    kept = [message for message in stated if not any(message is one for one in lost)]
    radio.keep(journal, kept)
    radio.send(kept)
    radio.send(end_of_run())
    assert any(Reason.SAMPLE_GAP in p.reasons for p in radio.track())
    assert radio.source.fetched == 0


def test_repeated_or_late_batch_is_dropped(radio: RadioBus) -> None:
    stated = weak_unit()
    raw = [message for message in stated if isinstance(message, RawImu)]
    for message in stated:
        radio.send((message,))
        if message is raw[50]:
            radio.send((raw[50], raw[20]))
    radio.send(end_of_run())
    itself = positions(strong_unit())
    assert contents(radio.track()) == contents(itself)


def test_restarted_unit_starts_a_new_complete_path(radio: RadioBus) -> None:
    second = weak_unit(boot_id=8)
    radio.send(weak_unit())
    radio.send(second[:40])
    first = radio.track()
    radio.send(second[40:])
    radio.send(weak_unit(boot_id=9)[:40])
    assert contents(radio.track()) == contents(first)


def test_late_message_of_the_previous_run_does_not_end_the_new_one(radio: RadioBus) -> None:
    first, second = weak_unit(), weak_unit(boot_id=8)
    late = [message for message in first if isinstance(message, RawImu)][-1:]
    radio.send(first[:-40])
    radio.send(second[:40])
    radio.send(late)
    radio.send(second[40:])
    radio.send(weak_unit(boot_id=9)[:40])
    radio.track()
    assert contents(radio.track()) == contents(positions(strong_unit()))


def test_newest_of_two_devices_is_tracked_and_then_the_remaining_one(
    radio: RadioBus,
) -> None:
    first, second = weak_unit(), weak_unit(boot_id=8)
    radio.send(first[:40])
    for one, other in zip(first[40:], second, strict=False):
        radio.send((other, one))
    radio.send(second[len(first) - 40 :])
    radio.track()
    left_out = radio.listener.dropped
    radio.clock.advance(4.9)
    radio.send(first[-40:])
    assert radio.listener.dropped > left_out
    left_out = radio.listener.dropped
    radio.clock.advance(0.1)
    radio.send(first[-40:])
    assert radio.listener.dropped == left_out
    assert contents(radio.track()) == contents(positions(strong_unit()))
    assert radio.listener.has_restarted(8)


def test_raw_samples_wait_for_the_description(radio: RadioBus) -> None:
    stated = weak_unit()
    radio.send(message for message in stated if isinstance(message, RawImu))
    stop = Event()
    stop.set()
    assert not BusSource(U).follow(radio.listener, stop)
    radio.send(stated[:2])
    radio.send(end_of_run())
    assert len(radio.track()) > 50


def test_run_without_description_does_not_delay_the_next_one(radio: RadioBus) -> None:
    undescribed = [message for message in weak_unit() if isinstance(message, RawImu)]
    radio.send(undescribed[:60])
    radio.send(weak_unit(boot_id=8))
    radio.send(weak_unit(boot_id=9)[:40])
    assert contents(radio.track()) == contents(positions(strong_unit()))
    assert radio.listener.dropped == 60
