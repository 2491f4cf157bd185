"""Commands of the pages: every subcommand and every option exists."""

from __future__ import annotations

import re
from importlib.metadata import entry_points
from pathlib import Path

import pytest
import typer
from typer.core import TyperCommand, TyperGroup

from shared.command_line import COMMANDS, build_program
from tests.bench.__main__ import bench_entry_points
from tests.conftest import PROJECT_ROOT

PAGES = [PROJECT_ROOT / "README.md", *sorted((PROJECT_ROOT / "docs").rglob("*.md"))]
POINTS = [*entry_points(group=COMMANDS), *bench_entry_points()]
TYPED = re.compile(r"(?:^|[`/ ])muster (?P<words>[a-z][^`\n#&|;]*)", flags=re.MULTILINE)


@pytest.fixture(scope="module")
def program() -> TyperGroup:
    return build_program(POINTS)


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.stem)
def test_every_option_exists(page: Path, program: TyperGroup) -> None:
    for typed in commands_of(page.read_text()):
        command, rest = found(program, typed)
        if isinstance(command, TyperGroup):
            group = " ".join(typed[: len(typed) - len(rest)])
            assert not rest or not re.fullmatch("[a-z][a-z-]+", rest[0]), f"{group} {rest[0]}"
        known = {option for part in command.params for option in (*part.opts, *part.secondary_opts)}
        for option in (word.partition("=")[0].rstrip(",.)") for word in rest):
            if option.startswith("--"):
                assert option in known | {"--help"}, " ".join(typed)


def commands_of(text: str) -> list[list[str]]:
    """Words of the commands that begin with the name of the program."""
    names = {point.name.partition(".")[0] for point in POINTS}
    typed = [match["words"].split() for match in TYPED.finditer(text.replace("\\\n", " "))]
    return [words for words in typed if words[0] in names]


def found(program: TyperGroup, words: list[str]) -> tuple[TyperGroup | TyperCommand, list[str]]:
    """The command that the words name, and the words behind its name."""
    command: TyperGroup | TyperCommand = program
    for index, word in enumerate(words):
        if not isinstance(command, TyperGroup) or word not in command.commands:
            return command, words[index:]
        _, below, _ = command.resolve_command(typer.Context(command), [word])
        assert isinstance(below, TyperGroup | TyperCommand)
        command = below
    return command, []


def test_commands_of_a_page_are_found() -> None:
    text = (
        "`muster base serve --data DIR`.\n./muster pki enroll \\\n  FF-01 --qr\nthe muster of all"
    )
    assert commands_of(text) == [
        ["base", "serve", "--data", "DIR"],
        ["pki", "enroll", "FF-01", "--qr"],
    ]
