"""An incident's tracks as a file for other programs."""

from __future__ import annotations

import msgspec
from fastapi import APIRouter, Response
from pydantic import BaseModel
from starlette.concurrency import run_in_threadpool

from base_station.accounts.principals import Principal
from base_station.api.authentication import Viewer
from base_station.api.current_tables import CurrentStation
from base_station.api.document import file_response
from base_station.api.forms import Id
from base_station.api.problems import Problem
from base_station.api.routes.incidents import incident_or_404
from base_station.api.routes.trails import TrailKind, trails_of
from base_station.api.services import Services
from base_station.exporters import EXPORTERS
from base_station.exporters.incident import incident_tracks
from shared.errors import StoreError

router = APIRouter(tags=["exports"])

_IN_WORDS = {
    TrailKind.RAW: "by the units' own paths alone",
    TrailKind.FUSED: "as it was shown",
    TrailKind.SMOOTHED: "as it is known afterwards",
}  # in a file that has a name


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
    kind: TrailKind = TrailKind.FUSED,
) -> Response:
    """``kind``: what was shown at the time, or the trails as they are known afterwards."""
    async with station.export_lock:
        return await run_in_threadpool(_export, incident_id, format_name, station, who, kind)


def _export(
    incident_id: str, format_name: str, station: Services, who: Principal, kind: TrailKind
) -> Response:
    exporter = next((one for one in EXPORTERS if one.name == format_name), None)
    if exporter is None:
        known = ", ".join(one.name for one in EXPORTERS)
        raise Problem(404, f"There is no format {format_name}; formats are {known}.")
    incident = incident_or_404(station, incident_id)
    _, trails = trails_of(station, incident, kind)
    tracks = incident_tracks(station.records, station.roster, incident, trails)
    body = exporter.export(
        msgspec.structs.replace(tracks, name=f"{tracks.name}, {_IN_WORDS[kind]}")
    )
    try:
        station.records.audit(
            who.username, "Exported", f"{incident_id} ({kind.value}) as {format_name}"
        )
    except StoreError as error:
        raise Problem(503, f"Nothing is given out that the audit cannot say: {error}.") from error
    which = "" if kind is TrailKind.FUSED else f"-{kind.value}"
    file_name = f"{incident_id}{which}.{exporter.suffix}"
    headers = {"Content-Disposition": f'attachment; filename="{file_name}"'}
    return Response(body, media_type=exporter.media_type, headers=headers)
