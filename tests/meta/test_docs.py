"""Pages of the documentation: links, anchors, files and commands exist."""

from __future__ import annotations

import os
import re
import tomllib
from pathlib import Path

import pytest

from tests.bench.__main__ import bench_entry_points
from tests.conftest import PROJECT_ROOT

PAGES = [PROJECT_ROOT / "README.md", *sorted((PROJECT_ROOT / "docs").rglob("*.md"))]
PYPROJECT = tomllib.loads((PROJECT_ROOT / "pyproject.toml").read_text())
COMMANDS = [
    *PYPROJECT["project"]["entry-points"]["muster.commands"],
    *(point.name for point in bench_entry_points()),
]
OF_THE_BOOTSTRAP = {"test"}
FOLDERS = ("base_station", "deploy", "edge", "shared", "tests")
# A page that shows how to add a file names it before it exists.
OF_TODAY = [page for page in PAGES if not page.stem.startswith("add-")]


def source_files() -> frozenset[str]:
    """Files of all folders, as paths below the project."""
    found: set[str] = set()
    for folder in FOLDERS:
        for root, folders, names in os.walk(PROJECT_ROOT / folder):
            folders[:] = [name for name in folders if name not in {"node_modules", "__pycache__"}]
            found.update(str(Path(root, name).relative_to(PROJECT_ROOT)) for name in names)
    return frozenset(found)


SOURCES = source_files()


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.stem)
def test_every_link_leads_to_a_file(page):
    for target in re.findall(r"\]\(([^)#]+)", page.read_text()):
        if not target.startswith("http"):
            assert (page.parent / target).exists(), target


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.stem)
def test_every_anchor_is_a_heading(page):
    for target, anchor in re.findall(r"\]\(([^)#:]*)#([^)]+)\)", page.read_text()):
        there = page.parent / target if target else page
        assert anchor in anchors_of(there.read_text()), f"{target}#{anchor}"


def anchors_of(text: str) -> set[str]:
    """Anchors that GitHub gives the headings of a page."""
    without_code = re.sub(r"^```.*?^```", "", text, flags=re.MULTILINE | re.DOTALL)
    found: set[str] = set()
    for title in re.findall(r"^#+ (.+)$", without_code, flags=re.MULTILINE):
        slug = re.sub(r"[^\w\- ]", "", title.lower()).replace(" ", "-")
        repeats = sum(anchor == slug or anchor.startswith(f"{slug}-") for anchor in found)
        found.add(f"{slug}-{repeats}" if slug in found else slug)
    return found


@pytest.mark.parametrize("page", OF_TODAY, ids=lambda page: page.stem)
def test_every_source_file_named_exists(page):
    for name in re.findall(r"`([\w./-]+\.(?:py|tsx?|proto))`", page.read_text()):
        assert any(f"/{path}".endswith(f"/{name}") for path in SOURCES), name


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.stem)
def test_every_command_exists(page):
    known = {name.partition(".")[0] for name in COMMANDS} | OF_THE_BOOTSTRAP
    text = page.read_text()
    for name in re.findall(r"(?:^|`)(?:\./)?muster ([a-z]+)", text, flags=re.MULTILINE):
        assert name in known, f"muster {name}"
    for name in re.findall(r"muster bench ([a-z]+)", text):
        assert f"bench.{name}" in COMMANDS, f"muster bench {name}"


@pytest.mark.parametrize("name", sorted(COMMANDS))
def test_every_command_is_documented(name):
    words = f"muster {name.replace('.', ' ')}"
    assert any(words in page.read_text() for page in PAGES), words


def test_the_pictures_of_the_set_up_are_those_that_its_test_takes():
    page = (PROJECT_ROOT / "docs/howto/set-up-at-the-vehicle.md").read_text()
    test = (PROJECT_ROOT / "tests/e2e/test_set_up.py").read_text()
    taken = re.findall(r'take_picture\(\w+, tmp_path, "(\S+)"\)', test)
    assert re.findall(r"!\[[^\]]+\]\((\S+)\)", page) == taken
