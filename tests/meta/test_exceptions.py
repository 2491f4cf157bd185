"""No handler catches every exception, except the listed ones."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from pathlib import Path

ROOT = Path(__file__).parents[2]
PACKAGES = ("base_station", "edge", "shared")


def handlers() -> Iterator[tuple[str, ast.ExceptHandler]]:
    for package in PACKAGES:
        for path in sorted((ROOT / package).rglob("*.py")):
            if path.name.endswith("_pb2.py") or "node_modules" in path.parts:
                continue
            for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
                if isinstance(node, ast.ExceptHandler):
                    yield path.relative_to(ROOT).as_posix(), node


def test_no_handler_catches_every_exception() -> None:
    """Undo steps stand in ``finally``, or in an ``ExitStack`` whose callbacks are removed on
    success.
    """
    found = list(handlers())
    assert len(found) > 500
    catching_all = {
        path
        for path, handler in found
        if handler.type is None or "BaseException" in ast.unparse(handler.type)
    }
    assert catching_all == set()
