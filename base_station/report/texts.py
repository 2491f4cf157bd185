"""English texts of a report, all of them: a translation replaces this file only."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from datetime import UTC, datetime
from typing import Any

from base_station.report.contents import OrderReceipt, PhotoEntry

Details = Mapping[str, Any]
NameOf = Callable[[str], str]  # of the wearer of a unit

TITLE = "Incident report"
PREPARED = (
    "Made from the station's log. All times are UTC. Positions are as the console showed them at "
    "the time."
)
OPEN_INCIDENT = "The incident is still open: this report ends with the last record of the log."
UNKNOWN, NONE = "unknown", "none"
NOT_ASSIGNED = "not assigned"
EVERYONE = "everyone"

DISPATCH = "Dispatch"
OPENED, CLOSED, STILL_OPEN, LASTED = "Opened", "Closed", "still open", "Lasted"
ALARMS, RADIO_GAPS = "Alarms", "Radio gaps"
TIMELINE, PAR, ORDERS = "Timeline", "Roll calls (PAR)", "Orders"
PLAN, PEOPLE, TRACES = "Plan by floor", "People", "Alarms explained"
IMPORTS, PHOTOGRAPHS = "Brought in", "Photographs"
POSITIONS, RECORD, SETTINGS = "Quality of positions", "Gaps in the record", "Versions and settings"

NO_ORDERS = "No order was given."
NO_PAR = "No roll call was ordered."
NO_PEOPLE = "No unit was worn and no position was recorded."
NO_POSITIONS = "No position was recorded."
NO_PLAN = "No plan of the building was set: trails are drawn without walls."
NO_ANCHOR = "The site has no place on the Earth: north in the pictures is north of the plan."
NO_ALARMS = "No alarm was raised."
NO_DEFECTS = "None found: every segment of the log is there and can be read."
NO_ASSESSMENT = (
    "Not worked out. With `muster base assess` or 'Accuracy report' in the console it is, and the "
    "next report has it."
)
IMPORTS_KEY = (
    "Files from elsewhere: this station has not measured what is in them. The hash is of the file "
    "as it came."
)
PHOTOGRAPHS_KEY = (
    "Scaled down. Time and place are those of the camera, with the seconds that were added to its "
    "clock; the files as they came are with the incident."
)
NO_FILE = "The file is not here, so there is no picture: it was brought in at another station."
OTHER_FILE = (
    "The file is damaged, so there is no picture: its hash is not that of the file that came. "
    "Bring it in again."
)
TOO_MANY_PIXELS = "It has too many pixels to be shown here."
NO_TIMELINE = "Nothing was recorded."
TRAILS_KEY = (
    "Solid line: trail with radio contact. Dashed line: radio gap, known afterwards from the "
    "unit's memory. A line that ends without a square: the way from there on is not known. "
    "Circle: first position. Square: last position. The number there and on the line is that of "
    "the person below."
)
TRACES_KEY = (
    "From 60 s before to 60 s after the alarm was raised (vertical line). Link: one mark for each "
    "message that came by radio. Dotted: the threshold of the rule."
)
PEOPLE_KEY = (
    "Distance: along the trail shown. Inside: within the outline of the plan. Heat budget: part of "
    "what the equipment is made for (NIST TN 1474); no measure of the wearer's condition. "
    "Radio gap: more than 10 s without a message."
)
POSITIONS_KEY = (
    "Light: for which part of the time the station's own light was green, amber, red. "
    "CE95: horizontal error that 95 % of the positions do not exceed (ISO/IEC 18305), as stated at "
    "the time and against the trail as it is known afterwards."
)
CHANGED = "changed"

HEAD_TIMELINE = ("Time", "Kind", "Event", "By")
HEAD_ORDERS = ("Time", "Order", "By", "To", "Acknowledged", "Not acknowledged")
HEAD_PAR = ("Time", "By", "Asked", "Answered", "No answer")
HEAD_PEOPLE = (
    "No.", "Person", "Unit", "From to", "Distance", "Inside", "Floors", "Hottest", "Heat budget",
    "Radio gaps",
)  # fmt: skip
HEAD_POSITIONS = (
    "Unit", "Light: green amber red", "Main reason", "CE95 stated", "CE95 known", "Floor right",
)  # fmt: skip
HEAD_IMPORTS = ("File", "Format", "From to", "Seconds added", "Brought in", "SHA-256")
HEAD_UNITS = ("Unit", "Software", "Tracker", "Calibration")
HEAD_THRESHOLDS = ("Threshold", "In force", "Default", "")

ALARM, ORDER, PERSON, SITE, INCIDENT, STATION = (
    "Alarm", "Order", "People", "Site", "Incident", "Station",
)  # fmt: skip
ERASED_PEOPLE = "people who were forgotten"
ERASED = (SITE, "Entry about a person who was forgotten")
MOTIONLESS, TEMPERATURE, HEIGHT, LINK = "still, s", "air, °C", "height, m", "link"
NORTH = "N"

ORDER_NAMES = {
    "EVACUATE": "Evacuate",
    "PAR_REQUEST": "Roll call (PAR)",
    "TEXT": "Message",
    "LOCATE": "Locate",
    "SET_POSITION_RATE": "Position rate",
    "RESET_ALARM": "Reset alarm",
    "ALL_CLEAR": "All clear",
    "END_ORDER": "Sound locator stopped",
}
URGENT_ORDERS = frozenset({ORDER_NAMES["EVACUATE"], ORDER_NAMES["ALL_CLEAR"]})


# Why an alarm was resolved, by the codes of ``base_station.core.alarms.resolution_reasons``.
REASONS: Mapping[str, str] = {
    "false_alarm": "false alarm",
    "member_well": "member is well",
    "found_and_helped": "found and helped",
    "cause_removed": "cause removed",
    "unit_fault": "fault of the unit",
    "training": "training or test",
    "other": "other reason",
}
PEAK = "measured peak"


def clock_time(t_ns: int) -> str:
    return f"{datetime.fromtimestamp(t_ns // 1_000_000_000, UTC):%H:%M:%S}"


def date_and_time(t_ns: int) -> str:
    return f"{datetime.fromtimestamp(t_ns // 1_000_000_000, UTC):%Y-%m-%d %H:%M:%S}"


def duration(seconds: float) -> str:
    whole = round(seconds)
    if whole < 60:
        return f"{whole} s"
    hours, minutes = divmod(whole // 60, 60)
    return f"{hours} h {minutes:02} min" if hours else f"{minutes} min {whole % 60:02} s"


def floor_name(floor: int | None) -> str:
    return "floor unknown" if floor is None else f"floor {floor}"


def counted(count: int, one: str, many: str) -> str:
    return f"{count} {one if count == 1 else many}"


def time_and_author(t_ns: int, by: str) -> str:
    return f"{date_and_time(t_ns)} by {by}"


def from_to(from_ns: int, until_ns: int) -> str:
    """Span of time in words; one time if both are the same second, as of a photograph."""
    first, last = clock_time(from_ns), clock_time(until_ns)
    return first if first == last else f"{first} to {last}"


def alarm_count_text(alarms: int, urgent: int) -> str:
    return f"{alarms}, raised as urgent {counted(urgent, 'time', 'times')}"


def hottest(t_ns: int, degc: float) -> str:
    return f"{degc:.0f} °C at {clock_time(t_ns)}"


def radio_gaps(gaps: str) -> str:
    return f"{RADIO_GAPS}: {gaps}"


def order_name(kind: str) -> str:
    return ORDER_NAMES.get(kind, kind.lower().replace("_", " "))


def sent_again(order: str) -> str:
    return f"{order} (sent again)"


def acknowledged(receipt: OrderReceipt, name: str, ordered_ns: int) -> str:
    if receipt.acknowledged_ns is not None:
        after = duration(max(receipt.acknowledged_ns - ordered_ns, 0) / 1e9)
        return f"{name} (own unit, after {after})"
    assert receipt.radio_ns is not None
    after = duration(max(receipt.radio_ns - ordered_ns, 0) / 1e9)
    return f"{name} (by radio, entered by {receipt.radio_by} after {after})"


def not_acknowledged(receipt: OrderReceipt, name: str) -> str:
    if receipt.refused is not None:
        return f"{name} (refused: {receipt.refused})"
    return f"{name} ({'received' if receipt.received_ns is not None else 'not received'})"


def alarm_raised(text: str, level: str) -> str:
    return f"{text} ({level})" if level else text


def alarm_ended(state: str, text: str, reason: str, note: str, peak: str) -> str:
    """Text of an acknowledgement or a resolution; empty without reason, note and measured value."""
    why = REASONS.get(reason, "")  # those of the station stand in the place of the author
    words = [f"{state}: {text}", why, note, f"{PEAK} {peak}" if peak else ""]
    return "; ".join(one for one in words if one)


def alarm_peak(rule: str, peak: float) -> str:
    """Worst measured value, in the unit of the rule."""
    match rule:
        case "heat":
            return f"{peak:.0f} °C"
        case "heat-dose" | "battery":
            return f"{peak:.0%}"
        case _:
            return duration(peak)


def more_in_timeline(count: int) -> str:
    return f"{count} more in the timeline"


def photographs_left_out(count: int) -> str:
    return f"{counted(count, 'photograph more is', 'photographs more are')} not shown here."


def unreadable_picture(reason: str) -> str:
    return f"The file is damaged, so there is no picture ({reason}). Bring it in again."


def place_in_words(lat_deg: float, lon_deg: float) -> str:
    """Position in words, to 0.1 m."""
    north, east = "N" if lat_deg >= 0.0 else "S", "E" if lon_deg >= 0.0 else "W"
    return f"{abs(lat_deg):.6f}° {north}, {abs(lon_deg):.6f}° {east}"


def photograph_caption(entry: PhotoEntry) -> str:
    place = UNKNOWN if entry.place is None else place_in_words(*entry.place)
    brought_in = time_and_author(entry.t_ns, entry.by)
    return f"Taken {date_and_time(entry.taken_ns)} at {place}. Brought in {brought_in}."


def traces_left_out(count: int) -> str:
    return f"{counted(count, 'alarm more has', 'alarms more have')} no picture here."


def action_text(action: str, details: Details, name_of: NameOf) -> tuple[str, str] | None:
    """Kind and sentence of an operator's action; None if other parts of the report have it."""
    describe = _ACTIONS.get(action)
    return _PLAIN_ACTIONS.get(action) if describe is None else describe(details, name_of)


def _order(details: Details, name_of: NameOf) -> tuple[str, str]:
    if details.get("repeats"):
        recipients = name_of(details["unit_id"]) if details["unit_id"] else "all without an answer"
        return ORDER, f"{sent_again(details['order'])} to {recipients}"
    if details.get("ended_command_id"):
        return ORDER, details["order"]
    text = f": {details['text']}" if details["text"] else ""
    return ORDER, f"{details['order']} to {_to(details, name_of)}{text}"


def _to(details: Details, name_of: NameOf) -> str:
    if details.get("everyone"):
        return EVERYONE
    if details.get("unit_id"):
        return name_of(details["unit_id"])
    if details.get("crew"):
        return f"crew {details['crew']}"
    people: Sequence[str] = details.get("people", ())
    return ", ".join(people) or ERASED_PEOPLE


def _despite(details: Details) -> str:
    alarms, people = len(details["despite_alarm_ids"]), len(details["despite_unit_ids"])
    if not alarms and not people:
        return ""
    return (
        f", knowingly over {counted(alarms, 'open alarm', 'open alarms')} and "
        f"{counted(people, 'person', 'people')} inside"
    )


def _from(details: Details) -> str:
    number = details.get("dispatch_number", "")
    return f", from dispatch {number}" if number else ""


def _to_incident(details: Details, name_of: NameOf) -> str:
    names = ", ".join(map(name_of, details["unit_ids"]))
    incident_id = details["incident_id"]
    return f"{names}: {f'to incident {incident_id}' if incident_id else 'unassigned'}"


def _dispatch(details: Details) -> str:
    words = details["type"] or details["type_code"], details["address"], " ".join(details["units"])
    ended = "; ended by the dispatch centre" if details["has_ended"] else ""
    return f"{details['number']}: {', '.join(filter(None, words)) or UNKNOWN}{ended}"


_ACTIONS: Mapping[str, Callable[[Details, NameOf], tuple[str, str]]] = {
    "SendCommand": _order,
    "ConfirmCommand": lambda details, name_of: (
        ORDER,
        f"{name_of(details['unit_id'])} answered an order by radio",
    ),
    "CheckIn": lambda details, name_of: (ORDER, f"PAR by radio: {_to(details, name_of)}"),
    "UndoConfirmation": lambda details, name_of: (
        ORDER,
        f"Answer by radio taken back: {_to(details, name_of)}",
    ),
    "OpenIncident": lambda details, _: (
        INCIDENT,
        f"Incident opened: {details['name']}{_from(details)}",
    ),
    "NoteDispatch": lambda details, _: (INCIDENT, f"Dispatch {_dispatch(details)}"),
    "ImportFile": lambda details, _: (INCIDENT, f"{details['file_name']} brought in"),
    "RemoveImport": lambda _details, _: (INCIDENT, "A file that was brought in was taken out"),
    "DismissDispatch": lambda details, _: (INCIDENT, f"Dispatch {details['number']} dismissed"),
    "CloseIncident": lambda details, _: (INCIDENT, f"Incident closed{_despite(details)}"),
    "Assign": lambda details, _: (PERSON, f"{details['person_name']} wears {details['unit_id']}"),
    "AssignIncident": lambda details, name_of: (PERSON, _to_incident(details, name_of)),
    "Unassign": lambda details, _: (PERSON, f"{details['unit_id']} is not worn"),
    "SetRest": lambda details, name_of: (
        PERSON,
        f"{name_of(details['unit_id'])} "
        f"{'goes to rest' if details['resting'] else 'is back at work'}",
    ),
    "SetAccountability": lambda details, _: (
        INCIDENT,
        f"Roll call every {duration(details['par_interval_s'])}, rest after "
        f"{duration(details['work_limit_s'])}",
    ),
    "RegisterUnit": lambda details, _: (STATION, f"Unit {details['unit_id']} registered"),
    "SetStart": lambda details, name_of: (SITE, f"Start of {name_of(details['unit_id'])} set"),
    "SetReference": lambda details, _: (SITE, f"Barometer reference: {details['unit_id'] or NONE}"),
    "SetPin": lambda details, name_of: (
        SITE,
        f"Pin for {name_of(details['unit_id'])}{': ' if details['note'] else ''}{details['note']}",
    ),
    "SetFuser": lambda details, _: (STATION, f"Fuser of all units: {details['name']}"),
    "TakeOver": lambda details, _: (STATION, f"Station {details['station']} took over"),
    "DoneApart": lambda details, _: (
        STATION,
        "While the stations were apart, "
        f"{details['who']} at {details['station']}: {details['what']}",
    ),
}
_PLAIN_ACTIONS = {
    "SetThresholds": (STATION, "Alarm thresholds set"),
    "SetPlan": (SITE, "Plan of the building set"),
    "SetAnchor": (SITE, "Place of the site on the Earth set"),
    "StartTogether": (SITE, "Common start set"),
    "SetMeeting": (SITE, "Meeting of two people set"),
    "RemovePin": (SITE, "Pin removed"),
    "PlaceBeacon": (SITE, "Beacon placed"),
    "RemoveBeacon": (SITE, "Beacon removed"),
}


def made_by(version: str, par_interval_s: float, work_limit_s: float) -> str:
    return (
        f"Made by Muster {version}. At the end of the incident: roll call every "
        f"{duration(par_interval_s)}, rest after {duration(work_limit_s)}, and these thresholds of "
        "the alarms:"
    )
