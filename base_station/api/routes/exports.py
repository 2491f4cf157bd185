"""An incident as a file for other programs: its tracks, or all of it."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator, Iterator
from itertools import chain
from typing import Annotated

from fastapi import APIRouter, Depends, Query, Request, Response
from fastapi.responses import StreamingResponse
from pydantic import BaseModel
from starlette.concurrency import run_in_threadpool

from base_station.accounts.principals import Principal, Role
from base_station.api.authentication import Viewer, scope_covers
from base_station.api.current_tables import CurrentStation
from base_station.api.document import file_response
from base_station.api.forms import Id, Name, window
from base_station.api.problems import Problem
from base_station.api.routes.incidents import incident_or_404
from base_station.api.routes.trails import trails_of
from base_station.api.services import Services, audit_given_out
from base_station.exporters import EXPORTERS, exporter_of
from base_station.exporters.compression import SUFFIX, gzipped
from base_station.exporters.incident import incident_tracks
from base_station.exporters.interface import Exporter
from base_station.exporters.selection import TrackSelection
from base_station.replay.incident_file import IncidentFileSource, incident_file
from base_station.replay.trail_kind import TrailKind
from base_station.storage.db.window import Window
from shared.coded_text import coded, text_of_error
from shared.errors import UserError

router = APIRouter(tags=["exports"])

Names = Annotated[tuple[Name, ...], Query(max_length=200)]


class Format(BaseModel):
    name: str
    suffix: str
    needs_anchor: bool


@router.get("/export-formats")
def list_formats(_: Viewer) -> list[Format]:
    return [
        Format(name=one.name, suffix=one.suffix, needs_anchor=one.needs_anchor) for one in EXPORTERS
    ]


@router.get(
    "/incidents/{incident_id}/export/{format_name}",
    response_class=Response,
    responses=file_response("*/*"),
)
async def export_incident(
    incident_id: Id,
    format_name: Id,
    station: CurrentStation,
    who: Viewer,
    when: Annotated[Window, Depends(window)],
    request: Request,
    kind: TrailKind = TrailKind.FUSED,
    only: Names = (),
    gzip: bool = False,
) -> Response:
    """Write the trails of an incident in a file format.  ``kind``: trails as shown at the time, or
    as known afterwards; ``only``: units, people or crews, otherwise everyone; ``gzip``: write a
    compressed file.  Without it the answer is still compressed on its way to clients that accept
    this.
    """
    selection = TrackSelection(only, when.from_ns, when.until_ns)
    async with station.export_lock:
        exporter, content = await run_in_threadpool(
            _begun, incident_id, format_name, station, who, kind, selection
        )
    name = kind.file_name(incident_id, exporter.suffix)
    headers = {"Vary": "Accept-Encoding"}
    media_type = exporter.media_type
    if gzip:
        name, media_type, content = f"{name}{SUFFIX}", "application/gzip", gzipped(content)
    elif not exporter.is_compressed and _accepts_gzip(request.headers.get("Accept-Encoding", "")):
        headers["Content-Encoding"], content = "gzip", gzipped(content)
    headers["Content-Disposition"] = f'attachment; filename="{name}"'
    in_turn = _in_turn(content, station.export_lock)
    return StreamingResponse(in_turn, media_type=media_type, headers=headers)


@router.get(
    "/incidents/{incident_id}/incident.mcap",
    response_class=Response,
    responses=file_response("application/octet-stream"),
)
async def export_whole_incident(
    incident_id: Id, station: CurrentStation, who: Viewer, radio: bool = False
) -> Response:
    """Write the whole incident as one MCAP file that stands alone: records, what consoles showed,
    decisions, plan, pins, thresholds, people and imported files.  ``radio``: with the audio of the
    radio channels, for a commander.  ``muster base replay FILE`` shows it.
    """
    if radio and (who.role < Role.COMMANDER or not scope_covers(who, ("radio",))):
        raise Problem(
            403,
            coded(
                "radio-for-commanders",
                "The audio of the radio is for commanders, and tokens with scope radio.",
            ),
        )
    async with station.export_lock:
        content = await run_in_threadpool(_whole, incident_id, station, who, with_radio=radio)
    headers = {"Content-Disposition": f'attachment; filename="{incident_id}.mcap"'}
    in_turn = _in_turn(content, station.export_lock)
    return StreamingResponse(in_turn, media_type="application/octet-stream", headers=headers)


def _whole(
    incident_id: str, station: Services, who: Principal, *, with_radio: bool
) -> Iterator[bytes]:
    incident = incident_or_404(station, incident_id)
    if station.log_of is None:
        raise Problem(503, coded("export-no-log", "This station has no log to make it from."))
    until_ns = station.clock.utc_ns()
    source = IncidentFileSource(
        log=station.log_of(incident),
        incident=incident,
        name=station.roster.shown(incident.name),
        people=station.roster.known_people(),
        plan=station.records.plan(incident.closed_ns or until_ns),
        until_ns=until_ns,
        imports=station.imports.attachments(incident_id),
        radio=station.radio if with_radio else None,
    )
    content = incident_file(source)
    first = next(content)
    with_audio = ", with the audio of the radio" if with_radio else ""
    _audit(station, who, f"{incident_id} as a file that stands alone{with_audio}")
    return chain((first,), content)


def _audit(station: Services, who: Principal, what: str) -> None:
    audit_given_out(station, who.username, "Exported", what)


def _begun(
    incident_id: str,
    format_name: str,
    station: Services,
    who: Principal,
    kind: TrailKind,
    selection: TrackSelection,
) -> tuple[Exporter, Iterator[bytes]]:
    """Return the exporter and its tracks; raises every problem that the request can have."""
    try:
        exporter = exporter_of(format_name)
    except UserError as error:
        raise Problem(404, text_of_error(error)) from error
    incident = incident_or_404(station, incident_id)
    _, trails = trails_of(station, incident, kind)
    tracks = incident_tracks(station.records, station.roster, incident, trails)
    content = exporter.begun(selection.of(tracks).named_as(kind.in_words))
    _audit(station, who, f"{incident_id} ({kind.value}) as {format_name}")
    return exporter, content


def _accepts_gzip(accept_encoding: str) -> bool:
    """True where ``gzip`` is named (RFC 9110, section 12.5.3) and not with a weight of 0."""
    for offer in accept_encoding.lower().split(","):
        coding, _, weight = offer.replace(" ", "").partition(";q=")
        if coding == "gzip":
            return weight.strip("0.") != "" or not weight
    return False


async def _in_turn(content: Iterator[bytes], lock: asyncio.Lock) -> AsyncIterator[bytes]:
    """Make the parts of all exports one at a time; a slow client delays no other."""
    while True:
        async with lock:
            part = await run_in_threadpool(next, content, None)
        if part is None:
            return
        yield part
