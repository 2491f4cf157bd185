"""Pictures that a commander may meet: quiet, a bad minute, forty people, long names, the past."""

from __future__ import annotations

import math
from collections.abc import Collection
from pathlib import Path
from typing import Any

import msgspec

from base_station.views import wire

NOW_MS = 1_795_255_608_000
MINUTE_MS = 60_000
PLAN = Path(__file__).resolve().parents[2] / "edge" / "simulation" / "building.geojson"
NAMES = (
    "Astrid Lindqvist",
    "Jonas Bergman",
    "Mira Okafor",
    "Tomas Novak",
    "Elena Rossi",
    "Bartholomew Featherstonehaugh-Cholmondeley",
    "Wolfeschlegelsteinhausenbergerdorff",
    "Li Na",
)
ROLE = "Search"
CREWS = ("Engine 1", "Engine 2", "Rescue 3", "Hazardous Materials Response Team 12", "Ladder 4")
HEALTH = wire.HealthView((), 120_431, 0, 0, 81_000_000, 40_000_000_000, 210.0, insecure=False)
INCIDENT = wire.IncidentView(
    "20261121-1", "Mill Road 7, flats", NOW_MS - 52 * MINUTE_MS, None, 1200.0, 300.0, 2400.0
)

_WARNINGS = ("warning", "temperature: the unit has no sensor; output: the unit has none")


def unit_id(index: int) -> str:
    return f"FF-{index + 1:02}"


def person(index: int) -> wire.PersonView:
    name = NAMES[index % len(NAMES)]
    if index >= len(NAMES):
        name = f"{name} {index // len(NAMES) + 1}"
    return wire.PersonView(f"p{index}", name, CREWS[index % len(CREWS)], ROLE, None)


def position(index: int, age_ms: int = 400) -> wire.PositionView:
    return wire.PositionView(
        t_ms=NOW_MS - age_ms,
        north_m=1.5 + (index * 5.3) % 11,
        east_m=1.5 + (index * 3.7) % 21,
        down_m=0.0,
        floor=index % 2,
        ellipse_major_m=0.8 + 0.3 * (index % 5) + age_ms / 1000,
        ellipse_minor_m=0.6 + age_ms / 1000,
        ellipse_heading_rad=index * 0.7,
        std_down_m=0.2,
        heading_rad=index * 1.1,
        heading_std_rad=0.1,
        quality="good",
        quality_reason="",
        since_gps_s=None,
        lat_deg=None,
        lon_deg=None,
        floor_probability=1.0,
        reach=(),
    )


def unit(index: int) -> wire.UnitView:
    """Somebody at work, who is well."""
    return wire.UnitView(
        unit_id=unit_id(index),
        label=unit_id(index),
        registered=True,
        person=person(index),
        link="live",
        last_heard_ms=NOW_MS - 300,
        status=wire.StatusView(
            "walking", 0.0, 0.4 + index % 6 / 10, False, 420, 260.0, None, "unknown", ()
        ),
        status_ms=NOW_MS - 500,
        ambient_degc=18.0 + index,
        heat_level="",
        heat_used=0.0,
        position=position(index),
        inside_since_ms=NOW_MS - 14 * MINUTE_MS,
        duty=wire.DutyView(
            NOW_MS - 9 * MINUTE_MS,
            "chief",
            NOW_MS + (3 + index % 9) * MINUTE_MS,
            None,
            NOW_MS - 14 * MINUTE_MS,
            None,
            NOW_MS + 26 * MINUTE_MS,
            "radio",
            NOW_MS - 50 * MINUTE_MS,
            located=True,
            entry_id=f"k{index}",
        ),
        alarms=(),
        trust=wire.TrustView("green", ""),
        clock=wire.ClockView(1.0, 0.5),
        cloned=False,
        gps="",
        switched_off=False,
        ambient_ms=NOW_MS - 400,
        ambient_sensors=(),
        can_be_notified=True,
        preflight=wire.PreflightView(*(_WARNINGS if index == 4 else ("ok", ""))),
    )


def trail(shown: wire.UnitView) -> wire.Trail:
    """From the engine to where somebody is now."""
    end = position(int(shown.unit_id[3:]) - 1)
    steps = 60
    points = tuple(
        wire.TrailPoint(
            NOW_MS - 1000 * (steps - step),
            -25 + (end.north_m + 25) * step / steps,
            -8 + (end.east_m + 8) * step / steps + math.sin(step / 5),
            end.floor,
        )
        for step in range(steps)
    )
    return wire.Trail(shown.unit_id, msgspec.Raw(msgspec.json.encode(points)))


def picture(units: list[wire.UnitView], *alarms: wire.AlarmView) -> wire.Snapshot:
    return wire.Snapshot(
        seq=1,
        now_ms=NOW_MS,
        incident=INCIDENT,
        units=tuple(units),
        alarms=alarms,
        commands=(),
        pins=(),
        beacons=(),
        external=(),
        plan=msgspec.Raw(PLAN.read_bytes()),
        anchor=None,
        health=HEALTH,
        replay=None,
    )


def quiet(count: int = 5) -> wire.Snapshot:
    return picture([unit(index) for index in range(count)])


def without_outputs() -> wire.Snapshot:
    """All are well; the units of two of them have no output to notify them with."""
    units = [
        msgspec.structs.replace(unit(index), can_be_notified=index not in {0, 2})
        for index in range(5)
    ]
    return picture(units)


def par_requested() -> wire.Snapshot:
    """A PAR was requested at the beginning, and nobody has confirmed one."""
    units = []
    for index in range(5):
        member = unit(index)
        assert member.duty is not None
        duty = msgspec.structs.replace(
            member.duty,
            checked_in_ms=None,
            checked_in_by="",
            asked_ms=NOW_MS - 20_000,
            confirmed="not_yet",
        )
        units.append(msgspec.structs.replace(member, duty=duty))
    return picture(units)


def routes() -> list[dict[str, object]]:
    """Ways of two rescuers to a member, as the station answers."""
    corners = ((0.0, 12.0, 0), (8.5, 12.7, 0), (8.5, 12.7, 1), (7.0, 5.0, 1))
    places = [{"north_m": n, "east_m": e, "floor": floor} for n, e, floor in corners]
    known = {
        "unit_id": unit_id(0),
        "known": True,
        "distance_m": 21.4,
        "uncertainty_m": 3.1,
        "crosses_walls": True,
        "text": "9 m to the stairs, up one floor, west, 8 m",
        "next_text": "9 m to the stairs, up one floor, west, 8 m",
        "legs": [],
        "places": places,
    }
    text = "no known way; 23 m to the north-east, one floor up"
    line = {"unit_id": unit_id(4), "known": False, "crosses_walls": False, "text": text}
    return [known, {**known, **line, "places": [places[0], places[-1]]}]


def alarm(index: int, rule: str, priority: int, text: str, ago_s: int) -> wire.AlarmView:
    raised_ms = NOW_MS - 1000 * ago_s
    return wire.AlarmView(
        f"{rule}:{unit_id(index)}",
        rule,
        unit_id(index),
        priority,
        "raised",
        "warning" if rule == "heat" else "alarm",
        text,
        "",
        raised_ms,
        raised_ms,
        raised_ms,
    )


def with_alarms(one: wire.UnitView, *alarms: wire.AlarmView, **change: object) -> wire.UnitView:
    ids = tuple(alarm.alarm_id for alarm in alarms)
    return msgspec.structs.replace(one, alarms=ids, **change)


def bad_minute(count: int = 5) -> wire.Snapshot:
    """One is down, one is in the heat, one is not heard, one is not ours, one was never heard."""
    units = [unit(index) for index in range(count)]
    fall = alarm(1, "fall", 1, "Jonas Bergman may have fallen", 50)
    still = alarm(1, "no-motion", 1, "Jonas Bergman has not moved for 30 s", 34)
    heat = alarm(
        2, "heat", 2, "186 °C around the equipment of Mira Okafor, 35% of its heat budget used", 55
    )
    lost = alarm(3, "link-lost", 2, "Nothing heard of Tomas Novak's unit for 30 s", 41)
    lying = wire.StatusView("lying", 55.0, 0.07, False, 80, 51.0, None, "unknown", ())
    units[1] = with_alarms(units[1], fall, still, status=lying)
    units[2] = with_alarms(units[2], heat, heat_level="warning", ambient_degc=186.0)
    units[3] = with_alarms(
        units[3],
        lost,
        link="lost",
        last_heard_ms=NOW_MS - 71_000,
        status_ms=NOW_MS - 72_000,
        position=position(3, 71_000),
        trust=wire.TrustView("red", "no message: shown at its last known position"),
    )
    stranger = msgspec.structs.replace(
        unit(count), registered=False, person=None, position=None, duty=None, status=None
    )
    silent = msgspec.structs.replace(
        unit(count + 1), link="never", last_heard_ms=None, position=None, status=None
    )
    shown = picture([*units, stranger, silent], fall, still, heat, lost)
    par = wire.CommandView(
        "c1",
        "par_request",
        "",
        "chief",
        NOW_MS - 60_000,
        NOW_MS + 500_000,
        asks_wearer=True,
        notifies_wearer=True,
        open=True,
        units=tuple(
            delivery(one.unit_id, state)
            for one, state in zip(
                units, ("received", "received", "sent", "queued", "received"), strict=False
            )
        ),
        incident_id=INCIDENT.incident_id,
    )
    health = msgspec.structs.replace(
        HEALTH, problems=("only 700 MB are free for the log", "The bus's router is away")
    )
    pins = (
        pin("a", 0, "used", 3.0, ""),
        pin("b", 1, "conflict", 8.0, "It is 11.2 m from where the trail was then"),
    )
    return msgspec.structs.replace(shown, commands=(par,), health=health, pins=pins)


def pin(pin_id: str, index: int, state: str, north_m: float, text: str) -> wire.PinView:
    return wire.PinView(
        pin_id=pin_id,
        kind="place",
        unit_id=unit_id(index),
        other_id="",
        t_ms=NOW_MS - 90_000,
        north_m=north_m,
        east_m=4.0,
        floor=0,
        std_m=1.0,
        heading_rad=None,
        heading_std_rad=0.0,
        note="",
        by="chief",
        set_ms=NOW_MS - 80_000,
        state=state,
        residual_m=0.4,
        sigmas=0.3,
        text=text,
    )


def answered() -> wire.Snapshot:
    """A roll call that everybody has answered."""
    shown = bad_minute()
    answers = tuple(
        msgspec.structs.replace(
            one,
            state="acknowledged",
            acknowledged_ms=NOW_MS,
            acknowledged_by="Featherstonehaugh",
            acknowledged_via="self",
        )
        for one in shown.commands[0].units
    )
    return msgspec.structs.replace(
        shown, commands=(msgspec.structs.replace(shown.commands[0], units=answers),)
    )


def never_confirmed(one: wire.UnitView) -> wire.UnitView:
    """The same member, on duty for two minutes, of whom no message has come yet."""
    duty = wire.DutyView(
        None,
        "",
        NOW_MS + 18 * MINUTE_MS,
        None,
        None,
        None,
        None,
        "not_yet",
        NOW_MS - 2 * MINUTE_MS,
        located=False,
        entry_id="",
    )
    return msgspec.structs.replace(
        one, duty=duty, link="never", last_heard_ms=None, position=None, status=None,
        inside_since_ms=None,
    )  # fmt: skip


def order(
    command_id: str,
    kind: str,
    states: dict[str, str],
    *,
    is_open: bool = True,
    incident_id: str = INCIDENT.incident_id,
    without_output: Collection[str] = (),
    ended_ms: int | None = None,
) -> wire.CommandView:
    """To these units, a minute ago; some of them cannot notify their wearers."""
    return wire.CommandView(
        command_id,
        kind,
        "",
        "chief",
        NOW_MS - 60_000,
        NOW_MS + 500_000,
        asks_wearer=kind != "locate",
        notifies_wearer=True,
        open=is_open,
        units=tuple(
            delivery(unit, state, can_be_notified=unit not in without_output)
            for unit, state in states.items()
        ),
        incident_id=incident_id,
        ended_ms=ended_ms,
    )


def delivery(unit_id: str, state: str, can_be_notified: bool = True) -> wire.DeliveryView:
    """Sent a minute ago; who has acknowledged it did so on the own unit."""
    acknowledged = state == "acknowledged"
    return wire.DeliveryView(
        unit_id=unit_id,
        state=state,
        sent_ms=NOW_MS - 60_000,
        received_ms=None,
        notified_ms=NOW_MS - 58_000 if state == "notified" else None,
        acknowledged_ms=NOW_MS - 40_000 if acknowledged else None,
        acknowledged_by=unit_id if acknowledged else "",
        reason="",
        acknowledged_via="self" if acknowledged else "",
        can_be_notified=can_be_notified,
    )


def switched_off() -> wire.Snapshot:
    """Two units that were switched off in order ten minutes ago; the alarm about one is open."""
    units = [unit(index) for index in range(5)]
    for index in (0, 1):
        units[index] = msgspec.structs.replace(
            units[index],
            link="lost",
            switched_off=True,
            last_heard_ms=NOW_MS - 10 * MINUTE_MS,
            status_ms=NOW_MS - 10 * MINUTE_MS,
            position=position(index, 10 * MINUTE_MS),
            trust=wire.TrustView("red", "no message: shown at its last known position"),
        )
    off = alarm(0, "link-lost", 3, "Astrid Lindqvist's unit was switched off", 600)
    off = msgspec.structs.replace(off, level="switched off")
    units[0] = with_alarms(units[0], off)
    return picture(units, off)


FAULTS = ("no usable inertial sample for 1 s", "the journal cannot be written: the disk is full")


def two_faults() -> wire.Snapshot:
    """Of one unit, whose wearer is well."""
    units = [unit(index) for index in range(5)]
    alarms = []
    for number, fault in enumerate(FAULTS):
        one = alarm(2, "unit-fault", 2, f"Mira Okafor's unit: {fault}", 60 - number)
        alarms.append(msgspec.structs.replace(one, alarm_id=f"fault {number}", level="fault"))
    units[2] = with_alarms(units[2], *alarms)
    return picture(units, *alarms)


def at_the_edges() -> wire.Snapshot:
    """No plan; people at each side of all there is, all of them to be named."""
    places_m = ((0.0, -20.0), (0.0, 20.0), (20.0, 0.0), (-20.0, 0.0))
    units, falls = [], []
    for index, (north_m, east_m) in enumerate(places_m):
        at = msgspec.structs.replace(position(index), north_m=north_m, east_m=east_m, floor=0)
        falls.append(alarm(index, "fall", 1, f"{NAMES[index]} may have fallen", 20 + index))
        units.append(with_alarms(unit(index), falls[-1], position=at))
    return msgspec.structs.replace(picture(units, *falls), plan=None)


def pins_at_the_edges() -> wire.Snapshot:
    """Pins that contradict the rest, each of which says whose it is, beside the same people."""
    places_m = ((8.0, -20.0), (8.0, 20.0), (20.0, 8.0), (-20.0, 8.0))
    pins = tuple(
        msgspec.structs.replace(
            pin(str(index), index, "conflict", north_m, "It is 11.2 m away"), east_m=east_m
        )
        for index, (north_m, east_m) in enumerate(places_m)
    )
    return msgspec.structs.replace(at_the_edges(), pins=pins)


ALONE = "There is no standby: what is done now is on this station alone"


def overdue() -> wire.Snapshot:
    """One has not been heard from in time; a station that has to say something of itself."""
    units = [unit(index) for index in range(5)]
    missed = alarm(
        0, "missed-check-in", 1, f"{NAMES[0]}: PAR overdue, not heard from for 20 min", 9
    )
    missed = msgspec.structs.replace(missed, level="overdue")
    duty = units[0].duty
    assert duty is not None
    late = msgspec.structs.replace(
        duty, checked_in_ms=NOW_MS - 20 * MINUTE_MS, due_ms=NOW_MS - 9000
    )
    units[0] = with_alarms(units[0], missed, duty=late)
    health = msgspec.structs.replace(long_names().health, problems=(ALONE, "b"))
    return msgspec.structs.replace(picture(units, missed), health=health)


def taken(one: wire.AlarmView) -> wire.AlarmView:
    """The same alarm once somebody has acknowledged it."""
    return msgspec.structs.replace(one, state="acknowledged", by="chief")


def crowd() -> wire.Snapshot:
    """Forty people, four of whom need somebody."""
    return bad_minute(40)


def lost_link(index: int, ago_s: float = 41) -> wire.AlarmView:
    return alarm(index, "link-lost", 2, f"Nothing heard of {unit_id(index)} for 30 s", int(ago_s))


def flood(count: int = 200, down: int = 3) -> wire.Snapshot:
    """All have lost their link at one time; the first few of them are down besides."""
    units, alarms = [], []
    for index in range(count):
        of_unit = [lost_link(index)]
        if index < down:
            name = person(index).name
            of_unit.insert(0, alarm(index, "fall", 1, f"{name} may have fallen", 20 + index))
        units.append(
            with_alarms(
                unit(index), *of_unit, link="lost", last_heard_ms=NOW_MS - 71_000,
                position=position(index, 71_000),
            )
        )  # fmt: skip
        alarms += of_unit
    return picture(units, *alarms)


def some_down(count: int, down: int) -> wire.Snapshot:
    """The first few have fallen; all others are well."""
    units = [unit(index) for index in range(count)]
    falls = [
        alarm(index, "fall", 1, f"{person(index).name} may have fallen", 20 + index)
        for index in range(down)
    ]
    units[:down] = [with_alarms(one, fall) for one, fall in zip(units, falls, strict=False)]
    return picture(units, *falls)


def mixed(count: int = 40) -> wire.Snapshot:
    """One is down, one rests outside, two are not located, and three were never heard."""
    shown = bad_minute(count)
    units = list(shown.units[:count])
    resting = units[10].duty
    assert resting is not None
    units[10] = msgspec.structs.replace(
        units[10],
        inside_since_ms=None,
        duty=msgspec.structs.replace(resting, rest_since_ms=NOW_MS - MINUTE_MS),
    )
    for index in (11, 12):
        units[index] = msgspec.structs.replace(units[index], position=None, inside_since_ms=None)
    units[13:16] = [never_confirmed(one) for one in units[13:16]]
    return msgspec.structs.replace(shown, units=tuple(units))


def long_names() -> wire.Snapshot:
    """At one of two stations, with an incident that is called by its whole address."""
    shown = bad_minute()
    name = "Apartment fire, Lindenstrasse 14 rear building, third alarm"
    standby = wire.StandbyView(
        "command-vehicle-1", "active", "", "engine-2", "standby", "http://b.test", in_step=True
    )
    units = tuple(
        one
        if one.duty is None
        else msgspec.structs.replace(
            one, duty=msgspec.structs.replace(one.duty, due_ms=NOW_MS - 15 * MINUTE_MS)
        )
        for one in shown.units
    )
    return msgspec.structs.replace(
        shown,
        units=units,
        incident=msgspec.structs.replace(INCIDENT, name=name),
        health=msgspec.structs.replace(shown.health, standby=standby),
    )


def one_word() -> wire.Snapshot:
    """As long as names may be, and nowhere to break them; a message to everybody is under way."""
    word = "W" * 80
    shown = bad_minute()
    units = tuple(
        one
        if one.person is None
        else msgspec.structs.replace(
            one, person=msgspec.structs.replace(one.person, name=word, crew=word, role=word)
        )
        for one in shown.units
    )
    message = msgspec.structs.replace(shown.commands[0], command_id="c2", kind="text", text=word)
    fall, *others = (
        msgspec.structs.replace(one, text=f"{word}: {one.text}") for one in shown.alarms
    )
    return msgspec.structs.replace(
        shown,
        units=units,
        alarms=(msgspec.structs.replace(fall, state="acknowledged", by=word), *others),
        commands=(*shown.commands, message),
        incident=msgspec.structs.replace(INCIDENT, name=word),
    )


def nobody() -> wire.Snapshot:
    empty = picture([])
    return msgspec.structs.replace(empty, incident=None, plan=None)


def stored() -> wire.Snapshot:
    """What a station shows of its tables while it reads its log after a crash."""
    shown = bad_minute()
    return msgspec.structs.replace(shown, health=msgspec.structs.replace(HEALTH, reading=0.42))


HARBOUR = wire.IncidentView(
    "20261121-2",
    "Harbour, shed 4",
    NOW_MS - 12 * MINUTE_MS,
    None,
    1200.0,
    300.0,
    2400.0,
    site_id="site-2",
)


def two_incidents() -> wire.Snapshot:
    """Five in the flats, two at the harbour, opened last, one of them down; one in none."""
    incidents = 5 * [INCIDENT.incident_id] + 2 * [HARBOUR.incident_id] + [None]
    units = [
        msgspec.structs.replace(unit(index), incident_id=incident_id)
        for index, incident_id in enumerate(incidents)
    ]
    fall = alarm(6, "fall", 1, f"{NAMES[6]} may have fallen", 50)
    units[6] = with_alarms(units[6], fall)
    units[7] = msgspec.structs.replace(units[7], duty=None)
    flats = picture(units, fall)
    assert flats.plan is not None
    own = wire.SiteView("", flats.plan, None, plan_placed=True)
    return msgspec.structs.replace(
        flats, incident=HARBOUR, incidents=(INCIDENT, HARBOUR), plan=None, sites=(own,)
    )


def with_sensors() -> wire.Snapshot:
    """Each unit has two, and the station knows where."""
    worn = (
        wire.WornSensorView("left", "left_foot", False, "laces", "ICM-20948"),
        wire.WornSensorView("trunk", "lower_back", True, "belt", "ICM-20948"),
    )
    shown = crowd()
    units = [
        msgspec.structs.replace(one, sensors=worn, tracker="foot_and_trunk") for one in shown.units
    ]
    return msgspec.structs.replace(shown, units=tuple(units))


def dispatch(number: str, **change: Any) -> wire.DispatchView:
    """Offered: no incident was opened from it."""
    reported = wire.DispatchView(
        *(number, "json", "Structure fire", "", "", "Main St 5", None, None),
        units=("E12",),
        called_ms=None,
        dispatched_ms=None,
        updated_ms=None,
        remarks="",
        has_ended=False,
        warnings=(),
        received_ms=NOW_MS,
    )
    return msgspec.structs.replace(reported, **change)


def past() -> wire.Snapshot:
    shown = bad_minute()
    replay = wire.ReplayView(
        INCIDENT.incident_id, INCIDENT.opened_ms, NOW_MS + 8 * MINUTE_MS, NOW_MS, 4.0, True
    )
    return msgspec.structs.replace(shown, replay=replay)


INCIDENTS = [
    {
        "incident_id": INCIDENT.incident_id,
        "name": INCIDENT.name,
        "opened_ms": INCIDENT.opened_ms,
        "closed_ms": NOW_MS + 8 * MINUTE_MS,
    }
]


def replay(replay_id: str, begun_by: str) -> dict[str, object]:
    return {
        "replay_id": replay_id,
        "incident_id": INCIDENT.incident_id,
        "begun_by": begun_by,
    }


PEOPLE = [
    {
        "person_id": f"p{index}",
        "name": name,
        "crew": CREWS[index % len(CREWS)],
        "role": ROLE,
        "photo_url": None,
    }
    for index, name in enumerate(NAMES)
]


def life(alarm: wire.AlarmView, minutes: int = 0, **resolution: object) -> dict[str, Any]:
    """An alarm as the list has it, raised so many minutes earlier; with a resolution it was
    acknowledged after 9 s and resolved after 40 s.
    """
    raised_ms = alarm.raised_ms - minutes * MINUTE_MS
    states: list[tuple[int, str, str, dict[str, object]]] = [(raised_ms, "raised", "", {})]
    if resolution:
        states.append((raised_ms + 9_000, "acknowledged", "mia", {}))
        states.append((raised_ms + 40_000, "resolved", "chief", resolution))
    sentence = {
        "text": alarm.text,
        "code": alarm.code,
        "parameters": msgspec.to_builtins(alarm.parameters),
    }
    none = {"reason": "", "note": "", "peak": alarm.peak}
    changes = [
        {
            "t_ms": t_ms, "state": state, "level": alarm.level, "by": by, **sentence,
            **none, **more,
        }
        for t_ms, state, by, more in states
    ]  # fmt: skip
    last = {name: changes[-1][name] for name in ("state", "by", "reason", "note", "peak")}
    return {
        **msgspec.to_builtins(alarm),
        **last,
        "raised_ms": raised_ms,
        "last_raised_ms": raised_ms,
        "changed_ms": changes[-1]["t_ms"],
        "raisings": [{"t_ms": raised_ms, **sentence}],
        "changes": changes,
    }


PAST_ALARMS = [life(one, minutes) for minutes, one in enumerate(bad_minute().alarms)]
_FIGURES = dict.fromkeys(("ce50_m", "ve50_m", "se50_m"), 0.4) | dict.fromkeys(
    ("ce95_m", "ve95_m", "se95_m"), 2.4
)
ASSESSMENT = {
    "incident_id": INCIDENT.incident_id,
    "made_ms": NOW_MS,
    "flaws": ["The segment 000002-20260501T101500Z.mcap of the log is missing."],
    "units": [
        {
            "unit_id": unit_id(index),
            "people": [name],
            "seconds": 188.0,
            "walked_m": 151.0 + index,
            "stated": _FIGURES,
            "against_smoothed": _FIGURES,
            "floor_probability": 1.0,
            "floor_right": 0.99,
            "trust": {
                "green_s": 168.0,
                "amber_s": 35.0,
                "red_s": 4.0,
                "causes": [["no message", 35.0], ["place only roughly known", 12.0]],
            },
            "pin_residuals": [],
            "loop_closure_m": 1.5,
            "loop_closure_percent": 1.0,
            "reentry_jumps_m": [0.4],
            "not_used": [["the receiver has no fix", 128]],
        }
        for index, name in enumerate(NAMES)
    ],
    "stated": _FIGURES,
    "against_smoothed": _FIGURES,
    "is_newest": True,
}
