"""Alarms of a played station: one, some, and floods."""

from __future__ import annotations

import msgspec

from base_station.views import wire
from tests.e2e.scenes.actions import delivery, pin
from tests.e2e.scenes.units import (
    HEALTH,
    INCIDENT,
    NOW_MS,
    person,
    picture,
    position,
    unit,
    unit_id,
)


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


FAULTS = ("no usable inertial sample for 1 s", "the journal cannot be written: the disk is full")


def two_faults() -> wire.Snapshot:
    """Two faults of one unit, whose wearer is well."""
    units = [unit(index) for index in range(5)]
    alarms = []
    for number, fault in enumerate(FAULTS):
        one = alarm(2, "unit-fault", 2, f"Mira Okafor's unit: {fault}", 60 - number)
        alarms.append(msgspec.structs.replace(one, alarm_id=f"fault {number}", level="fault"))
    units[2] = with_alarms(units[2], *alarms)
    return picture(units, *alarms)


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
