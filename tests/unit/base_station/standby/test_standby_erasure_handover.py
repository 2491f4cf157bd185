"""Erasures that another station has not finished are taken over by the one that leads."""

from __future__ import annotations

from pathlib import Path
from threading import Event

import pytest

from base_station.standby.erasure_handover import ErasureHandover, ErasureServer
from base_station.standby.leader_requests import LeaderRequests, WaitingErasure
from base_station.standby.rpc import RpcServer
from base_station.storage.db.unfinished_erasures import UnfinishedErasure
from shared.bus_memory import MemoryRouter
from shared.errors import MusterError, StoreError

ANA, FIRE = WaitingErasure("r1", "person", "ana"), WaitingErasure("r2", "incident", "i1")
STOP = Event()


class Pair:
    """The first leads, and the second has erasures that wait."""

    def __init__(self, kept: Path) -> None:
        self.leads = True
        self.other: str | None = "second"
        self.waiting = [ANA, FIRE]
        self.unfinished: list[UnfinishedErasure] = []
        self.taken: list[str] = []
        self.failures = 0
        self.router = MemoryRouter()
        self.bus = self.router.attach_station()
        self.kept = kept
        self.start()

    def start(self) -> None:
        """The first station, also again."""
        self.handover = ErasureHandover(
            self.bus,
            lambda: self.leads,
            lambda: self.other,
            lambda: self.unfinished,
            LeaderRequests(self.kept),
            self.take,
        )

    def serve(self) -> ErasureServer:
        station = self.router.attach_station()
        return ErasureServer("second", station, lambda: not self.leads, lambda: self.waiting)

    def take(self, subject: str) -> None:
        if self.failures:
            self.failures -= 1
            raise StoreError("the disk is full")
        self.taken.append(subject)

    def run_round(self) -> list[str]:
        self.handover.run_round(STOP)
        return self.taken


@pytest.fixture
def pair(tmp_path: Path) -> Pair:
    return Pair(tmp_path / "kept.json")


def test_waiting_erasures_of_the_other_are_taken_once(pair: Pair) -> None:
    pair.serve()
    assert pair.run_round() == ["person ana", "incident i1"]
    pair.waiting.append(WaitingErasure("r3", "person", "ana"))  # requested again later
    assert pair.run_round() == ["person ana", "incident i1", "person ana"]


def test_station_that_follows_takes_none(pair: Pair) -> None:
    pair.serve()
    pair.leads = False
    pair.unfinished = [UnfinishedErasure("o1", "person bo")]
    assert pair.run_round() == []


def test_request_that_a_lost_leader_has_not_ordered_is_taken(pair: Pair) -> None:
    leader = pair.serve()
    pair.leads = False
    assert pair.run_round() == []
    leader.close()
    assert pair.run_round() == [], "a leader that does not answer may still have them"
    pair.start()  # the machine was off meanwhile
    pair.leads, pair.other = True, None
    pair.failures = 1
    with pytest.raises(StoreError):
        pair.run_round()
    assert pair.run_round() == ["person ana", "incident i1"]
    pair.start()
    assert pair.run_round() == ["person ana", "incident i1"], "once"


def test_request_that_the_leader_has_done_is_not_taken(pair: Pair) -> None:
    pair.serve()
    pair.leads = False
    pair.run_round()
    pair.waiting.clear()
    pair.run_round()
    pair.leads, pair.other = True, None
    assert pair.run_round() == []


def test_copy_of_the_requests_that_is_damaged_is_empty(pair: Pair) -> None:
    pair.kept.write_text("rubbish")
    pair.start()
    pair.other = None
    assert pair.run_round() == []


def test_erasure_that_could_not_be_noted_is_taken_again(pair: Pair) -> None:
    pair.serve()
    pair.failures = 1
    with pytest.raises(StoreError):
        pair.run_round()
    assert pair.run_round() == ["person ana", "incident i1"]


def test_order_of_a_lost_leader_is_taken_without_the_other_station(pair: Pair) -> None:
    pair.other = None
    pair.unfinished = [UnfinishedErasure("o1", "person bo")]
    assert pair.run_round() == ["person bo"]
    assert pair.run_round() == ["person bo"]


def test_station_that_does_not_answer_has_none_to_take(pair: Pair) -> None:
    assert pair.run_round() == []


def test_answer_that_makes_no_sense_is_refused(pair: Pair) -> None:
    RpcServer("second", pair.router.attach_station(), {"erasures": lambda *_: iter([b"\xc1"])})
    with pytest.raises(MusterError):
        pair.run_round()
    assert pair.taken == []


def test_server_that_is_closed_answers_no_more(pair: Pair) -> None:
    pair.serve().close()
    assert pair.run_round() == []
