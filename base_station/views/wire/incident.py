"""Views of an incident and of a report of the dispatch centre."""

from __future__ import annotations

from base_station.views.answer import Answer
from base_station.views.wire.text_code import TextCodeView


class DispatchView(Answer, frozen=True):
    """Newest report of the dispatch centre about an incident."""

    number: str
    source: str  # eido | json
    type: str  # of the incident, in words
    type_code: str
    priority: str
    address: str
    lat_deg: float | None
    lon_deg: float | None
    units: tuple[str, ...]  # call signs
    called_ms: int | None
    dispatched_ms: int | None
    updated_ms: int | None
    remarks: str
    has_ended: bool
    warnings: tuple[str, ...]  # about parts that were left out
    received_ms: int | None = None  # None: it has opened an incident
    is_dismissed: bool = False
    warning_codes: tuple[TextCodeView, ...] = ()  # of ``warnings``, in their order


class IncidentView(Answer, frozen=True):
    incident_id: str
    name: str
    opened_ms: int
    closed_ms: int | None
    par_interval_s: float  # each member is to be confirmed this often
    par_warning_s: float  # how long before it is due a check-in is announced
    work_limit_s: float
    dispatch: DispatchView | None = None  # from which it was opened
    site_id: str = ""  # its ground: empty, the station's own
