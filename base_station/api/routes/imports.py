"""Files from elsewhere in an incident: tracks, photographs, another station's incident."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

from fastapi import APIRouter, Query, Request, Response
from fastapi.responses import FileResponse
from pydantic import BaseModel
from starlette.concurrency import run_in_threadpool

from base_station.api.authentication import Commander, Viewer
from base_station.api.current_tables import CurrentStation
from base_station.api.document import file_response
from base_station.api.forms import Id, Name
from base_station.api.problems import Problem
from base_station.api.routes.incidents import incident_or_404
from base_station.api.routes.trails import EverySeconds, Point
from base_station.api.services import Services
from base_station.importers.import_service import ImportService, anchor_of, require_anchor
from base_station.importers.interface import MOST_BYTES, ImportOptions
from base_station.importers.placement import placed
from base_station.storage.db.imports import ImportCatalogue
from base_station.storage.db.models import ImportRow, IncidentRow
from base_station.storage.imports import ImportedContent
from base_station.views.answer import Answer, to_ms
from base_station.views.text_code import text_code_view
from base_station.views.wire import TextCodeView
from shared.coded_text import coded, text_of_error
from shared.errors import UserError
from shared.geo import Anchor
from shared.messages.station import RemoveImport

router = APIRouter(tags=["incidents"])

_NO_IMPORT = coded("import-not-there", "Nothing of that id was brought into this incident.")
_NOT_HERE = coded(
    "import-elsewhere", "The file is not at this station: it was brought in at the other one."
)
_ROOM_STEP_BYTES = 16 << 20
_BODY = {"requestBody": {"required": True, "content": {"application/octet-stream": {}}}}
_MOST_SHIFT_S = 10 * 366 * 86_400.0
ShiftS = Annotated[float, Query(ge=-_MOST_SHIFT_S, le=_MOST_SHIFT_S, allow_inf_nan=False)]
UtcOffsetH = Annotated[float | None, Query(ge=-14.0, le=14.0, allow_inf_nan=False)]


class ImportAnswer(BaseModel):
    import_id: str
    file_name: str
    format: str
    sha256: str
    size_bytes: int
    shift_s: float
    from_ms: int
    until_ms: int
    t_ms: int
    by: str
    is_here: bool
    tracks: int
    names: list[str]  # of the first hundred tracks
    warnings: list[str]
    warning_codes: list[TextCodeView]


class ImportedTrackAnswer(Answer, frozen=True):
    name: str
    points: tuple[Point, ...]


class ImportedTracks(Answer, frozen=True):
    import_id: str
    format: str
    file_name: str
    picture_url: str | None
    tracks: tuple[ImportedTrackAnswer, ...]


@router.get("/incidents/{incident_id}/imports")
def list_imports(incident_id: Id, station: CurrentStation, _: Viewer) -> list[ImportAnswer]:
    """Files that were imported into the incident, oldest first."""
    incident_or_404(station, incident_id)
    catalogue = station.imports
    return [_answer(station, catalogue, row) for row in station.records.imports_of(incident_id)]


@router.post(
    "/incidents/{incident_id}/imports",
    status_code=201,
    max_body_size=MOST_BYTES,
    openapi_extra=_BODY,
)
async def add_import(
    incident_id: Id,
    file_name: Annotated[Name, Query()],
    station: CurrentStation,
    who: Commander,
    request: Request,
    shift_s: ShiftS = 0.0,
    utc_offset_h: UtcOffsetH = None,
) -> ImportAnswer:
    """Import a GPX or KML track, a photograph with a place and a time, or an incident of another
    station (MCAP). The file is kept unchanged.  Importing the same file again changes nothing and
    gives the same answer.
    """
    incident = incident_or_404(station, incident_id)
    catalogue = station.imports
    desk = _desk(station, incident, catalogue)
    options = ImportOptions(file_name, incident_id, shift_s, utc_offset_h)
    with catalogue.folder.incoming() as path:
        await run_in_threadpool(catalogue.folder.require_room, _length(request))
        with path.open("wb") as file:
            came = 0
            async for part in request.stream():
                if came // _ROOM_STEP_BYTES != (came + len(part)) // _ROOM_STEP_BYTES:
                    await run_in_threadpool(catalogue.folder.require_room, 0)
                came += len(part)
                await run_in_threadpool(file.write, part)
        async with station.import_lock:
            return await run_in_threadpool(_import_file, desk, path, options, station, who.username)


@router.delete("/incidents/{incident_id}/imports/{import_id}", status_code=204)
def remove_import(incident_id: Id, import_id: Id, station: CurrentStation, who: Commander) -> None:
    """Remove an imported file from the incident; the station deletes its copy."""
    catalogue = station.imports
    _row_or_404(catalogue, incident_id, import_id)
    station.perform(who.username, RemoveImport(incident_id, import_id))
    catalogue.folder.remove(incident_id, import_id)


@router.get("/incidents/{incident_id}/imports/{import_id}/tracks")
def imported_tracks(
    incident_id: Id,
    import_id: Id,
    station: CurrentStation,
    _: Viewer,
    every_s: EverySeconds = 1,
) -> ImportedTracks:
    """Tracks of an imported file, in metres on the incident's plan; a photograph is a track of one
    point.
    """
    incident = incident_or_404(station, incident_id)
    catalogue = station.imports
    row = _row_or_404(catalogue, incident_id, import_id)
    content = _content_or_404(catalogue, row)
    anchor = _anchor(station, incident)
    address = f"/api/v1/incidents/{incident_id}/imports/{import_id}/picture"
    return ImportedTracks(
        import_id,
        row.format,
        station.roster.shown(row.file_name),
        None if content.picture is None else address,
        tuple(
            ImportedTrackAnswer(track.name, placed(track, anchor, every_s))
            for track in content.tracks
        ),
    )


@router.get(
    "/incidents/{incident_id}/imports/{import_id}/picture",
    response_class=Response,
    responses=file_response("image/jpeg"),
)
def imported_picture(
    incident_id: Id, import_id: Id, station: CurrentStation, _: Viewer
) -> Response:
    """Imported photograph, reduced in size and without its metadata."""
    catalogue = station.imports
    row = _row_or_404(catalogue, incident_id, import_id)
    content = _content_or_404(catalogue, row)
    if content.picture is None:
        raise Problem(404, coded("import-no-photograph", "This file is no photograph."))
    headers = {"Cache-Control": "private, max-age=86400", "ETag": f'"{import_id}"'}
    return Response(content.picture, media_type="image/jpeg", headers=headers)


@router.get(
    "/incidents/{incident_id}/imports/{import_id}/file",
    response_class=Response,
    responses=file_response("application/octet-stream"),
)
def imported_file(incident_id: Id, import_id: Id, station: CurrentStation, who: Viewer) -> Response:
    """Imported file, unchanged to the byte."""
    catalogue = station.imports
    row = _row_or_404(catalogue, incident_id, import_id)
    path = catalogue.folder.original(incident_id, import_id)
    if path is None:
        raise Problem(404, _NOT_HERE)
    station.records.audit(who.username, "Exported", f"{incident_id}, imported file {import_id}")
    return FileResponse(
        path,
        media_type="application/octet-stream",
        filename=station.roster.shown(row.file_name),
        headers={"X-Content-Type-Options": "nosniff"},
    )


def _desk(station: Services, incident: IncidentRow, catalogue: ImportCatalogue) -> ImportService:
    try:
        anchor = require_anchor(station.records, incident)
    except UserError as error:
        raise Problem(409, text_of_error(error)) from error
    return ImportService(catalogue, incident, anchor, station.clock.utc_ns())


def _anchor(station: Services, incident: IncidentRow) -> Anchor:
    anchor = anchor_of(station.records, incident)
    if anchor is None:
        raise Problem(
            409, coded("import-no-place", "The incident's site has no place on the Earth.")
        )
    return anchor


def _row_or_404(catalogue: ImportCatalogue, incident_id: str, import_id: str) -> ImportRow:
    row = catalogue.entry(incident_id, import_id)
    if row is None:
        raise Problem(404, _NO_IMPORT)
    return row


def _content_or_404(catalogue: ImportCatalogue, row: ImportRow) -> ImportedContent:
    content = catalogue.folder.content(row.incident_id, row.import_id)
    if content is None:
        raise Problem(404, _NOT_HERE)
    return content


def _length(request: Request) -> int:
    text = request.headers.get("content-length", "")
    return int(text) if text.isdecimal() else 0


def _import_file(
    desk: ImportService, path: Path, options: ImportOptions, station: Services, by: str
) -> ImportAnswer:
    try:
        import_id = desk.import_file(path, options, lambda action: station.perform(by, action))
    except UserError as error:
        raise Problem(422, text_of_error(error)) from error
    station.projection.flush()
    row = desk.catalogue.entry(options.incident_id, import_id)
    if row is None:
        raise Problem(
            503,
            coded(
                "import-not-stored-yet",
                "The file was brought in, but the database has not taken it yet.",
            ),
        )
    return _answer(station, desk.catalogue, row)


def _answer(station: Services, catalogue: ImportCatalogue, row: ImportRow) -> ImportAnswer:
    summary = catalogue.folder.summary(row.incident_id, row.import_id)
    return ImportAnswer(
        import_id=row.import_id,
        file_name=station.roster.shown(row.file_name),
        format=row.format,
        sha256=row.sha256,
        size_bytes=row.size_bytes,
        shift_s=row.shift_s,
        from_ms=to_ms(row.first_ns),
        until_ms=to_ms(row.last_ns),
        t_ms=to_ms(row.t_ns),
        by=row.by,
        is_here=summary is not None,
        tracks=0 if summary is None else summary.tracks,
        names=[] if summary is None else list(summary.names),
        warnings=[] if summary is None else list(summary.warnings),
        warning_codes=[] if summary is None else list(map(text_code_view, summary.warning_codes)),
    )
