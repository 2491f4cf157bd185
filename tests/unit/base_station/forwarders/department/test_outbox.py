"""The outbox of a station's events: numbers without gaps, kept until they are acknowledged."""

from __future__ import annotations

from pathlib import Path

import pytest

from base_station.forwarders.department.outbox import DepartmentOutbox, NewEvent
from shared.errors import StoreError


def event(name: str, subject: str = "s", body: bytes = b"body") -> NewEvent:
    return NewEvent(name, subject, 1000, body)


def numbers(outbox: DepartmentOutbox) -> list[tuple[int, str]]:
    return [(one.seq, one.event_id) for one in outbox.next_batch(100, 100_000)]


def test_events_are_numbered_without_gaps_and_stay_until_acknowledged(tmp_path: Path) -> None:
    outbox = DepartmentOutbox(tmp_path / "outbox.sqlite")
    outbox.add([event("a"), event("b")], {"x": b"1"}, 5)
    outbox.add([event("b"), event("c")], {"x": b"2", "y": b"3"}, None)
    assert numbers(outbox) == [(1, "a"), (2, "b"), (3, "c")]
    outbox.acknowledge(2)
    epoch = outbox.epoch
    outbox.close()

    opened_again = DepartmentOutbox(tmp_path / "outbox.sqlite")
    assert numbers(opened_again) == [(3, "c")]
    assert (opened_again.epoch, opened_again.acknowledged_seq) == (epoch, 2)
    assert opened_again.reported() == {"x": b"2", "y": b"3"}
    assert opened_again.collected_ns == 5
    opened_again.acknowledge(3)
    opened_again.add([event("d")], {"y": None}, None)
    assert numbers(opened_again) == [(4, "d")]  # a number is never used again
    assert opened_again.reported() == {"x": b"2"}
    opened_again.close()


def test_batch_is_bounded_and_never_empty_while_events_wait(tmp_path: Path) -> None:
    outbox = DepartmentOutbox(tmp_path / "outbox.sqlite")
    outbox.add([event(str(n), body=bytes(1000)) for n in range(10)], {}, None)
    assert len(outbox.next_batch(100, 3500)) == 3
    assert len(outbox.next_batch(2, 100_000)) == 2
    assert len(outbox.next_batch(100, 10)) == 1


def test_events_dropped_by_a_standby_are_not_reported_as_lost(tmp_path: Path) -> None:
    outbox = DepartmentOutbox(tmp_path / "outbox.sqlite")
    outbox.add([event(str(n)) for n in range(10)], {}, None)
    outbox.keep_newest(3)
    assert [seq for seq, _ in numbers(outbox)] == [8, 9, 10]
    outbox.keep_newest(3)
    assert (outbox.dropped_seq, outbox.acknowledged_seq) == (7, 0)


def test_rewritten_event_leaves_nothing_of_the_former(tmp_path: Path) -> None:
    path = tmp_path / "outbox.sqlite"
    outbox = DepartmentOutbox(path)
    outbox.add([event("a", "person/1", b"Anna Berg"), event("b")], {}, None)
    outbox.rewrite("person/1", b"nobody")
    assert [one.body for one in outbox.next_batch(9, 9999)] == [b"nobody", b"body"]
    outbox.close()
    assert b"Anna Berg" not in path.read_bytes()


def test_damaged_file_is_set_aside_and_another_epoch_begins(tmp_path: Path) -> None:
    path = tmp_path / "outbox.sqlite"
    outbox = DepartmentOutbox(path)
    outbox.add([event("a")], {}, None)
    epoch = outbox.epoch
    outbox.close()
    path.write_bytes(b"this is no database" * 1000)
    anew = DepartmentOutbox(path)
    assert numbers(anew) == []
    assert anew.epoch != epoch
    assert path.with_name("outbox.sqlite.damaged").exists()


def test_missing_folder_is_reported_and_retried(tmp_path: Path) -> None:
    outbox = DepartmentOutbox(tmp_path / "later" / "outbox.sqlite")
    with pytest.raises(StoreError, match=r"outbox\.sqlite cannot be used"):
        outbox.add([event("a")], {}, None)
    (tmp_path / "later").mkdir()
    outbox.add([event("a")], {}, None)
    assert numbers(outbox) == [(1, "a")]
