"""The OpenAPI document, from which clients are generated."""

from __future__ import annotations

import json
from collections.abc import Iterator
from typing import Any

import pytest

from base_station.api.field_descriptions import FIELDS, SUBJECTS
from base_station.api.field_descriptions.parameters import PARAMETERS
from shared.clock import ManualClock
from tests.rig.in_process_station import InProcessStation

Document = dict[str, Any]


@pytest.fixture(scope="module")
def document(tmp_path_factory: pytest.TempPathFactory) -> Document:
    station = InProcessStation(tmp_path_factory.mktemp("station"), ManualClock())
    try:
        return station.app.openapi()
    finally:
        station.close()


def operations(document: Document) -> Iterator[Document]:
    for methods in document["paths"].values():
        yield from methods.values()


def fields(document: Document) -> Iterator[tuple[str, str, Document]]:
    for name, schema in document["components"]["schemas"].items():
        for field, about in schema.get("properties", {}).items():
            yield name, field, about


def parameters(document: Document) -> Iterator[tuple[str, Document]]:
    for operation in operations(document):
        for parameter in operation.get("parameters", ()):
            yield operation["operationId"], parameter


def test_every_field_and_every_parameter_is_described(document: Document) -> None:
    """A new one is described in its subject's module of ``base_station/api/field_descriptions``."""
    bare = [f"{name}.{field}" for name, field, about in fields(document) if not has_text(about)]
    bare += [f"{of}({one['name']})" for of, one in parameters(document) if not has_text(one)]
    assert bare == []
    assert len(list(fields(document))) > 300


def has_text(about: Document) -> bool:
    return bool(about.get("description", "").strip())


def test_every_description_has_a_field_or_parameter(document: Document) -> None:
    asked = {parameter["name"] for _, parameter in parameters(document)}
    answered = {
        known for name, field, _ in fields(document) for known in (field, f"{name}.{field}")
    }
    assert set(FIELDS) - answered - asked == set()
    assert set(PARAMETERS) - asked == set()


def test_a_field_is_described_by_one_subject() -> None:
    described = [field for subject in SUBJECTS for field in subject.FIELDS]
    assert sorted(described) == sorted(FIELDS)


def test_schema_names_and_operation_ids_are_unique(document: Document) -> None:
    assert [name for name in document["components"]["schemas"] if "__" in name] == []
    ids = [operation["operationId"] for operation in operations(document)]
    assert len(ids) == len(set(ids)) > 80


def test_every_problem_is_declared_with_the_media_type_that_is_sent(document: Document) -> None:
    problem = {"schema": {"$ref": "#/components/schemas/ProblemDocument"}}
    for operation in operations(document):
        refused = {code: one for code, one in operation["responses"].items() if int(code) >= 400}
        assert {"401", "409", "422", "429", "503"} <= set(refused), operation["operationId"]
        for code, response in refused.items():
            declared = response["content"]
            assert declared == {"application/problem+json": problem}, (
                operation["operationId"],
                code,
            )
    assert "HTTPValidationError" not in json.dumps(document)
