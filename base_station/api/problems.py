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

from shared.errors import ConfigError, MusterError, StoreError, UserError

_log = logging.getLogger(__name__)


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
    """Every error of a route becomes a problem document."""

    @app.exception_handler(HTTPException)
    async def refused(_request: Request, error: HTTPException) -> JSONResponse:
        return problem_response(error.status_code, str(error.detail), error.headers)

    @app.exception_handler(RequestValidationError)
    async def invalid(_request: Request, error: RequestValidationError) -> JSONResponse:
        sentences = (_sentence(one["loc"], one["msg"]) for one in error.errors())
        return problem_response(422, "; ".join(sentences))

    @app.exception_handler(MusterError)
    async def failed(_request: Request, error: MusterError) -> JSONResponse:
        return problem_response(_status_of(error), str(error))

    @app.exception_handler(Exception)
    async def broke(request: Request, error: Exception) -> JSONResponse:
        _log.error("%s %s failed", request.method, request.url.path, exc_info=error)
        return problem_response(500, "The station made a mistake; its log says which.")


def _status_of(error: MusterError) -> int:
    match error:
        case UserError():
            return 409
        case ConfigError():
            return 422
        case StoreError():
            return 503
        case _:
            return 500


def _sentence(location: tuple[int | str, ...], message: str) -> str:
    where = ".".join(str(part) for part in location[1:])
    return f"{where}: {message}" if where else message
