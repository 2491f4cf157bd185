"""The live engine with the feed and the recorder: record, step, publish, survive."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path
from threading import Event

import pytest

from base_station.engine.engine import MANY_STEPPED, REBUILT_NS, StationEngine
from base_station.replay.playback import compare
from base_station.storage.recorder import Recorder
from shared.channels import EVENT, FUSED, OPERATOR, Qos, backfilled_key
from shared.clock import NS_PER_S, ManualClock
from shared.codec import encode
from shared.errors import StoreError
from shared.mcap_log import LogRecord, read_log
from shared.messages import (
    STATION_ID,
    AlarmState,
    EventKind,
    Header,
    OperatorAction,
    Position,
    UnitEvent,
)
from shared.messages.station import (
    AcknowledgeAlarm,
    Action,
    Assign,
    CloseIncident,
    OpenIncident,
    RegisterUnit,
    ResolveAlarm,
    SetPlan,
)
from tests.rig.live_station import LiveStation, Screen, make_pipeline, ports_of
from tests.rig.station_script import Script
from tests.rig.waiting import PATIENCE_S, until

MakePosition = Callable[..., Position]
U = "FF-01"


def mayday(seq: int) -> UnitEvent:
    return UnitEvent(Header(U, 0xB007, seq, 5), EventKind.MAYDAY)


def test_a_message_becomes_a_log_record_a_row_and_a_card(
    tmp_path: Path, make_position: MakePosition
) -> None:
    with LiveStation(tmp_path) as station:
        station.act(RegisterUnit(U, "one"))
        station.act(Assign(U, "p1", "Ada", "red", "leader"))
        station.publish(make_position(north_m=3.0))
        until(lambda: any(p.tracks for p in station.store.projections))
        until(lambda: any(u.position for d in station.screen.deltas for u in d.units))
        (unit,) = station.snapshot().units
        assert unit.person is not None
        assert (unit.person.name, unit.person.photo_url) == ("Ada", "/photos/p1")
        assert unit.position is not None
        assert unit.position.north_m == pytest.approx(3.0, abs=1e-3)
        assert unit.link == "live"
        keys = [key for _, key, _ in station.log.records()]
    assert "muster/v1/FF-01/up/position" in keys
    assert FUSED.key(STATION_ID) in keys


def test_failed_snapshot_request_is_answered_with_the_next_snapshot(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The hub asks once and waits: forgotten, no console would be shown anything again."""
    with LiveStation(tmp_path) as station:
        whole, tried = station.drive._publisher.snapshot, []

        def fail_once() -> object:
            tried.append(1)
            if len(tried) == 1:
                raise StoreError("the database is locked")
            return whole()

        monkeypatch.setattr(station.drive._publisher, "snapshot", fail_once)
        assert station.snapshot().units == ()
    assert len(tried) == 2


def test_message_received_live_during_backfill_is_logged_once(tmp_path: Path) -> None:
    with LiveStation(tmp_path) as station:
        station.act(RegisterUnit(U, "one"))
        station.publish(mayday(1))
        for seq in (1, 2, 2):
            station.feed.deliver(backfilled_key(U, EVENT.suffix), encode(mayday(seq)))
        station.publish(mayday(3))
        until(lambda: len(stated_keys(station)) == 3)
        assert stated_keys(station) == [
            EVENT.key(U),
            backfilled_key(U, EVENT.suffix),
            EVENT.key(U),
        ]


def stated_keys(station: LiveStation) -> list[str]:
    return [key for _, key, _ in station.log.records() if key.endswith(EVENT.suffix)]


def test_repeated_message_is_logged_once_and_counted_after_a_restart(
    tmp_path: Path,
) -> None:
    with LiveStation(tmp_path) as station:
        station.act(RegisterUnit(U, "one"))
        for seq in (1, 2, 2, 1, 1):
            station.publish(mayday(seq))
        until(lambda: repeated(station) == 3)
    with LiveStation(tmp_path) as station:
        for seq in (2, 1, 3):
            station.publish(mayday(seq))
        until(lambda: len(stated_keys(station)) == 3)
        until(lambda: repeated(station) == 2)
        assert stated_keys(station) == [EVENT.key(U)] * 3


def repeated(station: LiveStation) -> int:
    return station.snapshot().health.repeated


def test_deltas_are_numbered_and_a_snapshot_carries_the_last_number(
    tmp_path: Path, make_position: MakePosition
) -> None:
    with LiveStation(tmp_path) as station:
        station.act(RegisterUnit(U, "one"))
        for _ in range(20):
            station.publish(make_position())
        until(lambda: len(station.screen.deltas) > 3)
        seq = station.snapshot().seq
        reported = [delta.seq for delta in station.screen.deltas]
    assert reported[:seq] == list(range(1, seq + 1))


def test_new_incident_or_plan_sends_a_snapshot(tmp_path: Path) -> None:
    plan = b'{"type":"FeatureCollection","muster":{"frame":"site-m"},"features":[]}'
    with LiveStation(tmp_path) as station:
        station.act(OpenIncident("i1", "Mill Lane"))
        until(lambda: len(station.screen.resets) == 1)
        station.act(SetPlan(plan))
        until(lambda: len(station.screen.resets) == 2)
        refused = station.act(OpenIncident("i2", "Other"))
        assert refused.refused is not None
        assert "Mill Lane" in refused.refused.reason
        bad = station.act(SetPlan(b"{}"))
        assert bad.refused is not None
    last = station.screen.resets[-1]
    assert last.incident is not None
    assert last.incident.name == "Mill Lane"
    assert bytes(last.plan or b"") == plan


def test_forged_action_of_the_station_is_refused_and_an_alarm(tmp_path: Path) -> None:
    """A forged action on the bus has no effect, is not logged as one, and raises an alarm."""
    forged = OperatorAction(Header(STATION_ID, 1, 1, 0), "x", "mallory", CloseIncident("i1"))
    with LiveStation(tmp_path) as station:
        station.act(OpenIncident("i1", "Mill Lane"))
        station.bus.publish(OPERATOR.key(STATION_ID), encode(forged), Qos.LIVE)
        until(lambda: any(a.text for d in station.screen.deltas for a in d.alarms))
        assert station.pipeline.state.shown_incident is not None
        assert station.pipeline.state.shown_incident.closed_ns is None
        assert not any(payload == encode(forged) for _, _, payload in station.log.records())


def test_undecodable_bytes_are_kept_counted_and_shown(tmp_path: Path) -> None:
    with LiveStation(tmp_path) as station:
        station.bus.publish("muster/v1/FF-01/up/position", b"\xff\xffrubbish", Qos.LIVE)
        station.bus.publish("muster/v1/FF-01/up/nonsense", b"x", Qos.LIVE)
        until(lambda: station.snapshot().health.undecodable == 2)
        health = station.snapshot().health
        assert any("could not be read" in problem for problem in health.problems)
        assert {b"\xff\xffrubbish", b"x"} <= {p for _, _, p in station.log.records()}


def test_failing_store_is_an_alarm_and_tracking_continues(
    tmp_path: Path, make_position: MakePosition
) -> None:
    with LiveStation(tmp_path) as station:
        station.act(RegisterUnit(U, "one"))
        station.store.trouble = "The database does not answer"
        until(lambda: "store" in station.pipeline.state.problems)
        station.publish(make_position())
        until(lambda: station.snapshot().units[0].position is not None)
        assert [a.text for a in station.snapshot().alarms] == ["The database does not answer"]
        station.store.trouble = ""
        until(lambda: not station.pipeline.state.problems)


def test_live_state_is_restored_from_the_log_after_a_crash(
    tmp_path: Path, make_position: MakePosition
) -> None:
    first = LiveStation(tmp_path)
    first.drive.start()
    first.act(RegisterUnit(U, "one"))
    first.act(Assign(U, "p1", "Ada", "red", "leader"))
    first.publish(make_position(north_m=7.0))
    first.publish(mayday(1000))
    until(lambda: bool(first.pipeline.state.alarms))
    before = first.snapshot()
    first.drive._save_checkpoint = lambda: None  # type: ignore[method-assign]  # it was killed
    first.drive.stop()
    first.close()

    with LiveStation(tmp_path) as second:
        assert second.rebuilt > 0
        after = second.snapshot()
    assert [u.person for u in after.units] == [u.person for u in before.units]
    assert [u.position for u in after.units] == [u.position for u in before.units]
    assert [a.alarm_id for a in after.alarms] == [a.alarm_id for a in before.alarms]


def test_decisions_missing_in_the_log_after_a_crash_are_written(
    tmp_path: Path, make_position: MakePosition
) -> None:
    with LiveStation(tmp_path / "whole") as station:
        station.act(RegisterUnit(U, "one"))
        station.publish(make_position())
        station.publish(mayday(1000))
        until(lambda: bool(station.pipeline.state.alarms))
    records = list(station.log.records())
    *_, decided = (i for i, (_, key, _) in enumerate(records) if key.endswith("/alarm"))
    torn = LiveStation(tmp_path / "torn")
    for t_ns, key, payload in records[:decided]:
        torn.recorder.write(t_ns, key, payload)
    torn.drive.rebuild(torn.log.records())
    torn.recorder.flush()
    assert list(torn.log.records()) == records[: decided + 1]
    torn.close()


def test_normal_restart_needs_only_the_checkpoint(
    tmp_path: Path, make_position: MakePosition
) -> None:
    with LiveStation(tmp_path) as first:
        first.act(RegisterUnit(U, "one"))
        first.publish(make_position())
        until(lambda: first.pipeline.state.counts.messages == 1)
    with LiveStation(tmp_path) as second:
        assert second.rebuilt == 0
        assert second.snapshot().units[0].position is not None
        second.publish(make_position(north_m=2.0))
        until(lambda: second.pipeline.state.counts.messages == 2)
    assert list(compare(second.log.records(), make_pipeline())) == []


def test_action_after_the_shutdown_is_refused(tmp_path: Path) -> None:
    with LiveStation(tmp_path) as station:
        pass
    with pytest.raises(StoreError):
        station.drive.submit("chief", RegisterUnit(U, "one")).result(1.0)


class KilledInRebuild(Exception):  # noqa: N818  # it is no error
    """While the log is being read."""


def test_start_after_a_kill_during_a_long_rebuild_continues_from_a_checkpoint(
    tmp_path: Path,
) -> None:
    script = Script()
    script.register(U)
    for minute in range(30):
        script.now_s = 60.0 * minute
        script.position(U, float(minute), 0.0)
        script.tick()
    whole = LiveStation(tmp_path / "whole")
    stepped = whole.drive.rebuild(script.records)
    whole.close()

    read = script.records[: len(script.records) // 2]
    killed_ns = read[-1][0]

    def last_is_saved() -> bool:
        return (
            first.checkpoints.latest(killed_ns, killed_ns - REBUILT_NS - 60 * NS_PER_S) is not None
        )

    def until_killed() -> Iterator[tuple[int, str, bytes]]:
        yield from read
        until(last_is_saved, "the state of some minutes ago is saved")
        raise KilledInRebuild

    first = LiveStation(tmp_path / "killed")
    for record in script.records:
        first.recorder.write(*record)
    with pytest.raises(KilledInRebuild):
        first.drive.rebuild(until_killed())
    first.close()
    second = LiveStation(tmp_path / "killed")
    assert stepped // 4 < second.rebuilt < stepped * 3 // 4
    assert second.pipeline.checkpoint() == whole.pipeline.checkpoint()
    second.close()


def test_rebuild_of_many_events_is_done_once(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """However soon a station is killed after it has started."""
    monkeypatch.setattr("base_station.engine.engine.CHECKPOINT_NS", 3600 * NS_PER_S)
    script = Script()
    script.register(U)
    while len(script.records) < 2 * MANY_STEPPED:
        script.now_s += 0.01
        script.position(U, 0.0, 0.0)
    first = LiveStation(tmp_path)
    for record in script.records:
        first.recorder.write(*record)
    first.recorder.flush()
    first.close()
    with LiveStation(tmp_path) as second:
        assert second.rebuilt >= 2 * MANY_STEPPED
        until(lambda: second.checkpoints.latest() is not None, "the state is saved")


class MaydayFeed:
    """A ``Feed`` of two maydays.  Somebody deals with the first one while the other has come and
    waits to be taken.
    """

    follows = False

    def __init__(self, clock: ManualClock, dealt_with: Callable[[str], Action]) -> None:
        self._clock = clock
        self._dealt_with = dealt_with
        self._run_once = 0
        self.drive: StationEngine
        self.done = Event()

    def take(self, timeout_s: float) -> list[LogRecord]:
        self._run_once += 1
        self._clock.advance(0.010)
        if self._run_once == 1:
            self.drive.submit("chief", RegisterUnit(U, "one"))
        elif self._run_once == 2:
            pressed = self._pressed(1)
            self.drive.submit("chief", self._dealt_with(f"mayday:{U}:{pressed[0]}"))
            return [pressed]
        elif self._run_once == 3:
            t_ns, key, payload = self._pressed(2)
            return [(t_ns - 15_000_000, key, payload)]
        else:
            self.done.set()
            self._clock.advance(timeout_s)
        return []

    def _pressed(self, seq: int) -> LogRecord:
        t_ns = self._clock.utc_ns()
        pressed = UnitEvent(Header(U, 0xB007, seq, self._clock.monotonic_ns()), EventKind.MAYDAY)
        return t_ns, EVENT.key(U), encode(pressed)

    def wake(self) -> None:
        """It does not wait."""


@pytest.mark.parametrize("dealt_with", [AcknowledgeAlarm, lambda one: ResolveAlarm(one, "seen")])
def test_mayday_received_during_the_handling_of_another_is_raised(
    tmp_path: Path, dealt_with: Callable[[str], Action]
) -> None:
    clock = ManualClock(utc_ns=1_700_000_000 * NS_PER_S)
    feed, pipeline = MaydayFeed(clock, dealt_with), make_pipeline()
    recorder = Recorder(tmp_path, clock)
    feed.drive = StationEngine(pipeline, ports_of(feed, recorder, Screen(), tmp_path, clock))
    feed.drive.start()
    feed.done.wait(PATIENCE_S)
    feed.drive.stop()
    recorder.close()
    assert pipeline.state.alarms[f"mayday|{U}"].state is AlarmState.RAISED
    assert list(compare(read_log(recorder.folder), make_pipeline())) == []
