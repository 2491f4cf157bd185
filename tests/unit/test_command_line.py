"""The root command: its parts, its help, and errors as sentences."""

from __future__ import annotations

import subprocess
import sys
from importlib.metadata import EntryPoint

from typer.testing import CliRunner

from shared.command_line import build_app


def commands(**values: str) -> tuple[EntryPoint, ...]:
    return tuple(
        EntryPoint(name.replace("__", "."), value, "muster.commands")
        for name, value in values.items()
    )


def run(*arguments: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [sys.executable, "-m", "shared.command_line", *arguments],
        capture_output=True,
        text=True,
        check=False,
    )


def test_a_dotted_name_stands_below_its_group():
    app = build_app(commands(messages="shared.message_reference:messages",
                             bench__messages="shared.message_reference:messages"))  # fmt: skip
    for arguments in (["messages"], ["bench", "messages"]):
        result = CliRunner().invoke(app, arguments)
        assert result.exit_code == 0, result.output
        assert "# Channels and messages" in result.output


def test_help_names_every_command():
    result = run("--help")
    assert result.returncode == 0, result.stderr
    for name in ("edge", "base", "bench", "demo", "track"):
        assert name in result.stdout


def test_a_mistyped_command_is_answered_with_the_nearest():
    result = run("edgy")
    assert result.returncode == 2
    assert "edge" in result.stderr


def test_an_error_is_one_sentence_and_no_traceback():
    result = run("track", "nowhere/at/all", "--out", "x.csv")
    assert result.returncode == 2
    assert "nowhere/at/all" in result.stderr
    assert "Traceback" not in result.stderr
