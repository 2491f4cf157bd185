"""Names of classes and first words of modules, in what is shipped."""

from __future__ import annotations

import ast
from collections import defaultdict

from tests.conftest import PROJECT_ROOT

SHIPPED = ("base_station", "deploy", "edge", "shared")
QUESTION_WORDS = {"How", "What", "When", "Where", "Whether", "Which", "Who", "Whose", "Why"}


def modules() -> dict[str, ast.Module]:
    """Those that people wrote; a migration stays as it was released."""
    return {
        str(path.relative_to(PROJECT_ROOT)): ast.parse(path.read_text(encoding="utf-8"))
        for package in SHIPPED
        for path in sorted((PROJECT_ROOT / package).rglob("*.py"))
        if not path.name.endswith("_pb2.py")
        and not {"migrations", "node_modules"} & set(path.parts)
    }


def test_a_class_name_stands_for_one_thing() -> None:
    places = defaultdict(list)
    for path, module in modules().items():
        for node in module.body:
            if isinstance(node, ast.ClassDef):
                places[node.name].append(path)
    assert len(places) > 500
    assert {name: paths for name, paths in places.items() if len(paths) > 1} == {}


def test_a_module_says_first_what_it_is() -> None:
    asking = {
        path: text.splitlines()[0]
        for path, module in modules().items()
        if (text := ast.get_docstring(module)) and text.split()[0].strip(",:") in QUESTION_WORDS
    }
    assert asking == {}
