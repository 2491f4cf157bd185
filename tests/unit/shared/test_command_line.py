"""The root command: its parts, its help, and errors as sentences."""

from __future__ import annotations

import subprocess
import sys
from importlib.metadata import EntryPoint

import pytest

from shared.command_line import build_program


def commands(**values: str) -> tuple[EntryPoint, ...]:
    return tuple(
        EntryPoint(name.replace("__", "."), value, "muster.commands")
        for name, value in values.items()
    )


def run(*arguments: str, python: tuple[str, ...] = ()) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [sys.executable, *python, "-m", "shared.command_line", *arguments],
        capture_output=True,
        text=True,
        check=False,
    )


@pytest.mark.parametrize("arguments", [["messages"], ["bench", "messages"]])
def test_a_dotted_name_stands_below_its_group(
    arguments: list[str], capsys: pytest.CaptureFixture[str]
):
    point = "shared.message_reference:messages"
    program = build_program(commands(messages=point, bench__messages=point))
    program(arguments, standalone_mode=False)
    assert "# Channels and messages" in capsys.readouterr().out


@pytest.mark.slow
@pytest.mark.parametrize("arguments", [["--help"], ["bench", "--help"], ["bench", "messagse"]])
def test_a_list_says_what_each_command_is_for_and_loads_none(arguments: list[str]):
    """And a mistyped name is answered in the time that a list takes."""
    result = run(*arguments, python=("-X", "importtime"))
    loaded = {line.rpartition("|")[2].strip() for line in result.stderr.splitlines()}
    assert "typer" in loaded
    assert not loaded & {"numpy", "zenoh", "sqlalchemy", "shared.messages"}


@pytest.mark.slow
def test_help_names_every_command():
    result = run("--help")
    assert result.returncode == 0, result.stderr
    for name in ("edge", "base", "demo", "track"):
        assert name in result.stdout
    for words in ("One agent for each wearable.", "Track a recorded walk"):
        assert words in result.stdout


@pytest.mark.slow
def test_a_mistyped_command_is_answered_with_the_nearest():
    result = run("edgy")
    assert result.returncode == 2
    assert "edge" in result.stderr


@pytest.mark.slow
def test_an_error_is_one_sentence_and_no_traceback():
    result = run("track", "nowhere/at/all", "--out", "x.csv")
    assert result.returncode == 2
    assert "nowhere/at/all" in result.stderr
    assert "Traceback" not in result.stderr


@pytest.mark.slow
def test_system_error_of_a_file_is_one_sentence(tmp_path):
    file = tmp_path / "file"
    file.write_text("")
    result = run("demo", "--data", str(file))
    assert result.returncode == 2
    reported = f"{file / 'output'}: Not a directory; check the path and the disk"
    assert result.stderr == f"muster: {reported}\n"
