"""A log that two stations share: its places, records in memory, and the effect of a full disk."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

from base_station.core.log_position import START, LogPosition, events_after
from base_station.standby.shared_log import SharedLog
from base_station.storage.recorder import Recorder
from shared.channels import ALARM, OPERATOR
from shared.clock import NS_PER_S, ManualClock, SystemClock
from shared.codec import encode
from shared.messages import STATION_ID, Header, OperatorAction
from shared.messages.station import ForgetWearers, TakeOver
from tests.rig.standby_logs import T0, FullDisk, disk, events, written


@pytest.fixture
def recorder(tmp_path: Path) -> Iterator[Recorder]:
    recorder = Recorder(tmp_path, SystemClock())
    yield recorder
    recorder.close()


@pytest.fixture
def log(recorder: Recorder) -> SharedLog:
    return SharedLog(recorder, SystemClock())


def test_place_counts_events_and_not_decisions(recorder: Recorder, log: SharedLog) -> None:
    written(recorder, log, events(6))
    assert log.place == LogPosition(T0 + 4, 2)
    log.write(T0 + 9, ALARM.key(STATION_ID), b"decided")
    assert log.place == LogPosition(T0 + 4, 2)


def test_records_behind_any_place_are_the_same_from_memory_and_disk(
    recorder: Recorder, log: SharedLog
) -> None:
    records = events(20)
    written(recorder, log, records)
    place = START
    for done in range(len(records) + 1):
        assert log.behind(place, 10**6) == records[done:]
        assert list(events_after(place, disk(recorder).records(place.t_ns))) == records[done:]
        if done < len(records):
            place = place.next(records[done][0])


def test_records_no_longer_in_memory_are_reported_as_on_the_disk_only(
    recorder: Recorder, log: SharedLog
) -> None:
    written(recorder, log, events(3))
    later = SharedLog(recorder, SystemClock())
    later.begin(log.place, T0, ())
    assert later.behind(START, 10**6) is None
    assert later.behind(log.place, 10**6) == []


def test_erased_person_leaves_nothing_in_memory(recorder: Recorder, log: SharedLog) -> None:
    written(recorder, log, events(3))
    forget = OperatorAction(Header(STATION_ID, 1, 1, 5), "x", "ada", ForgetWearers("u"))
    log.write(T0 + 9, OPERATOR.key(STATION_ID), encode(forget))
    assert log.behind(LogPosition(T0, 1), 10**6) is None
    assert log.behind(log.place, 10**6) == []


def test_newest_records_of_a_long_log_stay_in_memory_and_the_rest_is_on_the_disk(
    recorder: Recorder, log: SharedLog, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("base_station.standby.shared_log._RECENT_BYTES", 300)
    records = [(t_ns, key, bytes(size)) for size, (t_ns, key, _) in enumerate(events(60))]
    written(recorder, log, records)
    place, at_hand = START, []
    for done in range(len(records) + 1):
        found = log.behind(place, 10**6)
        assert found in (None, records[done:])
        at_hand.append(found is not None)
        if done < len(records):
            place = place.next(records[done][0])
    assert at_hand == sorted(at_hand)
    kept_bytes = sum(len(payload) for _, _, payload in records[at_hand.index(True) :])
    assert 240 < kept_bytes <= 600  # between the rest and the record that displaces it


def test_answer_has_at_most_the_requested_size_but_never_nothing(
    recorder: Recorder, log: SharedLog
) -> None:
    records = events(10)  # of seven bytes each
    written(recorder, log, records)
    given = [len(log.behind(START, most) or []) for most in (0, 1, 7, 8, 14, 15)]
    assert given == [1, 1, 1, 2, 2, 3]


def test_term_is_that_of_the_last_take_over_also_one_that_came_later(
    recorder: Recorder, log: SharedLog
) -> None:
    assert (log.term, log.take_overs) == (0, ())
    log.begin(START, T0, [TakeOver(3, "a", T0, 1)])
    assert log.term == 3
    action = OperatorAction(Header(STATION_ID, 1, 1, 5), "x", "b", TakeOver(4, "b", T0, 2))
    log.write(T0 + 9, OPERATOR.key(STATION_ID), encode(action))
    log.write(T0 + 9, OPERATOR.key(STATION_ID), b"\xff nobody can read this")
    assert log.term == 4
    assert [one.term for one in log.take_overs] == [3, 4]
    assert recorder.flush()


def test_following_log_ends_where_the_disk_refused_and_has_no_gap() -> None:
    disk, clock = FullDisk(), ManualClock()
    log = SharedLog(disk, clock)
    log.follows = True
    disk.room = 3
    kept = []
    for number, (t_ns, key, payload) in enumerate(events(9)):
        if number == 6:
            disk.room = 100
        kept.append(log.write(t_ns, key, payload))
    assert kept == [True] * 3 + [False] * 6
    assert (log.problem, log.low_disk_space) == (disk.problem, disk.low_disk_space)
    assert log.is_cut_short
    assert disk.kept == events(9)[:3]
    assert log.behind(START, 10**6) == events(9)[:3]


def test_leading_log_continues_behind_refused_records_and_ships_what_it_has() -> None:
    disk, clock = FullDisk(), ManualClock()
    log = SharedLog(disk, clock)
    disk.room, reported = 3, events(9)
    for t_ns, key, payload in reported[:6]:
        clock.advance(1.0)
        log.write(t_ns, key, payload)
    assert clock.monotonic_ns() - log.written_ns == 3 * NS_PER_S  # silent like one that hangs
    disk.room = 100
    for record in reported[6:]:
        log.write(*record)
    assert not log.is_cut_short
    assert log.behind(START, 10**6) == disk.kept == [*reported[:3], *reported[6:]]
