"""Names of shipped classes; first words of docstrings and words of identifiers, in tests too."""

from __future__ import annotations

import ast
import re
from collections import defaultdict
from collections.abc import Iterator
from functools import cache

import pytest

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


# Only what may hold a wrong word is parsed: to parse all 2,500 modules takes half a minute.
CLASS = re.compile(r"^class (\w+)", re.MULTILINE)
QUOTED_FIRST_WORD = re.compile(rf"[\"'][\s,:]*(?:{'|'.join(sorted(NO_FIRST_WORDS))})\b")
EVERYDAY_WORD = re.compile("|".join(sorted(EVERYDAY_WORDS)), re.IGNORECASE)


@cache
def sources(packages: tuple[str, ...]) -> dict[str, str]:
    """Modules that people wrote; a migration stays as it was released."""
    return {
        str(path.relative_to(PROJECT_ROOT)): path.read_text(encoding="utf-8")
        for package in packages
        for path in sorted((PROJECT_ROOT / package).rglob("*.py"))
        if not path.name.endswith("_pb2.py")
        and not {"migrations", "node_modules"} & set(path.parts)
    }


def nodes(suspect: re.Pattern[str]) -> Iterator[tuple[str, ast.AST]]:
    """Nodes of the modules in whose text the pattern is found, with the path and line of each."""
    for path, text in sources(WRITTEN).items():
        if suspect.search(text):
            for node in ast.walk(ast.parse(text)):
                yield f"{path}:{getattr(node, 'lineno', 1)}", node


def begins_wrongly(node: ast.AST) -> bool:
    if not isinstance(node, ast.Module | ast.ClassDef | ast.FunctionDef | ast.AsyncFunctionDef):
        return False
    text = ast.get_docstring(node)
    return text is not None and text.split()[0].strip(",:") in NO_FIRST_WORDS


def everyday_names(node: ast.AST) -> list[str]:
    """Identifiers of the node that hold a word of everyday speech."""
    names = (getattr(node, field, None) for field in ("id", "attr", "arg", "name", "asname"))
    return [
        name
        for name in names
        if isinstance(name, str)
        and name not in PUBLISHED_NAMES
        and EVERYDAY_WORDS & {word.lower() for word in re.findall("[A-Z]?[a-z]+", name)}
    ]


def test_class_name_is_defined_once() -> None:
    places = defaultdict(list)
    for path, text in sources(SHIPPED).items():
        for name in CLASS.findall(text):
            places[name].append(path)
    assert len(places) > 500
    assert {name: paths for name, paths in places.items() if len(paths) > 1} == {}


def test_docstring_begins_with_a_noun_or_a_verb() -> None:
    assert [place for place, node in nodes(QUOTED_FIRST_WORD) if begins_wrongly(node)] == []


def test_identifier_has_no_everyday_speech() -> None:
    """A message is received or reported, a person is a user, a member or a wearer."""
    found = {
        f"{place} {name}" for place, node in nodes(EVERYDAY_WORD) for name in everyday_names(node)
    }
    assert found == set()


@pytest.mark.parametrize(
    "text",
    [
        '"""Which of two."""',
        'class A:\n    """  Who, of all."""',
        "async def f() -> None:\n    r'''\n    Of the station.\n    '''",
    ],
)
def test_a_question_in_a_docstring_is_found(text: str) -> None:
    assert QUOTED_FIRST_WORD.search(text)
    assert any(map(begins_wrongly, ast.walk(ast.parse(text))))


@pytest.mark.parametrize(
    "text",
    ["def told_s(): ...", "lastHeard = 1", "import a as Somebody", "f(said_ns=1)", "a.nobody = 1"],
)
def test_everyday_speech_in_an_identifier_is_found(text: str) -> None:
    assert EVERYDAY_WORD.search(text)
    assert any(map(everyday_names, ast.walk(ast.parse(text))))
