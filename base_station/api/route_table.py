"""The API's routes as a table: which query parameters and which methods each address takes."""

from __future__ import annotations

import functools
import re
from collections.abc import Callable, Mapping
from typing import Any

from fastapi.dependencies.utils import get_flat_params
from fastapi.params import Query
from fastapi.routing import APIRoute, APIWebSocketRoute
from starlette.requests import HTTPConnection

from base_station.api.problems import Problem
from base_station.api.routes import ROUTERS
from shared.config import nearest

PREFIX = "/api/v1"
DOCUMENT_PATH = f"{PREFIX}/openapi.json"
_NO_PARAMETERS = "this address takes no parameters"


def check_query(connection: HTTPConnection) -> None:
    """Dependency of every route: refuses an unknown query parameter, as it would have no effect."""
    known = _query_parameters().get(connection.scope["endpoint"])
    if known is None:  # the console's page, which has no filters
        return
    given = list(connection.query_params)
    wrong = [name for name in given if name not in known]
    if wrong:
        absent = [name for name in known if name not in given]
        hints = (
            f"{name} is not a parameter here; "
            f"{nearest(name, known, absent) if known else _NO_PARAMETERS}"
            for name in wrong
        )
        raise Problem(422, "; ".join(hints))


def allowed_methods(path: str) -> str:
    """Methods that a path accepts, for the header ``Allow``: those of all its routes, of the
    console's files and of the API's document.  Empty if there is no such path.
    """
    allowed = set[str]()
    for pattern, methods in _methods():
        if pattern.match(path):
            allowed |= methods
    if not allowed and (path == DOCUMENT_PATH or not path.startswith(f"{PREFIX}/")):
        allowed = {"GET"}
    return ", ".join(sorted(allowed | ({"HEAD"} if "GET" in allowed else set())))


@functools.cache
def _query_parameters() -> Mapping[Callable[..., Any], frozenset[str]]:
    return {
        route.endpoint: frozenset(
            field.alias
            for field in get_flat_params(route.dependant)
            if isinstance(field.field_info, Query)
        )
        for router in ROUTERS
        for route in router.routes
        if isinstance(route, APIRoute | APIWebSocketRoute)
    }


@functools.cache
def _methods() -> tuple[tuple[re.Pattern[str], frozenset[str]], ...]:
    return tuple(
        (
            re.compile(f"^{re.escape(PREFIX)}{route.path_regex.pattern[1:]}"),
            frozenset(route.methods or ()),
        )
        for router in ROUTERS
        for route in router.routes
        if isinstance(route, APIRoute)
    )
