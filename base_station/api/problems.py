"""Errors of the API as RFC 9457 problem documents whose ``detail`` is a sentence for a person."""

from __future__ import annotations

import logging
from collections.abc import Callable, Mapping
from http import HTTPStatus

from fastapi import FastAPI, Request
from fastapi.exceptions import RequestValidationError
from fastapi.responses import JSONResponse
from pydantic import BaseModel
from starlette.exceptions import HTTPException
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from base_station.api.field_errors import error_sentence, joined_sentences
from base_station.api.forms import (
    MAX_BYTES,
    MAX_DISPATCH_BYTES,
    MAX_SAMPLES_BYTES,
    MAX_UPLOAD_BYTES,
)
from shared.coded_text import Measure, code_of_text, coded, text_of_error
from shared.errors import ArchiveError, ConfigError, LogError, MusterError, StoreError, UserError

PROBLEM_MEDIA_TYPE = "application/problem+json"

_log = logging.getLogger(__name__)
_TOO_LARGE = coded(
    "body-too-large",
    "This is too large: a picture, a plan or a map may have {upload_mb}, samples {samples_mb}, a "
    "dispatch or an alert {dispatch_mb}, anything else {other_mb}.",
    upload_mb=Measure(MAX_UPLOAD_BYTES / 1e6, f"{MAX_UPLOAD_BYTES // 10**6} MB"),
    samples_mb=Measure(MAX_SAMPLES_BYTES / 1e6, f"{MAX_SAMPLES_BYTES // 10**6} MB"),
    dispatch_mb=Measure(MAX_DISPATCH_BYTES / 1e6, f"{MAX_DISPATCH_BYTES // 10**6} MB"),
    other_mb=Measure(MAX_BYTES / 1e6, f"{MAX_BYTES // 10**3} kB"),
)
_FAILED = coded("station-failed", "The station has failed; see its log for the error.")


class ProblemDocument(BaseModel):
    """Problem document of RFC 9457."""

    type: str
    title: str
    status: int
    detail: str
    code: str
    parameters: dict[str, str | float]


class Problem(HTTPException):
    """Exception that ends a request with a status and a sentence.  ``members``: further members of
    the document, for programs (RFC 9457, 3.2).
    """

    def __init__(
        self,
        status_code: int,
        detail: str,
        headers: Mapping[str, str] | None = None,
        *,
        members: Mapping[str, object] | None = None,
    ) -> None:
        super().__init__(status_code, detail, headers)
        self.members = members or {}


def problem_response(
    status: int,
    detail: str,
    headers: Mapping[str, str] | None = None,
    members: Mapping[str, object] | None = None,
) -> JSONResponse:
    coded = code_of_text(detail)
    document = ProblemDocument(
        type="about:blank",
        title=HTTPStatus(status).phrase,
        status=status,
        detail=str(detail),
        code=coded.code,
        parameters={**coded.texts, **coded.numbers},
    )
    return JSONResponse(
        {**(members or {}), **document.model_dump()},
        status_code=status,
        headers=headers,
        media_type=PROBLEM_MEDIA_TYPE,
    )


def handle_problems(app: FastAPI, allowed_methods: Callable[[str], str]) -> None:
    """Answer every error of a route with a problem document; ``UnhandledErrorMiddleware`` answers
    the others.

    ``allowed_methods``: methods of a path for the header ``Allow``; empty if there is no such path.
    """

    @app.exception_handler(HTTPException)
    async def refused(request: Request, error: HTTPException) -> JSONResponse:
        if error.status_code == 405:
            return _method_refused(request, allowed_methods(request.url.path))
        is_unreadable = error.status_code == 400 and not isinstance(error, Problem)
        detail = _expected_body(request) if is_unreadable else error.detail
        members = error.members if isinstance(error, Problem) else None
        return problem_response(error.status_code, detail, error.headers, members)

    @app.exception_handler(RequestValidationError)
    async def invalid(request: Request, error: RequestValidationError) -> JSONResponse:
        sentences = (
            _expected_body(request)
            if one["loc"] == ("body",) or one["type"] == "json_invalid"
            else error_sentence(one)
            for one in error.errors()
        )
        return problem_response(422, joined_sentences(sentences))

    @app.exception_handler(MusterError)
    async def failed(request: Request, error: MusterError) -> JSONResponse:
        status = _status_of(error)
        if status >= 500:  # a fault of the station
            _log.warning("%s %s: %s", request.method, request.url.path, error)
        return problem_response(status, text_of_error(error))


class UnhandledErrorMiddleware:
    """ASGI middleware: logs an unhandled error and answers it with a problem document.

    The framework's own handler is outside of all other middleware, so its answer would lack their
    headers.
    """

    def __init__(self, app: ASGIApp) -> None:
        self._app = app

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        started = False

        async def send_and_note_start(message: Message) -> None:
            nonlocal started
            started = True
            await send(message)

        try:
            await self._app(scope, receive, send_and_note_start)
        except Exception as error:
            if scope["type"] != "http" or started:
                raise
            _log.error("%s %s failed", scope["method"], scope["path"], exc_info=error)
            answer = problem_response(500, _FAILED)
            await answer(scope, receive, send)


class BodyTooLargeMiddleware:
    """ASGI middleware: answers a body that is larger than the route accepts with a problem
    document, in place of the limiter's own answer.
    """

    def __init__(self, app: ASGIApp) -> None:
        self._app = app

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        refused = False

        async def send_or_replace(message: Message) -> None:
            nonlocal refused
            if message["type"] == "http.response.start" and message["status"] == 413:
                refused = True
                await problem_response(413, _TOO_LARGE)(scope, receive, send)
            elif not refused:
                await send(message)

        await self._app(scope, receive, send_or_replace)


def _method_refused(request: Request, allowed: str) -> JSONResponse:
    if not allowed:
        return problem_response(404, coded("no-such-address", "There is no such address."))
    detail = coded(
        "method-not-answered",
        "{method} is not answered at this address; use one of: {allowed}.",
        method=request.method,
        allowed=allowed,
    )
    return problem_response(405, detail, {"Allow": allowed})


def _status_of(error: MusterError) -> int:
    match error:
        case UserError():
            return 409
        case ConfigError():
            return 422
        case StoreError() | LogError() | ArchiveError():
            return 503
        case _:
            return 500


def _expected_body(request: Request) -> str:
    """Problem for a request without a body, or with an unreadable one."""
    route = request.scope["route"]
    kind = route.body_field.field_info.media_type
    if kind == "application/json":
        return coded(
            "body-json",
            "send one JSON object as the body, with the header Content-Type: {type}",
            type=kind,
        )
    return coded(
        "body-file",
        "send the file itself as the body, with the header Content-Type: {type} or its like",
        type=kind,
    )
