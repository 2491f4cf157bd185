"""Names of shipped classes; first words of docstrings and words of identifiers, in tests too."""

from __future__ import annotations

import ast
import re
from collections import defaultdict
from collections.abc import Iterator
from functools import cache

from tests.conftest import PROJECT_ROOT

SHIPPED = ("base_station", "deploy", "edge", "shared")
WRITTEN = (*SHIPPED, "tests")
QUESTION_WORDS = {"How", "What", "When", "Where", "Whether", "Which", "Who", "Whom", "Whose", "Why"}
NO_FIRST_WORDS = {*QUESTION_WORDS, "Of"}  # "Of" continues the name of the object
EVERYDAY_WORDS = {"said", "told", "heard", "somebody", "anybody", "nobody", "whoever"}
PUBLISHED_NAMES = {
    "last_heard_ms": "field of the live picture and of the API",
    "last_heard_ns": "column of the table of units",
}


@cache
def modules(packages: tuple[str, ...]) -> dict[str, ast.Module]:
    """Modules that people wrote; a migration stays as it was released."""
    return {
        str(path.relative_to(PROJECT_ROOT)): ast.parse(path.read_text(encoding="utf-8"))
        for package in packages
        for path in sorted((PROJECT_ROOT / package).rglob("*.py"))
        if not path.name.endswith("_pb2.py")
        and not {"migrations", "node_modules"} & set(path.parts)
    }


def test_class_name_is_defined_once() -> None:
    places = defaultdict(list)
    for path, module in modules(SHIPPED).items():
        for node in module.body:
            if isinstance(node, ast.ClassDef):
                places[node.name].append(path)
    assert len(places) > 500
    assert {name: paths for name, paths in places.items() if len(paths) > 1} == {}


def test_module_docstring_begins_with_a_noun_or_a_verb() -> None:
    asking = {
        path: text.splitlines()[0]
        for path, module in modules(WRITTEN).items()
        if (text := ast.get_docstring(module)) and text.split()[0].strip(",:") in NO_FIRST_WORDS
    }
    assert asking == {}


def nodes() -> Iterator[tuple[str, ast.AST]]:
    """Nodes of all modules, with the path and line of each."""
    for path, module in modules(WRITTEN).items():
        for node in ast.walk(module):
            yield f"{path}:{getattr(node, 'lineno', 1)}", node


def test_docstring_begins_with_a_noun_or_a_verb() -> None:
    asking = {
        place: text.splitlines()[0]
        for place, node in nodes()
        if isinstance(node, ast.ClassDef | ast.FunctionDef | ast.AsyncFunctionDef)
        and (text := ast.get_docstring(node))
        and text.split()[0].strip(",:") in NO_FIRST_WORDS
    }
    assert asking == {}


def test_identifier_has_no_everyday_speech() -> None:
    """A message is received or reported, a person is a user, a member or a wearer."""
    found = {
        f"{place} {name}"
        for place, node in nodes()
        for field in ("id", "attr", "arg", "name", "asname")
        if isinstance(name := getattr(node, field, None), str)
        and name not in PUBLISHED_NAMES
        and EVERYDAY_WORDS & {word.lower() for word in re.findall("[A-Z]?[a-z]+", name)}
    }
    assert found == set()
