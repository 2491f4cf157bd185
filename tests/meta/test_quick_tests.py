"""Quick tests (``./muster test --quick``) start no process: tests that do are marked slow."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from pathlib import Path

import pytest

TESTS = Path(__file__).resolve().parents[1]
QUICK = ("unit", "property", "contracts", "meta")
STARTS = {"subprocess", "ReplayProcesses", "tests.rig.station_command"}


def imported(tree: ast.Module) -> set[str]:
    """Imported modules and names."""
    found: set[str] = set()
    for node in ast.walk(tree):
        if isinstance(node, ast.Import | ast.ImportFrom):
            found |= {name.name for name in node.names}
            found |= {node.module or ""} if isinstance(node, ast.ImportFrom) else set()
    return found


def modules_that_start_processes() -> Iterator[Path]:
    for folder in QUICK:
        for path in sorted((TESTS / folder).rglob("test_*.py")):
            text = path.read_text(encoding="utf-8")  # parsing all files takes a second
            if any(name in text for name in STARTS) and imported(ast.parse(text)) & STARTS:
                yield path


@pytest.mark.parametrize("path", [*modules_that_start_processes()], ids=lambda path: path.stem)
def test_tests_that_start_a_process_are_marked_slow(path: Path) -> None:
    assert "pytest.mark.slow" in path.read_text(encoding="utf-8")
