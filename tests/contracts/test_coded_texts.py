"""Every text that the station or a unit composes with ``coded`` has its message in all catalogues
of the console, with the same parameters.  The codes are read from the source.
"""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from string import Formatter
from typing import NamedTuple

import pytest
from fastapi.dependencies.models import Dependant
from fastapi.routing import APIRoute

from base_station.api import posted_samples
from base_station.api.forms import Form
from base_station.api.routes import ROUTERS
from tests.conftest import PROJECT_ROOT
from tests.rig.console_catalogues import LANGUAGES, MESSAGE

PARTS = (
    "archive_errors",
    "problems",
    "unit_faults",
    "unit_checks",
    "coded_reasons",
    "drawing_notes",
    "pin_reasons",
    "transfer_problems",
    "connection_reasons",
    "dispatch_warnings",
    "import_warnings",
    "log_defects",
    *(
        f"refusals_{area}"
        for area in ("access", "people", "incident", "plan", "past", "station", "form")
    ),
)
_CATALOGUES = PROJECT_ROOT / "base_station/console/src/language"
_BRACE = re.compile(r"\{(\w*)|\}")


class Composed(NamedTuple):
    """One call of ``coded``."""

    where: str
    code: str
    placeholders: frozenset[str]  # of the English template
    parameters: frozenset[str]


def calls_of_coded() -> Iterator[Composed]:
    for package in ("base_station", "edge", "shared"):
        for path in sorted((PROJECT_ROOT / package).rglob("*.py")):
            if "coded(" in (source := path.read_text()):
                yield from _calls(path, ast.parse(source))


def _calls(path: Path, tree: ast.AST) -> Iterator[Composed]:
    for node in ast.walk(tree):
        if (
            isinstance(node, ast.Call)
            and isinstance(node.func, ast.Name)
            and node.func.id == "coded"
        ):
            code, template = (ast.literal_eval(one) for one in node.args)
            placeholders = {name for _, name, _, _ in Formatter().parse(template) if name}
            given = {keyword.arg for keyword in node.keywords if keyword.arg}
            where = f"{path.relative_to(PROJECT_ROOT)}:{node.lineno}"
            yield Composed(where, code, frozenset(placeholders), frozenset(given))


@cache
def composed() -> tuple[Composed, ...]:
    """All of them, read by the first test: every process of the tests loads this module."""
    return tuple(calls_of_coded())


def messages_of(language: str) -> dict[str, str]:
    found = [
        message
        for part in PARTS
        for message in MESSAGE.findall((_CATALOGUES / language / f"{part}.ts").read_text())
    ]
    assert len(dict(found)) == len(found)  # the console finds a code in one of them
    return dict(found)


def placeholders_of(message: str) -> set[str]:
    """Names of an ICU message.  Braces open a placeholder and, within it, a choice, by turns."""
    names, depth = set(), 0
    for brace in _BRACE.finditer(message):
        depth += -1 if brace[0] == "}" else 1
        if brace[0] != "}" and depth % 2:
            names.add(brace[1])
    return names


def test_calls_are_found() -> None:
    assert len(composed()) > 60


def test_one_code_has_one_template() -> None:
    codes = [one.code for one in composed()]
    assert sorted(codes) == sorted(set(codes))


def test_template_uses_only_given_parameters() -> None:
    assert [one for one in composed() if not one.placeholders <= one.parameters] == []


@pytest.mark.parametrize("language", LANGUAGES)
def test_every_code_has_a_message_with_its_parameters(language: str) -> None:
    messages = messages_of(language)
    assert set(messages) == {one.code for one in composed()}
    for one in composed():
        assert placeholders_of(messages[one.code]) == one.parameters, (language, one)


@pytest.mark.parametrize("language", LANGUAGES)
def test_every_field_of_a_form_and_query_has_a_label(language: str) -> None:
    """But for samples of sensors, which programs send."""
    path = _CATALOGUES / language / "field_labels.ts"
    labels = set(re.findall(r'^  (\w+): "', path.read_text(), re.MULTILINE))
    assert ROUTERS  # has every form imported
    forms = [form for form in forms_of(Form) if form.__module__ != posted_samples.__name__]
    fields = {name for form in forms for name in form.model_fields}
    assert labels == fields | parameters_of_queries()


def parameters_of_queries() -> set[str]:
    routes = [one for router in ROUTERS for one in router.routes if isinstance(one, APIRoute)]
    return {name for route in routes for name in _queried(route.dependant)}


def _queried(dependant: Dependant) -> Iterator[str]:
    yield from (one.alias for one in dependant.query_params)
    for one in dependant.dependencies:
        yield from _queried(one)


def forms_of(kind: type[Form]) -> Iterator[type[Form]]:
    for form in kind.__subclasses__():
        yield form
        yield from forms_of(form)
