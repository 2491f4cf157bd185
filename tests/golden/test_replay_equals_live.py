"""A replay decides what the live station decided: every alarm and every position, one by one."""

from __future__ import annotations

from pathlib import Path

import pytest

from base_station.core.alarms import ALARMS
from base_station.core.checkpoint import read_checkpoint
from base_station.core.events import is_decision
from base_station.core.pipeline import StationPipeline
from base_station.fusion import FUSERS
from base_station.replay.playback import Playback, compare
from base_station.storage.db.known_people import person_lookup
from base_station.views.station import command_view
from shared.channels import OPERATOR, Qos
from shared.codec import decode
from shared.messages import (
    AlarmChange,
    OperatorAction,
)
from tests.rig.eventful_incident import incident
from tests.rig.live_station import LiveStation, make_pipeline
from tests.rig.logged_script import logged
from tests.rig.station_script import Script
from tests.rig.waiting import until


@pytest.fixture(scope="module")
def reported() -> Script:
    return incident()


def test_scripted_incident_covers_the_alarm_rules(reported: Script) -> None:
    rules = {alarm.rule for alarm in reported.alarms}
    assert rules >= {
        "mayday", "no-motion", "heat", "link-lost", "tracker-degraded", "unknown-unit",
        "missed-check-in", "rest-due",
    }  # fmt: skip
    assert len(reported.fused) > 500
    assert {fused.floor for fused in reported.fused} == {0, 1}
    assert any(fused.since_gps_s is not None for fused in reported.fused)
    command = reported.pipeline.state.commands["c1"]
    assert {one.unit_id: command.state_of(one) for one in command.deliveries.values()} == {
        "FF-01": "acknowledged", "FF-02": "expired", "FF-03": "acknowledged"
    }  # fmt: skip
    assert command.deliveries["FF-01"].notified_ns is not None
    assert [one.can_be_notified for one in command.deliveries.values()] == [True, None, False]
    assert (command.repeat_ids, command.ended_ns is not None) == (["r1"], True)
    all_clear = reported.pipeline.state.commands["ac"]
    assert [all_clear.state_of(one) for one in all_clear.deliveries.values()] == [
        "acknowledged", "refused", "expired"
    ]  # fmt: skip
    locate = reported.pipeline.state.commands["c2"]
    assert {one.unit_id: locate.state_of(one) for one in locate.deliveries.values()} == {
        "FF-01": "notified", "FF-02": "received", "FF-03": "expired"
    }  # fmt: skip


def test_replay_shows_the_command_states_of_the_live_run(reported: Script) -> None:
    again = Script(make_pipeline())
    for t_ns, key, payload in reported.records:
        again.now_s = (t_ns - reported.records[0][0]) / 1e9
        again.record(key, payload)
    live, replayed = (
        [
            command_view(command, person_lookup({}))
            for command in script.pipeline.state.commands.values()
        ]
        for script in (reported, again)
    )
    assert [view.command_id for view in live] == ["c1", "ac", "c2"]
    assert replayed == live


def test_replay_of_the_log_makes_the_same_decisions(reported: Script) -> None:
    records = logged(reported)
    assert any(is_decision(key) for _, key, _ in records)
    assert list(compare(records, make_pipeline())) == []


def test_changed_rule_is_detected_by_the_replay(reported: Script) -> None:
    fewer = StationPipeline(ALARMS[1:], FUSERS[0])
    differences = list(compare(logged(reported), fewer))
    assert differences
    assert any(isinstance(d.logged, AlarmChange) and d.logged.rule == "mayday" for d in differences)


@pytest.mark.parametrize("part", [0.1, 0.37, 0.8])
def test_checkpoint_continues_with_the_same_decisions(reported: Script, part: float) -> None:
    cut = round(len(reported.records) * part)
    straight, first = Script(make_pipeline()), Script(make_pipeline())
    for t_ns, key, payload in reported.records[:cut]:
        for script in (straight, first):
            script.now_s = (t_ns - reported.records[0][0]) / 1e9
            script.record(key, payload)
    saved = read_checkpoint(first.pipeline.checkpoint())
    assert saved is not None
    second = Script(make_pipeline(saved))
    straight.outputs.clear()
    for t_ns, key, payload in reported.records[cut:]:
        for script in (straight, second):
            script.now_s = (t_ns - reported.records[0][0]) / 1e9
            script.record(key, payload)
    assert len(second.outputs) > 100
    assert second.outputs == straight.outputs
    assert second.pipeline.checkpoint() == straight.pipeline.checkpoint()


def test_live_run_through_bus_threads_and_log_replays_identically(
    tmp_path: Path, reported: Script
) -> None:
    """The real drive on the real clock: whatever time it was, the log tells it again."""
    actions = [r for r in reported.records if r[1].endswith("/operator")]
    messages = [r for r in reported.records if "/up/" in r[1] or "/alert/" in r[1]][:1500]
    with LiveStation(tmp_path) as station:
        for _, _, payload in actions[:8]:
            action = decode(OPERATOR, payload)
            assert isinstance(action, OperatorAction)
            station.act(action.action, action.by)
        for _, key, payload in messages:
            station.bus.publish(key, payload, Qos.LIVE)
        until(lambda: station.pipeline.state.counts.messages > 900)
        live = station.snapshot()
        at_ns = station.pipeline.state.t_ns
    records = list(station.log.records())
    assert sum(is_decision(key) for _, key, _ in records) > 300
    assert list(compare(records, make_pipeline())) == []

    archive = station.archive()
    playback = Playback(archive)
    for _ in playback.seek(at_ns):
        pass
    assert playback.pipeline.state.units.keys() == {unit.unit_id for unit in live.units}
