"""The API's OpenAPI document: that of FastAPI, with descriptions and problems."""

from __future__ import annotations

from collections.abc import Iterator
from http import HTTPStatus
from typing import Any

from fastapi import FastAPI
from fastapi.routing import APIRoute

from base_station.api.field_descriptions import describe_field, describe_parameter
from base_station.api.posted_samples import PostedSamples
from base_station.api.problems import PROBLEM_MEDIA_TYPE, ProblemDocument

_PROBLEMS = (400, 401, 403, 404, 409, 413, 422, 429, 500, 503)
_FILE = {"type": "string", "format": "binary"}
_PROBLEM = {"$ref": f"#/components/schemas/{ProblemDocument.__name__}"}


def operation_id(route: APIRoute) -> str:
    """Name of a route in generated clients: that of its function."""
    return route.name


def file_response(*media_types: str) -> dict[int | str, dict[str, Any]]:
    """Value of ``responses`` for a route that answers with a file."""
    return {200: {"content": {media_type: {"schema": _FILE} for media_type in media_types}}}


def complete_document(app: FastAPI) -> None:
    """Add to the application's document the parts that FastAPI leaves out."""
    make = app.openapi

    def document() -> dict[str, Any]:
        if app.openapi_schema is None:
            _complete(make())  # which keeps it in ``app.openapi_schema``
        assert app.openapi_schema is not None
        return app.openapi_schema

    app.openapi = document  # type: ignore[method-assign]  # as FastAPI's manual shows


def _complete(document: dict[str, Any]) -> None:
    schemas = document["components"]["schemas"]
    for unused in ("HTTPValidationError", "ValidationError"):  # the framework's own problems
        schemas.pop(unused, None)
    schemas[ProblemDocument.__name__] = ProblemDocument.model_json_schema()
    posted = PostedSamples.model_json_schema(ref_template="#/components/schemas/{model}")
    schemas |= {
        **posted.pop("$defs"),
        PostedSamples.__name__: posted,
    }  # which its route reads itself
    for name, schema in schemas.items():
        for field, json_schema in schema.get("properties", {}).items():
            _add_description(json_schema, describe_field(name, field))
    for operation in _operations(document):
        operation["responses"] |= _problem_responses()
        for media_type, body in operation.get("requestBody", {}).get("content", {}).items():
            if media_type != "application/json":
                body["schema"] = _FILE  # a client would take FastAPI's own messages for texts
        for parameter in operation.get("parameters", ()):
            _add_description(parameter, describe_parameter(parameter["name"]))


def _add_description(json_schema: dict[str, Any], description: str | None) -> None:
    """Add a description, unless the code itself gives one."""
    if description is not None:
        json_schema.setdefault("description", description)


def _operations(document: dict[str, Any]) -> Iterator[dict[str, Any]]:
    for methods in document["paths"].values():
        yield from methods.values()


def _problem_responses() -> dict[str, Any]:
    """Problem responses of every route, with the media type that is sent, so that clients decode
    them.
    """
    return {
        str(status): {
            "description": HTTPStatus(status).phrase,
            "content": {PROBLEM_MEDIA_TYPE: {"schema": _PROBLEM}},
        }
        for status in _PROBLEMS
    }
