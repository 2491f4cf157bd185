"""Posted samples that a tracking agent can fetch."""

from __future__ import annotations

import pytest

from base_station.engine.recent_samples import RecentSamples
from shared.messages import JournalChunk


def chunk(recent: RecentSamples, parameters: str) -> JournalChunk | None:
    replies = [JournalChunk.from_bytes(one) for one in recent.replies("key", parameters, b"")]
    return replies[0] if replies else None


@pytest.fixture
def recent() -> RecentSamples:
    recent = RecentSamples()
    for seq in range(1, 11):
        recent.add(7, seq, b"x" * 1000)
    recent.add(8, 1, b"of another run")
    return recent


def test_requested_samples_are_returned_and_missing_ones_accounted_for(
    recent: RecentSamples,
) -> None:
    recent.add(7, 14, b"later")
    found = chunk(recent, "epoch=7;from=9;to=13")
    assert found is not None
    assert found.raw_only
    assert (found.from_seq, found.to_seq) == (9, 13)
    assert [entry.seq for entry in found.entries] == [9, 10]
    other = chunk(recent, "epoch=8;from=1;to=1")
    assert other is not None
    assert [entry.payload for entry in other.entries] == [b"of another run"]


def test_long_answer_is_given_in_parts(recent: RecentSamples) -> None:
    found = chunk(recent, "epoch=7;from=1;to=10;total=2500")
    assert found is not None
    assert (found.to_seq, len(found.entries)) == (3, 3)


@pytest.mark.parametrize("parameters", ["", "epoch=9;from=1;to=2", "epoch=7;from=x;to=2", "a=b"])
def test_invalid_request_is_not_answered(recent: RecentSamples, parameters: str) -> None:
    assert chunk(recent, parameters) is None


def test_oldest_samples_are_dropped(recent: RecentSamples) -> None:
    for seq in range(11, 40):
        recent.add(7, seq, bytes(100_000))
    found = chunk(recent, "epoch=7;from=1;to=39")
    assert found is not None
    assert 10 < found.entries[0].seq <= 30
