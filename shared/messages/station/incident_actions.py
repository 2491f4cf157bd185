"""Actions on incidents: their life, their members, dispatches and imported files."""

from __future__ import annotations

import msgspec

from shared.coded_text import TextCode


class OpenIncident(msgspec.Struct, frozen=True):
    incident_id: str
    name: str
    par_interval_s: float = 0.0  # 0: the usual
    work_limit_s: float = 0.0
    dispatch_number: str = ""  # of the dispatch from which it is opened; empty: of none
    beside_others: bool = False  # although others are open; else it is refused then


class CloseIncident(msgspec.Struct, frozen=True):
    """Over the alarms and the people inside that are named, knowingly: a record, no condition."""

    incident_id: str
    despite_alarm_ids: tuple[str, ...] = ()
    despite_unit_ids: tuple[str, ...] = ()


class AssignIncident(msgspec.Struct, frozen=True):
    """These units and their wearers work in this open incident, and in no other; empty: in none."""

    incident_id: str
    unit_ids: tuple[str, ...]


class NoteDispatch(msgspec.Struct, frozen=True):
    """Report of the dispatch centre about an incident; a later one with the number replaces it."""

    number: str
    source: str  # format in which it came: "eido" or "json"
    type: str = ""  # of the incident, in words
    type_code: str = ""  # as the dispatch centre has it
    priority: str = ""
    address: str = ""
    lat_deg: float | None = None
    lon_deg: float | None = None
    units: tuple[str, ...] = ()  # call signs of vehicles or crews
    called_ns: int = 0  # UTC: the call was taken; 0: unknown
    dispatched_ns: int = 0
    updated_ns: int = 0  # when the dispatch centre changed it last
    remarks: str = ""
    has_ended: bool = False  # the dispatch centre has closed or cancelled it
    warnings: tuple[str, ...] = ()  # about parts of the report that were left out
    warning_codes: tuple[TextCode, ...] = ()  # of ``warnings``, in their order


class DismissDispatch(msgspec.Struct, frozen=True):
    """This dispatch opens no incident here."""

    number: str


class ImportFile(msgspec.Struct, frozen=True):
    """A file from elsewhere becomes part of an incident; it stands beside the log."""

    incident_id: str
    import_id: str  # by its content: the same file has the same one
    file_name: str  # as it was called where it comes from
    format: str  # "gpx", "kml", "photo" or "incident"
    sha256: str
    size_bytes: int
    shift_s: float  # added to its times
    first_ns: int  # times of what is in it, shifted
    last_ns: int


class RemoveImport(msgspec.Struct, frozen=True):
    """The file is taken out of the incident again, and removed."""

    incident_id: str
    import_id: str
