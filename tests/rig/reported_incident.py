"""An incident with some of everything that a report is about, as the records of a log."""

from __future__ import annotations

import math
from contextlib import closing
from pathlib import Path

import msgspec

from shared.channels import POSITION, backfilled_key
from shared.codec import encode
from shared.mcap_log import SegmentPolicy, SegmentWriter
from shared.messages import CommandKind, CommandState, EventKind
from shared.messages.station import (
    AcknowledgeAlarm,
    Assign,
    CheckIn,
    CloseIncident,
    ConfirmCommand,
    NoteDispatch,
    OpenIncident,
    ResolveAlarm,
    SendCommand,
    SetAnchor,
    SetPlan,
    SetStart,
    SetThresholds,
)
from tests.rig import message_factory
from tests.rig.station_script import Record, Script

HOSTILE = "<script>alert('Bea')</script>"
SILENT_FROM_S, SILENT_UNTIL_S = 100, 140  # of FF-02's radio
HOT_FROM_S, HOT_UNTIL_S, HOT_DEGC = 150, 200, 180.0
_STOREY_M = 3.0
_UNITS = ("FF-01", "FF-02", "FF-03")
_WALLS = (
    ("outline", 0, [[0, 0], [40, 0], [40, 25], [0, 25], [0, 0]]),
    ("wall", 0, [[0, 10], [16, 10]]),
    ("wall", 0, [[19, 10], [40, 10]]),
    ("wall", 1, [[20, 0], [20, 20]]),
    ("stairs", 0, [[36, 2], [39, 2], [39, 8], [36, 8], [36, 2]]),
)


def plan() -> bytes:
    """Two storeys of 40 m by 25 m."""
    site = {
        "frame": "site-m",
        "floors": [{"floor": 0, "down_m": 0.0}, {"floor": 1, "down_m": -_STOREY_M}],
    }
    features = [
        {
            "type": "Feature",
            "properties": {"kind": kind, "floor": floor},
            "geometry": {"type": "LineString", "coordinates": line},
        }
        for kind, floor, line in _WALLS
    ]
    return msgspec.json.encode({"type": "FeatureCollection", "muster": site, "features": features})


def incident_records(*, is_closed: bool = True) -> list[Record]:
    """Five minutes of three people, one of whom has a hostile name and one a silent radio."""
    script = Script()
    script.act(SetThresholds({"no-motion.alarm_s": 25.0}), "station")
    script.register(*_UNITS)
    script.act(Assign("FF-01", "p1", "Anna Vos", "red", "leader"))
    script.act(Assign("FF-02", "p2", HOSTILE, "red", ""))
    script.act(Assign("FF-03", "p3", "Carl Berg", "blue", ""))
    script.act(SetAnchor(52.0, 4.0, 0.0, 0.0))
    script.act(SetPlan(plan()))
    script.act(
        NoteDispatch("2026-7", "json", "Kitchen fire", units=("E12",), remarks="call {person p1}")
    )
    script.act(OpenIncident("i1", "Mill Lane 4", dispatch_number="2026-7"))
    for number, unit_id in enumerate(_UNITS):
        script.act(SetStart(unit_id, -2.0, 5.0 + 2.0 * number, 0.0, 0.0, 0.5, 0.05))
    for second in range(300):
        script.now_s += 1.0
        for number, unit_id in enumerate(_UNITS):
            _second(script, unit_id, number, second)
        _orders(script, second)
        script.tick()
    if is_closed:
        script.act(CloseIncident("i1"))
        script.wait(1.0)
    return script.records


def write_log(folder: Path, records: list[Record], segment_s: float = 60.0) -> None:
    """The log of a station in its folder, without a database."""
    with closing(SegmentWriter(folder / "log", SegmentPolicy(segment_s=segment_s))) as log:
        for record in records:
            log.write(*record)


def _second(script: Script, unit_id: str, number: int, second: int) -> None:
    walked_m = _walked_m(unit_id, second)
    east_m, north_m, down_m = _place(walked_m, number)
    if unit_id == "FF-02" and SILENT_FROM_S <= second < SILENT_UNTIL_S:
        _later(script, unit_id, (north_m, east_m, down_m, walked_m))
        return
    if unit_id == "FF-02" and second == SILENT_UNTIL_S:
        _bring_later(script)
    script.position(
        unit_id,
        north_m,
        east_m,
        down_m=down_m,
        distance_m=walked_m,
        pressure_pa=101_325.0 + 12.0 * down_m,
    )
    still_s = max(second - 220.0, 0.0) if unit_id == "FF-01" else 0.0
    script.status(unit_id, motionless_s=still_s)
    is_hot = unit_id == "FF-03" and HOT_FROM_S <= second < HOT_UNTIL_S
    script.temperature(unit_id, HOT_DEGC if is_hot else 24.0 + 0.01 * second)


_waiting: list[tuple[str, bytes]] = []


def _later(script: Script, unit_id: str, place: tuple[float, float, float, float]) -> None:
    """Kept in the unit's journal."""
    north_m, east_m, down_m, walked_m = place
    changes = {"north_m": north_m, "east_m": east_m, "down_m": down_m, "distance_m": walked_m}
    message = message_factory.position(script.header(unit_id), **changes)
    _waiting.append((backfilled_key(unit_id, POSITION.suffix), encode(message)))


def _bring_later(script: Script) -> None:
    for key, payload in _waiting:
        script.record(key, payload)
    _waiting.clear()


def _walked_m(unit_id: str, second: int) -> float:
    return 0.9 * (min(second, 220) if unit_id == "FF-01" else second)


def _place(walked_m: float, number: int) -> tuple[float, float, float]:
    """Round the building, then up the stairs: east, north and down of the own start."""
    east_m = min(walked_m, 36.0 - 2.0 * number)
    north_m = 6.0 * math.sin(walked_m / (9.0 + number)) if walked_m < 120 else 4.0 + number
    east_m -= max(min(walked_m - 80.0, 25.0), 0.0)
    down_m = -_STOREY_M * min(max((walked_m - 120.0) / 10.0, 0.0), 1.0)
    return east_m, north_m, down_m


def _orders(script: Script, second: int) -> None:
    match second:
        case 40:
            script.act(_command("c1", CommandKind.PAR_REQUEST, ""))
            for unit_id in _UNITS:
                script.command(unit_id, "c1")
        case 48:
            script.reply("FF-01", "c1", CommandState.ACKNOWLEDGED)
        case 55:
            script.act(ConfirmCommand("c1", "FF-03"))
        case 90:
            script.act(CheckIn("FF-02", "", False, "k1"))
        case 205:
            script.event("FF-03", EventKind.MAYDAY)
        case 210:
            (mayday,) = [one for one in script.alarms if one.rule == "mayday"]
            script.act(AcknowledgeAlarm(mayday.alarm_id))
        case 215:
            script.act(_command("c2", CommandKind.EVACUATE, "North exit"))
            for unit_id in _UNITS:
                script.command(unit_id, "c2")
        case 222:
            script.reply("FF-03", "c2", CommandState.ACKNOWLEDGED)
            script.reply("FF-02", "c2", CommandState.RECEIVED)
        case 230:
            kind = CommandKind.EVACUATE
            script.act(SendCommand("r2", kind, "FF-02", "", False, "", 0.0, 60.0, repeats="c2"))
            script.command("FF-02", "r2")
        case 235:
            script.reply("FF-02", "r2", CommandState.ACKNOWLEDGED)
        case 260:
            kind, ended = CommandKind.ALL_CLEAR, "c2"
            script.act(SendCommand("ac", kind, "", "", True, "", 0.0, 60.0, ended_command_id=ended))
            for unit_id in _UNITS:
                script.command(unit_id, "ac")
            script.reply("FF-03", "ac", CommandState.ACKNOWLEDGED)
        case 280:
            mayday = next(one for one in script.alarms if one.rule == "mayday")
            script.act(ResolveAlarm(mayday.alarm_id, "brought out", reason="found_and_helped"))
        case _:
            pass


def _command(command_id: str, kind: CommandKind, text: str) -> SendCommand:
    return SendCommand(command_id, kind, "", "", True, text, 0.0, 60.0)
