"""Incident of five minutes with nearly every kind of message and action."""

from __future__ import annotations

import math

from shared.messages import (
    CommandKind,
    CommandState,
    EventKind,
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
from tests.rig.station_script import Script

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
