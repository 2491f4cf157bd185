"""Actions of operators at a leader are confirmed once the standby has them."""

from __future__ import annotations

import tracemalloc
from collections.abc import Sequence
from concurrent.futures import Future

import pytest

from base_station.core.log_position import LogPosition
from base_station.engine.admission import Admission
from base_station.engine.ports import ActionResult, DeliveryResult
from base_station.standby.sync_ack import LeaderOnlyGate, ReplicaProgress
from shared.clock import ManualClock
from shared.errors import StoreError
from shared.messages.station import Action, CloseIncident


class Drive:
    """An ``EngineGate`` that does everything at once."""

    def submit(self, by: str, action: Action, action_id: str = "") -> Future[ActionResult]:
        done: Future[ActionResult] = Future()
        done.set_result(ActionResult("x", 1, None))
        return done

    def deliver(self, messages: Sequence[tuple[str, bytes]]) -> Future[DeliveryResult]:
        done: Future[DeliveryResult] = Future()
        done.set_result(DeliveryResult((Admission.ACCEPT,) * len(messages)))
        return done


class TestConfirming:
    @pytest.fixture
    def clock(self) -> ManualClock:
        return ManualClock()

    @pytest.fixture
    def copy(self, clock: ManualClock) -> ReplicaProgress:
        self.place = LogPosition(5, 1)
        return ReplicaProgress(clock, lambda: self.place, confirm_s=1.0)

    def act(self, copy: ReplicaProgress, refusal: str | None = None) -> Future[ActionResult]:
        return LeaderOnlyGate(Drive(), copy, lambda: refusal).submit("ada", CloseIncident("i"))

    def test_action_is_confirmed_at_once_without_a_standby(self, copy: ReplicaProgress) -> None:
        assert self.act(copy).done()

    def test_standby_that_stays_away_takes_bounded_memory_and_is_behind(
        self, copy: ReplicaProgress, clock: ManualClock
    ) -> None:
        copy.note(LogPosition(4, 1))
        tracemalloc.start()
        try:
            for number in range(5_000):
                clock.advance(0.2)
                self.place = LogPosition(6 + number, 1)
                copy.check()
            held_bytes, _ = tracemalloc.get_traced_memory()
        finally:
            tracemalloc.stop()
        assert held_bytes < 400_000
        copy.note(LogPosition(2_500, 1))  # it comes back, and has half of it
        assert copy.is_behind
        copy.note(self.place)
        copy.check()
        assert not copy.is_behind

    def test_action_waits_until_the_standby_has_it(self, copy: ReplicaProgress) -> None:
        copy.note(LogPosition(4, 1))
        reported = self.act(copy)
        assert not reported.done()
        copy.note(LogPosition(5, 1))
        assert reported.done()

    def test_each_confirmation_is_reported_once(self, copy: ReplicaProgress) -> None:
        copy.note(LogPosition(4, 1))
        first = self.act(copy)
        self.place = LogPosition(6, 1)
        second = self.act(copy)
        for place in (LogPosition(5, 1), LogPosition(5, 1), LogPosition(6, 1)):
            copy.note(place)
            copy.check()
            assert first.done()
        assert second.done()

    def test_replaced_standby_counts_with_its_own_progress(self, copy: ReplicaProgress) -> None:
        for _ in range(2):
            copy.note_report_received()
        copy.note(LogPosition(5, 1))
        assert copy.previous_report_is_durable()
        copy.note(LogPosition(1, 1))  # the new machine has only begun to fetch the log
        assert not copy.previous_report_is_durable()
        reported = self.act(copy)
        assert not reported.done()
        copy.note(LogPosition(5, 1))
        assert reported.done()
        assert copy.previous_report_is_durable()

    def test_stopping_station_releases_all_waiting_actions(self, copy: ReplicaProgress) -> None:
        copy.note(LogPosition(4, 1))
        reported = [self.act(copy) for _ in range(3)]
        assert not any(one.done() for one in reported)
        copy.close()
        assert all(one.done() for one in reported)
        copy.check()

    @pytest.mark.parametrize(
        ("has", "comes_after", "waits_s"),
        [(4, 5, 0.1), (4, 10**9, 2.0), (5, 10**9, 0.0), (None, 10**9, 0.0)],
        ids=["it comes", "it is slow", "it has all", "there is none"],
    )
    def test_stopping_station_hands_over_what_the_standby_lacks(
        self, copy: ReplicaProgress, clock: ManualClock, monkeypatch: pytest.MonkeyPatch,
        has: int | None, comes_after: int, waits_s: float,
    ) -> None:  # fmt: skip
        looks = 0

        def look_again(after_s: float) -> None:
            nonlocal looks
            looks += 1
            clock.advance(after_s)
            if looks == comes_after:
                copy.note(self.place)

        monkeypatch.setattr("base_station.standby.sync_ack.time.sleep", look_again)
        if has is not None:
            copy.note(LogPosition(has, 1))
        began_ns = clock.monotonic_ns()
        copy.drain()
        assert clock.monotonic_ns() - began_ns == pytest.approx(waits_s * 1e9, abs=3e7)

    def test_limited_wait_for_the_standby_is_reported(
        self, copy: ReplicaProgress, clock: ManualClock
    ) -> None:
        copy.note(LogPosition(4, 1))
        reported = self.act(copy)
        clock.advance(0.9)
        copy.check()
        assert not reported.done()
        clock.advance(0.2)
        copy.check()
        assert reported.done()
        clock.advance(2.0)
        copy.check()
        assert copy.is_behind

    def test_unfinished_hand_over_of_a_stopping_station_is_reported(
        self, copy: ReplicaProgress
    ) -> None:
        class Stopping(Drive):
            def submit(self, by: str, action: Action, action_id: str = "") -> Future[ActionResult]:
                done: Future[ActionResult] = Future()
                done.set_exception(StoreError("the station is stopping"))
                return done

        reported = LeaderOnlyGate(Stopping(), copy, lambda: None).submit("ada", CloseIncident("i"))
        with pytest.raises(StoreError, match="stopping"):
            reported.result(0.0)

    def test_actions_at_a_standby_are_refused(self, copy: ReplicaProgress) -> None:
        with pytest.raises(StoreError, match="this is the standby"):
            self.act(copy, "this is the standby").result(0.0)

    def test_messages_of_units_wait_for_the_standby_as_actions_do(
        self, copy: ReplicaProgress
    ) -> None:
        copy.note(LogPosition(4, 1))
        reported = LeaderOnlyGate(Drive(), copy, lambda: None).deliver([("key", b"samples")])
        assert not reported.done()
        copy.note(LogPosition(5, 1))
        assert reported.result(0.0).count(Admission.ACCEPT) == 1

    def test_units_may_delete_only_messages_that_both_stations_have(
        self, copy: ReplicaProgress
    ) -> None:
        copy.note_report_received()  # of the records up to 5
        copy.note(LogPosition(5, 1))
        assert not copy.previous_report_is_durable()
        self.place = LogPosition(6, 1)
        copy.note_report_received()
        assert copy.previous_report_is_durable()
        self.place = LogPosition(7, 1)
        copy.note_report_received()
        assert not copy.previous_report_is_durable()
        copy.note(LogPosition(6, 1))
        assert copy.previous_report_is_durable()
