"""The report on an incident as a file."""

from __future__ import annotations

from fastapi import APIRouter, Response
from starlette.concurrency import run_in_threadpool

from base_station.accounts.principals import Principal
from base_station.api.authentication import Viewer
from base_station.api.current_tables import CurrentStation
from base_station.api.document import file_response
from base_station.api.forms import Id
from base_station.api.problems import Problem
from base_station.api.routes.incidents import incident_or_404
from base_station.api.services import Services
from shared.coded_text import coded, text_of_error
from shared.errors import StoreError

router = APIRouter(tags=["exports"])

_HTML, _PDF = "text/html; charset=utf-8", "application/pdf"


@router.get(
    "/incidents/{incident_id}/report.html",
    response_class=Response,
    responses=file_response("text/html"),
)
async def report_as_html(incident_id: Id, station: CurrentStation, who: Viewer) -> Response:
    """Report on the incident as one HTML page: summary, timeline, orders, plan with trails, people
    and alarms.
    """
    async with station.export_lock:
        return await run_in_threadpool(_report, incident_id, station, who, as_pdf=False)


@router.get(
    "/incidents/{incident_id}/report.pdf",
    response_class=Response,
    responses=file_response("application/pdf"),
)
async def report_as_pdf(incident_id: Id, station: CurrentStation, who: Viewer) -> Response:
    """Report on the incident as a PDF. 503 if the station lacks the library that writes it."""
    async with station.export_lock:
        return await run_in_threadpool(_report, incident_id, station, who, as_pdf=True)


def _report(incident_id: str, station: Services, who: Principal, *, as_pdf: bool) -> Response:
    incident = incident_or_404(station, incident_id)
    if station.reports is None:
        raise Problem(
            503,
            coded(
                "report-by-terminal",
                "Make it with the terminal: muster base report {incident}.",
                incident=incident_id,
            ),
        )
    suffix, media_type = ("pdf", _PDF) if as_pdf else ("html", _HTML)
    try:
        content = station.reports.make(incident, as_pdf=as_pdf)
        station.records.audit(who.username, "Exported", f"{incident_id} as report, {suffix}")
    except StoreError as error:
        raise Problem(
            503, coded("report-none", "There is no report: {reason}.", reason=text_of_error(error))
        ) from error
    headers = {"Content-Disposition": f'attachment; filename="{incident_id}-report.{suffix}"'}
    return Response(content, media_type=media_type, headers=headers)
