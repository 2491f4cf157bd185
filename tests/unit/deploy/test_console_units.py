"""Runs the console's own unit tests (vitest) and its type check."""

from __future__ import annotations

import os
import subprocess
from pathlib import Path

import pytest

pytest.importorskip("hatchling", reason="hatchling is not installed: it runs the build hook")

from deploy.build_hook import CONSOLE, BuildError, find_node

FOLDER = Path(__file__).resolve().parents[3] / CONSOLE


def npm(script: str) -> subprocess.CompletedProcess[str]:
    try:
        node = find_node()
    except BuildError as error:
        pytest.skip(f"no Node: {error}")
    if not (FOLDER / "node_modules").is_dir():
        pytest.skip(f"the console's parts are not installed: run npm ci in {CONSOLE}")
    path = f"{node.folder}{os.pathsep}{os.environ.get('PATH', '')}"
    return subprocess.run(
        [*node.npm, "run", script],
        cwd=FOLDER,
        env={**os.environ, "PATH": path, "NO_COLOR": "1"},
        capture_output=True,
        text=True,
        check=False,
    )


@pytest.mark.slow
@pytest.mark.parametrize("script", ["check", "test"])
def test_console(script: str) -> None:
    done = npm(script)
    assert done.returncode == 0, done.stdout + done.stderr
