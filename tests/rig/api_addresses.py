"""Addresses of all routes of the API."""

from __future__ import annotations

from collections.abc import Iterator

from fastapi.routing import APIRoute

from base_station.api.routes import ROUTERS


def addresses() -> Iterator[tuple[str, str]]:
    """Method and path of every route, with something in place of what is variable."""
    for router in ROUTERS:
        for route in router.routes:
            if isinstance(route, APIRoute):
                path = route.path.replace("{", "").replace("}", "")
                yield from ((method, path) for method in sorted(route.methods or ()))
