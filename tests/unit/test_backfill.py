"""The station fetches exactly what it lacks, once, and says what it has."""

from __future__ import annotations

import time
from collections.abc import Callable

import pytest

from base_station.backfill import Backfill, Held
from base_station.pace import LEAST_BYTES
from edge.journal_server import JournalServer
from edge.spool import Journaled, Spool
from shared.bus_memory import MemoryRouter
from shared.channels import POSITION, backfilled_key
from shared.clock import ManualClock
from shared.sequence_set import Run

BOOT = 77


class Bench:
    """A unit's journal of ten messages, and a station that backfills from it."""

    def __init__(self, folder, numbers):
        router = MemoryRouter()
        self.unit_bus = router.attach_unit()
        self.spool = Spool(folder / "journal.sqlite", lambda: BOOT, 0, 10**9)
        self.spool.append([Journaled(n, POSITION, n, b"%d" % n) for n in numbers])
        server = JournalServer("FF-01", self.spool)
        self.questions: list[str] = []

        def replies(key: str, parameters: str, payload: bytes):
            self.questions.append(parameters)
            return server.replies(key, parameters, payload)

        self.unit_bus.serve(server.key_expression, replies)
        self.delivered: list[tuple[str, bytes]] = []
        self.backfill = Backfill(
            router.attach_station(), lambda *record: self.delivered.append(record), ManualClock()
        )
        self.backfill.start()

    def report(self, *runs: Run) -> None:
        self.backfill.report({"FF-01": (Held(BOOT, runs),)})
        time.sleep(0.05)  # reports are coalesced; each is to be looked at

    @property
    def numbers(self) -> list[int]:
        assert all(key == backfilled_key("FF-01", "up/position") for key, _ in self.delivered)
        return [int(payload) for _, payload in self.delivered]


@pytest.fixture
def bench(tmp_path):
    bench = Bench(tmp_path, range(1, 11))
    yield bench
    bench.backfill.close()
    bench.spool.close()


def until(condition: Callable[[], bool]) -> None:
    deadline = time.monotonic() + 5.0
    while not condition():
        assert time.monotonic() < deadline, "it did not come about"
        time.sleep(0.01)


def test_what_is_missing_comes_in_order_and_once(bench):
    for _ in range(4):
        bench.report(Run(1, 2), Run(6, 7))
    until(lambda: len(bench.delivered) == 6)
    for _ in range(3):
        bench.report(Run(1, 2), Run(6, 7))
    assert bench.numbers == [3, 4, 5, 8, 9, 10]
    assert bench.backfill.fetched == 6


def test_what_is_only_under_way_is_not_asked_for(bench):
    bench.report(Run(1, 4), Run(6, 10))
    bench.report(Run(1, 10))
    bench.report(Run(1, 10))
    assert bench.delivered == []


def test_a_station_that_has_everything_says_so_to_the_unit(bench):
    for _ in range(3):
        bench.report(Run(1, 10))
    until(lambda: bench.spool.pending == 0)


def test_a_boot_that_the_station_never_heard_of_is_fetched(bench):
    for _ in range(3):
        bench.backfill.report({"FF-01": ()})
        time.sleep(0.05)
    until(lambda: bench.numbers == list(range(1, 11)))


def test_numbers_that_no_journal_has_are_counted_and_not_asked_for_again(tmp_path):
    bench = Bench(tmp_path, [1, 2, 5, 6])
    for _ in range(5):
        bench.report(Run(1, 2))
    until(lambda: bench.numbers == [5, 6])
    bench.report(Run(1, 2), Run(5, 6))
    bench.report(Run(1, 2), Run(5, 6))
    assert bench.backfill.gone == 2
    until(lambda: bench.spool.pending == 0)
    bench.backfill.close()
    bench.spool.close()


def test_a_unit_is_asked_for_little_first_and_for_more_when_it_answers_at_once(tmp_path):
    bench = Bench(tmp_path, range(1, 301))
    for _ in range(4):
        bench.report(Run(1, 1))
    until(lambda: len(bench.delivered) == 299)
    bench.backfill.close()
    bench.spool.close()
    asked = [dict(pair.split("=") for pair in one.split(";")) for one in bench.questions if one]
    totals = [int(one["total"]) for one in asked if "total" in one]
    assert totals == [LEAST_BYTES * 2**number for number in range(len(totals))]
    assert len(totals) > 1
    assert bench.numbers == list(range(2, 301))
