"""Orders of erasures that were never reported as done."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

from base_station.storage.db.erasure import FORGOT_INCIDENT, FORGOT_PERSON
from base_station.storage.db.projecting import project_into
from base_station.storage.db.records import Records
from base_station.storage.db.store import Store
from base_station.storage.db.unfinished_erasures import UnfinishedErasures
from base_station.storage.projection import Projection
from shared.clock import SystemClock
from shared.messages import STATION_ID, Header, OperatorAction
from shared.messages.station import Action, BeginErasure, TakeOver

ORDER, TAKE_OVER = BeginErasure("person", "p1"), TakeOver(2, "second", 0, 0)
DONE = "person p1: 3 records of the log in 1 files"


class Audit:
    def __init__(self, store: Store) -> None:
        self.store = store
        self._number = 0

    def note(self, action: Action) -> None:
        """As from the log."""
        self._number += 1
        header = Header(STATION_ID, 1, self._number, self._number)
        done = OperatorAction(header, f"a{self._number}", "chief", action)
        with self.store.write() as session:
            project_into(session, [Projection(self._number, actions=(done,))])

    def report(self, action: str, detail: str) -> None:
        Records(self.store, SystemClock()).audit("chief", action, detail)

    def left(self) -> list[str]:
        return [one.subject for one in UnfinishedErasures(self.store).find()]


@pytest.fixture
def audit(tmp_path: Path) -> Iterator[Audit]:
    with Store(tmp_path / "station.sqlite") as store:
        yield Audit(store)


def test_order_of_a_former_leader_is_left_until_it_is_reported(audit: Audit) -> None:
    audit.note(ORDER)
    audit.note(TAKE_OVER)
    assert audit.left() == ["person p1"]
    audit.note(ORDER)  # again, by the one that leads now
    assert audit.left() == ["person p1"]
    audit.report(FORGOT_PERSON, DONE)
    assert audit.left() == []
    audit.note(TAKE_OVER)
    assert audit.left() == []


def test_order_of_the_station_that_leads_is_its_own(audit: Audit) -> None:
    audit.note(TAKE_OVER)
    audit.note(ORDER)
    assert audit.left() == []


def test_reported_erasure_that_is_ordered_again_is_left(audit: Audit) -> None:
    audit.note(BeginErasure("incident", "i1"))
    audit.report(FORGOT_INCIDENT, "incident i1: 5 records of the log in 1 files")
    audit.note(BeginErasure("incident", "i1"))
    audit.note(ORDER)
    audit.report(FORGOT_PERSON, DONE)
    audit.note(TAKE_OVER)
    assert audit.left() == ["incident i1"]


def test_station_that_was_one_of_a_pair_has_all_unfinished_ones(audit: Audit) -> None:
    def orphaned() -> list[str]:
        return [one.subject for one in UnfinishedErasures(audit.store).find_orphaned()]

    audit.note(BeginErasure("incident", "i1"))
    assert orphaned() == [], "the log was never that of a pair: the queue has it"
    audit.note(TAKE_OVER)
    audit.note(ORDER)  # by the station that is lost now
    assert orphaned() == ["incident i1", "person p1"]
    audit.report(FORGOT_PERSON, DONE)
    assert orphaned() == ["incident i1"]


def test_entries_that_come_between_two_looks_are_read(audit: Audit) -> None:
    unfinished = UnfinishedErasures(audit.store)
    audit.note(ORDER)
    assert unfinished.find() == ()
    audit.note(TAKE_OVER)
    (left,) = unfinished.find()
    assert (left.order_id, left.subject) == ("a1", "person p1")
    audit.report(FORGOT_PERSON, DONE)
    assert unfinished.find() == ()
