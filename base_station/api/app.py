"""Puts the API together."""

from __future__ import annotations

import asyncio
import logging
from collections.abc import AsyncIterator, Callable
from contextlib import asynccontextmanager

from fastapi import Depends, FastAPI
from starlette.middleware.body_limit import RequestBodyLimitMiddleware

from base_station.api.admission import AdmissionMiddleware, LoginQueue
from base_station.api.authentication import check_leads, check_origin
from base_station.api.connections import KnownNetworks
from base_station.api.console_files import serve_console
from base_station.api.document import complete_document, operation_id
from base_station.api.forms import MAX_BYTES
from base_station.api.guidance import STEP_S, Guidance
from base_station.api.head_requests import HeadRequestMiddleware
from base_station.api.headers import SecurityHeadersMiddleware
from base_station.api.login_throttle import LoginThrottle
from base_station.api.problems import (
    BodyTooLargeMiddleware,
    UnhandledErrorMiddleware,
    handle_problems,
)
from base_station.api.route_table import DOCUMENT_PATH, PREFIX, allowed_methods, check_query
from base_station.api.routes import ROUTERS
from base_station.api.services import LoginServices, Services
from base_station.api.uploads import UploadTurns
from shared.errors import MusterError

_REPLAY_CHECK_S = 5.0

log = logging.getLogger(__name__)


def create_app(services: Services, started: Callable[[asyncio.AbstractEventLoop], None]) -> FastAPI:
    """Application with all routes of the station.  ``started`` is called once in the event loop,
    when the API begins.
    """

    @asynccontextmanager
    async def lifespan(app: FastAPI) -> AsyncIterator[None]:
        loop = asyncio.get_running_loop()
        app.state.loop = loop
        started(loop)
        closing_unwatched = asyncio.create_task(_close_unwatched_replays(services))
        guiding = asyncio.create_task(_guide_rescuers(services, guidance))
        yield
        closing_unwatched.cancel()
        guiding.cancel()
        queue.close()
        await asyncio.to_thread(services.replays.close_all)

    app = FastAPI(
        title="Muster",
        version="1",
        lifespan=lifespan,
        openapi_url=DOCUMENT_PATH,
        docs_url=None,  # its pages would load from elsewhere
        redoc_url=None,
        generate_unique_id_function=operation_id,
        dependencies=[Depends(check_query), Depends(check_origin), Depends(check_leads)],
        telemetry={"tracing": False, "metrics": False, "logs": False, "auto_configure": False},
    )
    queue = add_request_handling(app, services)
    guidance = app.state.guidance = Guidance()
    app.state.upload_turns = UploadTurns()
    handle_problems(app, allowed_methods)
    for router in ROUTERS:
        app.include_router(router, prefix=PREFIX)
    complete_document(app)
    serve_console(app)
    return app


def add_request_handling(app: FastAPI, services: LoginServices) -> LoginQueue:
    """Add the middleware that all routes need, those of a station and of a department.  Returns the
    queue of logins, which the caller closes at the end.
    """
    app.state.services = services
    throttle = app.state.login_throttle = LoginThrottle()
    queue = LoginQueue()
    app.state.login_queue = queue
    app.state.known_networks = KnownNetworks()
    ha_status = services.ha_status
    app.add_middleware(UnhandledErrorMiddleware)
    # The framework's own limit stands outside of the middleware for problems and headers.
    app.add_middleware(RequestBodyLimitMiddleware, max_body_size=MAX_BYTES)
    app.add_middleware(BodyTooLargeMiddleware)
    app.add_middleware(AdmissionMiddleware, throttle=throttle, queue=queue)
    app.add_middleware(HeadRequestMiddleware)
    app.add_middleware(  # the last one is the outer one
        SecurityHeadersMiddleware,
        secure=services.secure,
        other_console=lambda: "" if ha_status is None else ha_status.view().other_url,
    )
    return queue


async def _close_unwatched_replays(services: Services) -> None:
    while True:
        await asyncio.sleep(_REPLAY_CHECK_S)
        await asyncio.to_thread(services.replays.close_unwatched)


async def _guide_rescuers(services: Services, guidance: Guidance) -> None:
    while True:
        await asyncio.sleep(STEP_S)
        try:
            await asyncio.to_thread(guidance.step, services)
        except MusterError as error:
            log.warning("rescuers are not guided: %s", error)
