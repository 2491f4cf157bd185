"""Incidents of a played station: several at once, past ones, replays, dispatches."""

from __future__ import annotations

from typing import Any

import msgspec

from base_station.views import wire
from tests.e2e.scenes.alarms import alarm, bad_minute, with_alarms
from tests.e2e.scenes.units import (
    CREWS,
    INCIDENT,
    MINUTE_MS,
    NAMES,
    NOW_MS,
    ROLE,
    picture,
    unit,
    unit_id,
)

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
