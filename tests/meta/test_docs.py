"""The pages say what is there: links lead somewhere, commands exist."""

from __future__ import annotations

import re
import tomllib

import pytest

from tests.conftest import PROJECT_ROOT

PAGES = [PROJECT_ROOT / "README.md", *sorted((PROJECT_ROOT / "docs").rglob("*.md"))]
COMMANDS = tomllib.loads((PROJECT_ROOT / "pyproject.toml").read_text())["project"]["entry-points"][
    "muster.commands"
]
OF_THE_BOOTSTRAP = {"test"}


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.stem)
def test_every_link_leads_to_a_file(page):
    for target in re.findall(r"\]\(([^)#]+)", page.read_text()):
        if not target.startswith("http"):
            assert (page.parent / target).exists(), target


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
