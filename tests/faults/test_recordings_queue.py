"""Queue of pulls of recordings: in turn, over restarts, until they are complete or stopped."""

from __future__ import annotations

from pathlib import Path

import pytest

from base_station.unit_sync.recordings.transfer import Ask, TransferRequest, TransferState
from base_station.unit_sync.recordings.transfer_queue import TransferQueue
from shared.clock import SystemClock
from shared.errors import UserError
from tests.rig.recorded_unit import RecordedUnit, U
from tests.rig.waiting import until


def desk(ask: Ask, folder: Path) -> TransferQueue:
    return TransferQueue(ask, folder, SystemClock())


def test_restarted_station_continues_its_transfers(unit: RecordedUnit, tmp_path: Path) -> None:
    unit.linked = False
    with desk(unit.ask, tmp_path) as first:
        first.add("chief", unit.window())
        until(lambda: "does not answer" in first.transfers()[0].problem)
    unit.linked = True
    with desk(unit.ask, tmp_path) as second:
        until(lambda: second.transfers()[0].state is TransferState.DONE)
        (view,) = second.views()
    assert view.unit_id == U
    assert view.done_bytes == view.total_bytes > 0
    assert second.transfers()[0].by == "chief"


def test_absent_unit_delays_no_other_transfer(unit: RecordedUnit, tmp_path: Path) -> None:
    away = TransferRequest("FF-02", 1, 2)
    with desk(unit.ask, tmp_path) as both:
        both.add("chief", away)
        both.add("chief", unit.window(0.0, 600.0))
        until(lambda: both.transfers()[1].state is TransferState.DONE)
        assert both.transfers()[0].state is TransferState.WAITING


def test_stopped_transfer_can_be_requested_again(unit: RecordedUnit, tmp_path: Path) -> None:
    unit.linked = False
    with desk(unit.ask, tmp_path) as one:
        pull = one.add("chief", unit.window())
        with pytest.raises(UserError, match="already"):
            one.add("chief", unit.window())
        assert one.stop(pull.fetch_id)
        assert not one.stop(pull.fetch_id)
        unit.linked = True
        one.add("chief", unit.window())
        until(lambda: one.transfers()[-1].state is TransferState.DONE)
    assert one.transfers()[0].problem == "stopped by a person"


def test_a_window_that_ends_before_it_begins_is_refused(unit: RecordedUnit, tmp_path: Path) -> None:
    with desk(unit.ask, tmp_path) as one, pytest.raises(UserError, match="before it begins"):
        one.add("chief", TransferRequest(U, 2, 1))
