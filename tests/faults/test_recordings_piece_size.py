"""Pieces of a recording's pull: their size, and the cost of a failing link or bus."""

from __future__ import annotations

import random
from pathlib import Path

import pytest

from base_station.unit_sync.recordings.transfer import Transfer, TransferRequest, TransferState
from shared.clock import ManualClock
from tests.rig.changing_recordings import RecordingsUnit, pulled
from tests.rig.recorded_unit import U, finish


@pytest.mark.parametrize(("others_s", "link_s", "grows"), [(20.0, 0.0, True), (0.0, 20.0, False)])
def test_time_for_other_units_does_not_reduce_the_piece_size(
    tmp_path: Path, others_s: float, link_s: float, grows: bool
) -> None:
    """One that is out of reach may take seconds of every round."""
    unit, clock = RecordingsUnit(a=bytes(100_000)), ManualClock()
    unit.before = lambda _: clock.advance(link_s)
    fetch = Transfer(unit.ask, tmp_path, TransferRequest(U, 1, 2), clock)
    for _ in range(8):
        fetch.step()
        clock.advance(others_s)
    fetch.close()
    assert (unit.pieces[-1] > 10 * unit.pieces[0]) == grows


def test_piece_size_follows_a_thinner_link(tmp_path: Path) -> None:
    """Pieces too large for the link are not requested repeatedly."""
    content = random.Random(1).randbytes(300_000)
    unit, carried_bytes = RecordingsUnit(a=content), len(content)

    def ask(unit_id: str, question: str) -> bytes | None:
        answer = unit.ask(unit_id, question)
        return answer if len(answer) <= carried_bytes else None

    fetch = Transfer(ask, tmp_path, TransferRequest(U, 1, 2), ManualClock())
    for _ in range(8):
        fetch.step()
    assert unit.pieces[-1] > 10 * unit.pieces[0]
    carried_bytes = 2000
    came = fetch.done_bytes
    for _ in range(10):
        fetch.step()
    assert fetch.done_bytes > came
    carried_bytes = len(content)
    finish(fetch)
    assert pulled(tmp_path) == {"a.mcap": content}


def test_unit_with_short_answers_is_asked_with_pauses(tmp_path: Path) -> None:
    unit = RecordingsUnit(a=b"all of it")

    def lie(question: str) -> None:
        unit.files["boot/a.mcap"] = b"all of it" if question.startswith("index") else b"half"

    unit.before = lie
    fetch = unit.pull(tmp_path)
    states = []
    for _ in range(8):
        fetch.step()
        states.append(fetch.state)
    fetch.close()
    assert TransferState.WAITING in states[4:], "the desk rests then"
    assert not fetch.state.is_over


def test_failure_of_the_bus_does_not_end_the_transfer(tmp_path: Path) -> None:
    unit, failures = RecordingsUnit(a=b"all of it"), [RuntimeError("can't start new thread")]

    def fail_once(_: str) -> None:
        if failures:
            raise failures.pop()

    unit.before = fail_once
    fetch = unit.pull(tmp_path)
    fetch.step()
    fetch.step()
    assert (fetch.state, "does not answer" in fetch.problem) == (TransferState.WAITING, True)
    assert finish(fetch).state is TransferState.DONE
