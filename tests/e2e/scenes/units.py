"""Units of a played station, in the states that a card shows."""

from __future__ import annotations

import math
from pathlib import Path

import msgspec

from base_station.views import wire

NOW_MS = 1_795_255_608_000


MINUTE_MS = 60_000


PLAN = Path(__file__).resolve().parents[3] / "edge" / "simulation" / "building.geojson"


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


def no_members() -> wire.Snapshot:
    empty = picture([])
    return msgspec.structs.replace(empty, incident=None, plan=None)
