"""Emergency Incident Data Objects of NENA (NENA-STA-021.1, in JSON).

Versions write names in different cases, and one component or a list of them: both are read.  Of the
people, vehicles and calls of an EIDO only the time of the first call is used: the station does not
need the names and numbers of callers.
"""

from __future__ import annotations

import html
import re
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from base_station.dispatch.location import Location, read_location
from base_station.dispatch.report_parts import REMARKS_CHARACTERS, ReportParts
from shared.coded_text import coded
from shared.messages.station import NoteDispatch

_URN = "urn:emergency:uid:incidentid:"
_ENDED = {"closed", "cancelled", "canceled", "completed"}
_TAG = re.compile(r"<[^>]*>")
_OF_OTHERS = {"caller", "routinglocation"}  # where the call came from, not the incident

Component = Mapping[str, Any]  # names in lower case


def is_eido(body: Mapping[str, Any]) -> bool:
    names = {name.lower() for name in body}
    return bool(names & {"eidoversion", "incidentcomponent", "incidenttrackingidentifier"})


def read_eido(body: Mapping[str, Any], parts: ReportParts) -> NoteDispatch:
    """Read an EIDO. Raises WireError if it names no incident."""
    eido = _lower(body)
    incident = next(iter(_components(eido, "incidentComponent")), {})
    tracking_id = eido.get("incidenttrackingidentifier") or eido.get("$id")
    own_id = str(tracking_id).removeprefix(_URN) if isinstance(tracking_id, str) else None
    number = parts.number(incident.get("internalincidentid") or own_id, "internalIncidentId / $id")
    address, lat_deg, lon_deg = _place(eido, incident, parts)
    common = _texts(incident.get("incidenttypecommonregistrytext"))
    resources = _components(eido, "emergencyResourceComponent")
    names = [
        one.get("emergencyresourcename") or one.get("enforcementunitname") for one in resources
    ]
    return NoteDispatch(
        number,
        "eido",
        type=parts.text(incident.get("incidenttypeinternaltext"), "incidentTypeInternalText"),
        type_code=parts.text(
            incident.get("incidenttypeinternalcode") or next(iter(common), None),
            "incidentTypeInternalCode",
        ),
        priority=parts.text(
            incident.get("incidentpriorityinternaltext")
            or incident.get("incidentcommonprioritynumber"),
            "incidentPriorityInternalText",
        ),
        address=address,
        lat_deg=lat_deg,
        lon_deg=lon_deg,
        units=parts.call_signs(names, "emergencyResourceName"),
        called_ns=_first_ns(eido, "callComponent", "callStartTimestamp", parts),
        dispatched_ns=_first_ns(eido, "dispatchComponent", "lastUpdateTimeStamp", parts),
        updated_ns=parts.time_ns(eido.get("lastupdatetimestamp"), "lastUpdateTimeStamp"),
        remarks=_remarks(eido, parts),
        has_ended=_has_ended(incident),
    )


def _place(
    eido: Component, incident: Component, parts: ReportParts
) -> tuple[str, float | None, float | None]:
    """Address and position from the first locations that have them, the incident's own first."""
    locations = [
        *_components(eido, "locationComponent"),
        *_components(eido, "locationInformationComponent"),
    ]
    own_ids = {one.get("$ref") for one in _components(incident, "locationReference")}
    locations.sort(key=lambda one: (one.get("$id") not in own_ids, _is_of_others(one)))
    address, position_deg = "", None
    for one in locations:
        found = _location(one, parts)
        if (found.address or found.position_deg) and _is_of_others(one):
            kind = one["locationtypedescriptionregistrytext"]
            parts.warn(
                coded(
                    "report-place-of-call",
                    "the place is that of the call ({kind}), not surely of the incident",
                    kind=kind,
                )
            )
        address = address or found.address
        position_deg = position_deg or found.position_deg
        if address and position_deg:
            break
    lat_deg, lon_deg = position_deg or (None, None)
    return parts.text(address, "civicAddress"), lat_deg, lon_deg


def _location(location: Component, parts: ReportParts) -> Location:
    value = location.get("locationbyvalue")
    if isinstance(value, str) and value.strip():
        return read_location(value, parts, "locationByValue")
    if location.get("locationbyreferenceurl"):
        parts.warn(
            coded(
                "report-place-elsewhere",
                "a location is given by an address of another server, and is not fetched",
            )
        )
    return Location()


def _is_of_others(location: Component) -> bool:
    kind = location.get("locationtypedescriptionregistrytext")
    return isinstance(kind, str) and kind.replace(" ", "").lower() in _OF_OTHERS


def _first_ns(eido: Component, component: str, name: str, parts: ReportParts) -> int:
    """The earliest time of these components; 0: unknown."""
    values = [one.get(name.lower()) for one in _components(eido, component)]
    times_ns = [parts.time_ns(value, f"{component}.{name}") for value in values]
    return min(filter(None, times_ns), default=0)


def _remarks(eido: Component, parts: ReportParts) -> str:
    """Notes without their HTML."""
    notes = [one.get("notesactioncomments") for one in _components(eido, "notesComponent")]
    texts = [html.unescape(_TAG.sub(" ", one)) for one in notes if isinstance(one, str)]
    return parts.text("; ".join(texts), "notesActionComments", REMARKS_CHARACTERS)


def _has_ended(incident: Component) -> bool:
    return any(
        one.lower() in _ENDED for one in _texts(incident.get("incidentstatuscommonregistrytext"))
    )


def _components(parent: Component, name: str) -> list[Component]:
    return [_lower(one) for one in _listed(parent.get(name.lower())) if isinstance(one, dict)]


def _texts(value: Any) -> Iterator[str]:
    return (one for one in _listed(value) if isinstance(one, str))


def _listed(value: Any) -> Sequence[Any]:
    if value is None:
        return ()
    return value if isinstance(value, list) else (value,)


def _lower(component: Mapping[str, Any]) -> dict[str, Any]:
    return {name.lower(): value for name, value in component.items()}
