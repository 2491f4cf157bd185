"""Puts the API together."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator, Callable
from contextlib import asynccontextmanager

from fastapi import Depends, FastAPI
from starlette.middleware.body_limit import RequestBodyLimitMiddleware

from base_station.api.console_files import serve_console
from base_station.api.forms import MOST_BYTES
from base_station.api.headers import SecurityHeaders
from base_station.api.problems import Mistakes, ProblemDocument, TooLarge, handle_problems
from base_station.api.routes import ROUTERS
from base_station.api.security import LoginThrottle, check_origin, check_standing
from base_station.api.services import Services

PREFIX = "/api/v1"
_SWEEP_S = 5.0
_PROBLEMS = {
    code: {"model": ProblemDocument, "content": {"application/problem+json": {}}}
    for code in (400, 401, 403, 404, 409, 413, 422, 429, 503)
}


def create_app(services: Services, started: Callable[[asyncio.AbstractEventLoop], None]) -> FastAPI:
    """``started`` is called once in the event loop, when the API begins."""

    @asynccontextmanager
    async def lifespan(app: FastAPI) -> AsyncIterator[None]:
        loop = asyncio.get_running_loop()
        app.state.loop = loop
        started(loop)
        sweeping = asyncio.create_task(_end_unwatched_replays(services))
        yield
        sweeping.cancel()
        await asyncio.to_thread(services.replays.close_all)

    app = FastAPI(
        title="Muster",
        version="1",
        lifespan=lifespan,
        openapi_url=f"{PREFIX}/openapi.json",
        docs_url=None,  # its pages would load from elsewhere
        redoc_url=None,
        dependencies=[Depends(check_origin), Depends(check_standing)],
        telemetry={"tracing": False, "metrics": False, "logs": False, "auto_configure": False},
    )
    app.state.services = services
    app.state.login_throttle = LoginThrottle()
    standing = services.standing
    app.add_middleware(Mistakes)
    # The framework's own limit stands outside of what answers like a problem, with its headers.
    app.add_middleware(RequestBodyLimitMiddleware, max_body_size=MOST_BYTES)
    app.add_middleware(TooLarge)
    app.add_middleware(  # the last one is the outer one
        SecurityHeaders,
        secure=services.secure,
        other_console=lambda: "" if standing is None else standing.view().other_url,
    )
    handle_problems(app)
    for router in ROUTERS:
        app.include_router(
            router,
            prefix=PREFIX,
            responses=_PROBLEMS,  # type: ignore[arg-type]  # the stub wants str keys too
        )
    serve_console(app)
    return app


async def _end_unwatched_replays(services: Services) -> None:
    while True:
        await asyncio.sleep(_SWEEP_S)
        await asyncio.to_thread(services.replays.close_unwatched)
