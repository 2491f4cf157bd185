"""API of a department, and its page; accounts are those of a station."""

from __future__ import annotations

from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from dataclasses import dataclass
from typing import Annotated

from fastapi import APIRouter, Depends, FastAPI, Query, Request
from pydantic import Field
from starlette.requests import HTTPConnection

from base_station.api.app import add_request_handling
from base_station.api.authentication import Commander, Viewer, check_leads, check_origin
from base_station.api.console_files import serve_console
from base_station.api.document import operation_id
from base_station.api.forms import Form, Limit
from base_station.api.problems import Problem, handle_problems
from base_station.api.route_table import DOCUMENT_PATH, PREFIX
from base_station.api.routes import login, users
from base_station.api.services import LoginServices
from base_station.department.answers import (
    DepartmentEventView,
    DepartmentIncidentsView,
    DepartmentPeopleView,
    DepartmentView,
    StartedReplay,
)
from base_station.department.archive_replays import ArchiveReplays
from base_station.department.views import DepartmentViews, PeopleQuery
from shared.coded_text import coded

_SEARCH_MAX = 80

router = APIRouter(prefix="/department", tags=["live"])


@dataclass(frozen=True, kw_only=True)
class DepartmentServices(LoginServices):
    views: DepartmentViews
    replays: ArchiveReplays


def _views_of(connection: HTTPConnection) -> DepartmentViews:
    services: DepartmentServices = connection.app.state.services
    return services.views


Views = Annotated[DepartmentViews, Depends(_views_of)]
Filter = Annotated[str, Query(max_length=_SEARCH_MAX)]


class PastIncident(Form):
    """An incident that a station has closed."""

    station: Annotated[str, Field(max_length=_SEARCH_MAX)]
    incident_id: Annotated[str, Field(max_length=_SEARCH_MAX)]


@router.get("")
def get_department(views: Views, _: Viewer) -> DepartmentView:
    """All stations, incidents and open alarms of the department."""
    return views.overview()


@router.get("/incidents")
def list_department_incidents(
    views: Views,
    _: Viewer,
    search: Filter = "",
    skip: Annotated[int, Query(ge=0)] = 0,
    limit: Limit = 100,
) -> DepartmentIncidentsView:
    """Incidents of all stations, also of years ago: open ones first, then the newest."""
    return views.incidents(search, skip, limit)


@router.get("/people")
def list_department_people(
    views: Views,
    _: Viewer,
    station: Filter = "",
    incident_id: Filter = "",
    search: Filter = "",
    skip: Annotated[int, Query(ge=0)] = 0,
    limit: Limit = 100,
) -> DepartmentPeopleView:
    """People of the department, who need help first."""
    return views.people(PeopleQuery(station, incident_id, search, skip, limit))


@router.get("/events")
def list_department_events(
    views: Views,
    _: Viewer,
    before: Annotated[int | None, Query(ge=1)] = None,
    limit: Limit = 100,
) -> list[DepartmentEventView]:
    """Events that stations have reported, in the order of arrival, the newest first."""
    return list(views.events(before, limit))


@router.post("/replays")
def open_past_incident(
    wanted: PastIncident, connection: Request, views: Views, _: Commander
) -> StartedReplay:
    """Show a past incident from the archive; answered when browsers can connect."""
    if not views.has_archive:
        raise Problem(
            404,
            coded(
                "department-no-archive",
                "This department has no archive: set location in [archive].",
            ),
        )
    if not views.is_past(wanted.station, wanted.incident_id):
        raise Problem(
            404,
            coded("department-not-closed", "No station has reported that this incident is closed."),
        )
    services: DepartmentServices = connection.app.state.services
    return services.replays.open(wanted.station, wanted.incident_id)


def create_department_app(services: DepartmentServices) -> FastAPI:
    @asynccontextmanager
    async def lifespan(_: FastAPI) -> AsyncIterator[None]:
        yield
        queue.close()

    app = FastAPI(
        title="Muster department",
        version="1",
        lifespan=lifespan,
        openapi_url=DOCUMENT_PATH,
        docs_url=None,  # its pages would load from elsewhere
        redoc_url=None,
        generate_unique_id_function=operation_id,
        dependencies=[Depends(check_origin), Depends(check_leads)],
        telemetry={"tracing": False, "metrics": False, "logs": False, "auto_configure": False},
    )
    queue = add_request_handling(app, services)
    handle_problems(app, lambda _: "")
    for one in (login.router, users.router, router):
        app.include_router(one, prefix=PREFIX)
    serve_console(app, "department.html")
    return app
