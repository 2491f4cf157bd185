"""A replay decides what the live station decided: every alarm and every position, one by one."""

from __future__ import annotations

import math
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
from shared.channels import OPERATOR, Qos, channel_of
from shared.codec import decode, encode
from shared.messages import (
    STATION_ID,
    AlarmChange,
    CommandKind,
    CommandState,
    EventKind,
    FusedPosition,
    OperatorAction,
)
from shared.messages.station import (
    AcknowledgeAlarm,
    Assign,
    CheckIn,
    CloseIncident,
    ConfirmCommand,
    DismissDispatch,
    NoteDispatch,
    OpenIncident,
    ResolveAlarm,
    SendCommand,
    SetAnchor,
    SetPlan,
    SetRest,
    SetStart,
    UndoConfirmation,
)
from shared.quality import Quality
from tests.rig import message_factory
from tests.rig.live_station import LiveStation, make_pipeline
from tests.rig.station_script import Record, Script
from tests.rig.waiting import until

PLAN = (
    b'{"type":"FeatureCollection","muster":{"frame":"site-m","floors":[{"floor":0,"down_m":0},'
    b'{"floor":1,"down_m":-3.2}]},"features":[{"type":"Feature","properties":{"kind":"outline",'
    b'"floor":0},"geometry":{"type":"Polygon","coordinates":[[[0,0],[40,0],[40,30],[0,30],'
    b"[0,0]]]}}]}"
)


def incident() -> Script:
    """Five minutes in which about everything happens."""
    script = Script()
    script.register("FF-01", "FF-02", "FF-03")
    script.act(SetAnchor(52.0, 4.0, 10.0, 0.3))
    script.act(SetPlan(PLAN))
    script.act(NoteDispatch("2024-7", "json", "Kitchen fire", address="Mill Lane", units=("E12",)))
    script.act(NoteDispatch("2024-8", "json", "Alarm"))
    script.act(DismissDispatch("2024-8"))
    script.act(OpenIncident("i1", "Mill Lane", 100.0, 120.0, dispatch_number="2024-7"))
    for number in (1, 2, 3):
        script.act(Assign(f"FF-0{number}", f"p{number}", f"Person {number}", "red", "firefighter"))
    script.act(SetStart("FF-01", 5.0, 5.0, 0.0, 0.4, 0.5, 0.2))
    for second in range(300):
        script.now_s += 1.0
        _second(script, second)
        script.tick()
    script.act(CloseIncident("i1"))
    return script


def _second(script: Script, second: int) -> None:
    angle = second / 20.0
    for number in (1, 2):
        unit_id = f"FF-0{number}"
        if number == 2 and 60 <= second < 120:
            continue  # no radio
        script.position(
            unit_id,
            20.0 * math.cos(angle) - 20.0,
            20.0 * math.sin(angle),
            down_m=-3.2 * min(1.0, second / 100.0),
            distance_m=1.0 * second,
            heading_rad=(angle + math.pi / 2.0) % (2.0 * math.pi),
            quality=Quality.DEGRADED if 150 < second < 180 else Quality.GOOD,
        )
        script.status(unit_id, motionless_s=float(max(0, second - 200)) if number == 1 else 0.0)
        script.temperature(unit_id, 20.0 + (second if number == 2 else 0.0))
        if number == 2 and second < 60:
            script.gps(unit_id, 52.0 + 18e-5 * math.cos(angle), 4.0 + 29e-5 * math.sin(angle))
    if second == 30:
        script.event("FF-03", EventKind.MAYDAY)
    if second == 40:
        script.act(AcknowledgeAlarm(script.alarms[0].alarm_id))
    _commands(script, second)
    if second in {120, 240}:
        script.act(CheckIn("", "red", False, f"k{second}"))
    if second == 245:  # one of them had not answered
        script.act(UndoConfirmation("k240", "FF-01"))
    if second == 20:
        script.act(NoteDispatch("2024-7", "json", "Structure fire", lat_deg=52.0, lon_deg=4.0))
    if second == 130:
        script.act(SetRest("FF-01", True))
    if second == 50:
        script.act(ResolveAlarm(script.alarms[0].alarm_id, "spoken to"))
    if second % 50 == 0:
        script.record("muster/v1/FF-01/up/position", b"\xff rubbish")
        script.position("stranger", 0.0, 0.0)


def _commands(script: Script, second: int) -> None:
    """An evacuation: one acknowledges, one does not hear it in time, for one the chief answers.
    One has an output, which runs for it and for the next order, and one has none.
    """
    if second == 65:
        for unit_id, outputs in (("FF-01", ("led",)), ("FF-03", ())):
            script.say(message_factory.description(script.header(unit_id), outputs=outputs))
    if second == 70:
        kind = CommandKind.EVACUATE
        script.act(SendCommand("c1", kind, "", "", True, "out", 0.0, lasts_s=60.0))
        script.command("FF-01", "c1")
    if second == 71:
        script.reply("FF-01", "c1", CommandState.RECEIVED)
    if second == 72:
        script.reply("FF-01", "c1", CommandState.NOTIFIED)
    if second == 75:
        script.reply("FF-01", "c1", CommandState.ACKNOWLEDGED)
    if second == 90:
        script.act(ConfirmCommand("c1", "FF-03"))
    _sent_again_and_ended(script, second)
    if second == 200:
        kind = CommandKind.LOCATE
        script.act(SendCommand("c2", kind, "", "", True, "", 0.0, lasts_s=60.0))
        script.reply("FF-01", "c2", CommandState.NOTIFIED)
        script.reply("FF-02", "c2", CommandState.RECEIVED)


def _sent_again_and_ended(script: Script, second: int) -> None:
    """The evacuation goes again to one, the all clear ends it, and one signal is stopped."""
    everyone = "", "", True, "", 0.0, 60.0
    if second == 110:
        script.act(SendCommand("r1", CommandKind.EVACUATE, *everyone, repeats="c1"))
    if second == 121:
        script.command("FF-02", "r1")
        script.reply("FF-02", "r1", CommandState.RECEIVED)
    if second == 126:
        script.act(SendCommand("ac", CommandKind.ALL_CLEAR, *everyone, ended_command_id="c1"))
        script.reply("FF-01", "ac", CommandState.ACKNOWLEDGED)
        script.reply("FF-02", "ac", CommandState.REFUSED, "this unit does not know it")
    if second == 210:
        script.act(SendCommand("s1", CommandKind.END_ORDER, *everyone, ended_command_id="c2"))


@pytest.fixture(scope="module")
def reported() -> Script:
    return incident()


def logged(script: Script) -> list[Record]:
    """The script's records as a live station would have logged them, decisions included."""
    pipeline = make_pipeline()
    again = Script(pipeline)
    records: list[Record] = []
    for t_ns, key, payload in script.records:
        again.now_s = (t_ns - script.records[0][0]) / 1e9
        records.append((t_ns, key, payload))
        for output in again.record(key, payload):
            if isinstance(output, AlarmChange | FusedPosition):
                decided = channel_of(output).key(STATION_ID)
                records.append((output.header.t_utc_ns, decided, encode(output)))
    return records


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
