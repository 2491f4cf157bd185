"""Whole screens of a played station, with contents of several kinds."""

from __future__ import annotations

import msgspec

from base_station.views import wire
from tests.e2e.scenes.actions import pin
from tests.e2e.scenes.alarms import alarm, bad_minute, crowd, with_alarms
from tests.e2e.scenes.units import (
    HEALTH,
    INCIDENT,
    MINUTE_MS,
    NAMES,
    NOW_MS,
    picture,
    position,
    unit,
)


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


def stored() -> wire.Snapshot:
    """Picture from the tables of a station while it reads its log after a crash."""
    shown = bad_minute()
    return msgspec.structs.replace(shown, health=msgspec.structs.replace(HEALTH, reading=0.42))


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
