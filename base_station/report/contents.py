"""Contents of a report, as plain data in station time.

Their size is bounded: trails are simplified, and series are kept about alarms only.
"""

from __future__ import annotations

import msgspec

from base_station.replay.assessment.report import IncidentReport
from base_station.site.plan import Plan

Line = tuple[tuple[float, float], ...]  # (east_m, north_m) in the incident frame
Series = tuple[tuple[int, float], ...]  # (station time, value)


class Interval(msgspec.Struct, frozen=True):
    from_ns: int
    until_ns: int

    @property
    def seconds(self) -> float:
        return (self.until_ns - self.from_ns) / 1e9

    def within(self, other: Interval) -> Interval | None:
        """Part that lies in the other interval; None if there is none."""
        both = Interval(max(self.from_ns, other.from_ns), min(self.until_ns, other.until_ns))
        return both if both.from_ns < both.until_ns else None


class WornTime(msgspec.Struct, frozen=True):
    """One person with one unit, within the incident."""

    unit_id: str
    name: str  # empty: no person was assigned
    crew: str
    role: str
    during: Interval


class FloorTrail(msgspec.Struct, frozen=True):
    """Parts of a trail on one floor; None if the floor was not known."""

    floor: int | None
    in_contact: tuple[Line, ...]  # while the radio had contact
    radio_gap: tuple[Line, ...]  # known afterwards, out of the unit's journal


class PersonEntry(msgspec.Struct, frozen=True):
    number: int  # in the pictures
    wearing: WornTime
    positions: int
    distance_m: float  # along the trail that was shown
    inside_s: float | None  # None: the plan has no outline
    floors: tuple[tuple[int | None, float], ...]  # with seconds, lowest first
    hottest: tuple[int, float] | None  # when, and degrees Celsius; None: no thermometer
    dose: float  # 1: the heat budget is used up
    radio_gaps: tuple[Interval, ...]
    trails: tuple[FloorTrail, ...]
    begin: tuple[int | None, float, float] | None  # floor, east_m, north_m of the first position
    end: tuple[int | None, float, float] | None  # and of the last one


class OrderReceipt(msgspec.Struct, frozen=True):
    """Progress of one order at one unit; None for a step that is not known to have happened."""

    unit_id: str
    received_ns: int | None = None
    acknowledged_ns: int | None = None
    radio_ns: int | None = None  # entered by an operator, after an answer by radio
    radio_by: str = ""
    refused: str | None = None  # with the reason


class OrderEntry(msgspec.Struct, frozen=True):
    t_ns: int
    by: str
    kind: str  # as ``CommandKind`` calls it
    text: str
    receipts: tuple[OrderReceipt, ...]
    is_repeat: bool = False  # its receipts are of this sending; the first order has all of them


class TimelineEntry(msgspec.Struct, frozen=True):
    t_ns: int
    kind: str  # heading of ``texts.KINDS``
    text: str
    by: str
    is_urgent: bool = False


class AlarmTrace(msgspec.Struct, frozen=True):
    """Values about the time at which an alarm was raised."""

    alarm_id: str
    raised_ns: int
    rule: str
    text: str
    motionless_s: Series
    temperature_degc: Series
    height_m: Series  # above the origin of the incident frame
    received_ns: tuple[int, ...]  # messages that came live
    thresholds: tuple[tuple[str, float], ...]  # of the rule, at that time


class UnitEntry(msgspec.Struct, frozen=True):
    unit_id: str
    software_version: str
    tracker: str
    calibration: str


class ImportEntry(msgspec.Struct, frozen=True):
    """File that was imported into the incident."""

    file_name: str
    format: str
    during: Interval  # of its content
    shift_s: float
    t_ns: int  # when it was brought in
    by: str
    sha256: str


class PhotoEntry(msgspec.Struct, frozen=True):
    """Photograph that was imported into the incident."""

    file_name: str
    taken_ns: int  # station time
    place: tuple[float, float] | None  # latitude and longitude in degrees (WGS-84)
    t_ns: int  # when it was brought in
    by: str
    jpeg: bytes  # scaled down; empty: it cannot be shown
    fault: str  # why, as a sentence


class Photographs(msgspec.Struct, frozen=True):
    entries: tuple[PhotoEntry, ...]  # the oldest ones
    left_out: int


class ReportContents(msgspec.Struct, frozen=True):
    incident_id: str
    name: str
    during: Interval
    is_open: bool
    opened_by: str
    closed_by: str
    dispatch: str  # from which it was opened, in words; empty: from none
    timeline: tuple[TimelineEntry, ...]
    orders: tuple[OrderEntry, ...]
    people: tuple[PersonEntry, ...]
    alarms: int  # raised in the incident
    traces: tuple[AlarmTrace, ...]
    traces_left_out: int
    plan: Plan | None
    has_anchor: bool
    assessment: IncidentReport | None  # None: not worked out
    imports: tuple[ImportEntry, ...]
    photographs: Photographs
    defects: tuple[str, ...]
    thresholds: tuple[tuple[str, float, float], ...]  # name, in force at the end, default
    par_interval_s: float  # at the end
    work_limit_s: float
    units: tuple[UnitEntry, ...]
    version: str
