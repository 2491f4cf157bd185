"""Layers, files and names of docs/architecture.md are those of the source."""

from __future__ import annotations

import ast
import re
import tomllib
from pathlib import Path

import pytest

from tests.conftest import PROJECT_ROOT

PAGE = (PROJECT_ROOT / "docs" / "architecture.md").read_text(encoding="utf-8")
WALKS = re.findall(r"^## An? ([a-z]+)\n(.*?)(?=^## |\Z)", PAGE, flags=re.MULTILINE | re.DOTALL)
LAYERS = re.findall(r"^```layers (\w+)\n(.*?)^```", PAGE, flags=re.MULTILINE | re.DOTALL)
CODE = re.compile(r"`([^`\n]+)`")
CONTRACTS = tomllib.loads((PROJECT_ROOT / "pyproject.toml").read_text())["tool"]["importlinter"][
    "contracts"
]


def named(walk: str) -> list[tuple[str, str]]:
    """Functions and classes that a walk names behind a file, each with that file."""
    found, file = [], ""
    for code in CODE.findall(walk):
        if "/" in code:
            file = code
            found.append((file, ""))
        elif file and re.fullmatch(r"[A-Za-z_.]+\(\)|[A-Z]\w+", code):
            found.append((file, code.removesuffix("()")))
    return found


NAMED = sorted({name for _, walk in WALKS for name in named(walk)})


def definitions(path: Path) -> set[str]:
    """Functions and classes of a file, and methods with their class."""
    text = path.read_text(encoding="utf-8")
    if path.suffix != ".py":
        return set(re.findall(r"\b(?:function|const|class) (\w+)", text))
    found = set()
    for node in ast.parse(text).body:
        if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef | ast.ClassDef):
            found.add(node.name)
            found |= {
                f"{node.name}.{inner.name}"
                for inner in (node.body if isinstance(node, ast.ClassDef) else [])
                if isinstance(inner, ast.FunctionDef | ast.AsyncFunctionDef)
            }
    return found


def test_there_are_five_walks_of_ten_lines() -> None:
    titles = ["sample", "position", "acknowledgement", "disconnection", "replay"]
    assert [title for title, _ in WALKS] == titles
    for title, walk in WALKS:
        numbers = [int(number) for number in re.findall(r"^(\d+)\. `", walk, flags=re.MULTILINE)]
        assert numbers == list(range(1, 11)), title


@pytest.mark.parametrize(("file", "name"), NAMED)
def test_a_walk_names_what_is_defined_in_its_file(file: str, name: str) -> None:
    path = PROJECT_ROOT / file
    assert path.is_file(), file
    assert not name or name in definitions(path), f"{file}: {name}"


@pytest.mark.parametrize(("container", "drawn"), LAYERS, ids=[name for name, _ in LAYERS])
def test_the_layers_are_those_that_import_linter_holds(container: str, drawn: str) -> None:
    (layers,) = (one["layers"] for one in CONTRACTS if one.get("containers") == [container])
    held = [sorted(layer.strip("()").split(" | ")) for layer in layers if layer[0] != "("]
    pictured = [sorted(line.split("  ")[0].split(" | ")) for line in drawn.splitlines()]
    assert pictured == held


def test_diagrams_of_unit_and_station_exist() -> None:
    assert [name for name, _ in LAYERS] == ["base_station", "edge"]
