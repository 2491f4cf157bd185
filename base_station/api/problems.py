"""Errors of the API as RFC 9457 problem documents whose ``detail`` is a sentence for a person."""

from __future__ import annotations

import logging
from collections.abc import Mapping
from http import HTTPStatus

from fastapi import FastAPI, Request
from fastapi.exceptions import RequestValidationError
from fastapi.responses import JSONResponse
from pydantic import BaseModel
from starlette.exceptions import HTTPException
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from base_station.api.field_errors import sentence_of
from base_station.api.forms import MOST_BYTES, MOST_UPLOADED_BYTES
from shared.errors import ConfigError, LogError, MusterError, StoreError, UserError

_log = logging.getLogger(__name__)
_TOO_LARGE = (
    f"This is too large: a picture, a plan or a map may have {MOST_UPLOADED_BYTES // 10**6} MB, "
    f"anything else {MOST_BYTES // 10**3} kB."
)


class ProblemDocument(BaseModel):
    """RFC 9457."""

    type: str
    title: str
    status: int
    detail: str


class Problem(HTTPException):
    """Ends a request with a status and a sentence."""


def problem_response(
    status: int, detail: str, headers: Mapping[str, str] | None = None
) -> JSONResponse:
    document = ProblemDocument(
        type="about:blank", title=HTTPStatus(status).phrase, status=status, detail=detail
    )
    return JSONResponse(
        document.model_dump(),
        status_code=status,
        headers=headers,
        media_type="application/problem+json",
    )


def handle_problems(app: FastAPI) -> None:
    """Every error of a route becomes a problem document; for others see ``Mistakes``."""

    @app.exception_handler(HTTPException)
    async def refused(request: Request, error: HTTPException) -> JSONResponse:
        unread = error.status_code == 400 and not isinstance(error, Problem)
        detail = _what_to_send(request) if unread else str(error.detail)
        return problem_response(error.status_code, detail, error.headers)

    @app.exception_handler(RequestValidationError)
    async def invalid(request: Request, error: RequestValidationError) -> JSONResponse:
        sentences = (
            _what_to_send(request)
            if one["loc"] == ("body",) or one["type"] == "json_invalid"
            else sentence_of(one)
            for one in error.errors()
        )
        return problem_response(422, "; ".join(sentences))

    @app.exception_handler(MusterError)
    async def failed(request: Request, error: MusterError) -> JSONResponse:
        status = _status_of(error)
        if status >= 500:  # nobody's mistake but the station's
            _log.warning("%s %s: %s", request.method, request.url.path, error)
        return problem_response(status, str(error))


class Mistakes:
    """ASGI middleware: what nobody foresaw is answered like every problem, and logged.

    The framework's own handler stands outside of all other middleware, whose headers it misses.
    """

    def __init__(self, app: ASGIApp) -> None:
        self._app = app

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        begun = False

        async def noting(message: Message) -> None:
            nonlocal begun
            begun = True
            await send(message)

        try:
            await self._app(scope, receive, noting)
        except Exception as error:
            if scope["type"] != "http" or begun:
                raise
            _log.error("%s %s failed", scope["method"], scope["path"], exc_info=error)
            answer = problem_response(500, "The station made a mistake; its log says which.")
            await answer(scope, receive, send)


class TooLarge:
    """ASGI middleware: a body that is larger than a route takes is answered like every problem,
    whatever the limiter below says of it.
    """

    def __init__(self, app: ASGIApp) -> None:
        self._app = app

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        refused = False

        async def saying_so(message: Message) -> None:
            nonlocal refused
            if message["type"] == "http.response.start" and message["status"] == 413:
                refused = True
                await problem_response(413, _TOO_LARGE)(scope, receive, send)
            elif not refused:
                await send(message)

        await self._app(scope, receive, saying_so)


def _status_of(error: MusterError) -> int:
    match error:
        case UserError():
            return 409
        case ConfigError():
            return 422
        case StoreError() | LogError():
            return 503
        case _:
            return 500


def _what_to_send(request: Request) -> str:
    """For who sent no body, or one that the framework could not read."""
    route = request.scope["route"]
    kind = route.body_field.field_info.media_type
    if kind == "application/json":
        return f"send one JSON object as the body, with the header Content-Type: {kind}"
    return f"send the file itself as the body, with the header Content-Type: {kind} or its like"
