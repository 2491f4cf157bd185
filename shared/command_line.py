"""The root command ``muster``: its subcommands are the entry points ``muster.commands``.

Entry points keep the sides apart: an agent's machine never imports the station, and only
the command that was asked for is loaded; for lists of commands, what each says of itself is read
from its source.
"""

from __future__ import annotations

import ast
import logging
import sys
from collections.abc import Iterable
from importlib.metadata import EntryPoint, entry_points
from importlib.util import find_spec
from pathlib import Path
from typing import Any, NoReturn

import typer
from typer.core import TyperCommand, TyperGroup

from shared.errors import MusterError

COMMANDS = "muster.commands"  # the group of entry points
_GROUP_HELP = {"bench": "Measure this build on this machine."}


def main() -> NoReturn:
    """Run the installed commands."""
    run(entry_points(group=COMMANDS))


def run(points: Iterable[EntryPoint]) -> NoReturn:
    """Run a command line; a MusterError becomes one sentence on stderr and exit code 2.

    So does what the system says of a file that no command had expected to be out of reach.
    """
    program = build_program(points)
    try:
        program(prog_name="muster")
    except MusterError as error:
        print(f"muster: {error}", file=sys.stderr)
        sys.exit(2)
    except OSError as error:
        if error.filename is None:
            raise
        logging.getLogger(__name__).debug("ended by the system", exc_info=True)
        print(f"muster: {_in_words(error)}", file=sys.stderr)
        sys.exit(2)
    sys.exit(0)


def _in_words(error: OSError) -> str:
    reason = f"{error.filename}: {error.strerror}"
    if isinstance(error, PermissionError):
        return f"{reason}; run this as the user to whom it belongs"
    return f"{reason}; check the path and the disk"


def build_program(points: Iterable[EntryPoint]) -> TyperGroup:
    """A command of the given entry points, none of which it has loaded yet."""
    program = _group(
        "muster", "Responder tracking: edge agents, base station, replay.", completes=True
    )
    groups = {"": program}
    for point in sorted(points, key=lambda point: point.name):
        group_name, _, name = point.name.rpartition(".")
        if group_name not in groups:
            groups[group_name] = _group(group_name, _GROUP_HELP[group_name])
            program.add_command(groups[group_name])
        groups[group_name].add_command(_Listed(name, point))
    return program


class _Listed(TyperCommand):
    """Stands in a list for a command that is not loaded."""

    def __init__(self, name: str, point: EntryPoint) -> None:
        super().__init__(name)
        self._point = point

    def loaded(self) -> TyperCommand | TyperGroup:
        holder = typer.Typer()
        command = self._point.load()
        if isinstance(command, typer.Typer):
            holder.add_typer(command, name=self.name)
        else:
            holder.command(self.name)(command)
        (made,) = typer.main.get_group(holder).commands.values()
        assert isinstance(made, TyperCommand | TyperGroup)
        return made

    def describe(self) -> None:
        """Read the help of a function or a group in its source, or load what names it."""
        self.help = _help_in_source(self._point) or self.loaded().help


class _Commands(TyperGroup):
    """Loads the command that is to run."""

    def get_command(self, ctx: Any, cmd_name: str) -> Any:
        found = super().get_command(ctx, cmd_name)
        if isinstance(found, _Listed):
            found.describe()
        return found

    def resolve_command(self, ctx: Any, args: list[str]) -> Any:
        name, found, rest = super().resolve_command(ctx, args)
        return name, found.loaded() if isinstance(found, _Listed) else found, rest


def _help_in_source(point: EntryPoint) -> str | None:
    """Help of the function or ``typer.Typer(help=...)`` that a point names, if it is one; only
    its packages are imported.
    """
    spec = find_spec(point.module)
    if spec is None or spec.origin is None:
        return None
    for node in ast.parse(Path(spec.origin).read_text(encoding="utf-8")).body:
        match node:
            case ast.FunctionDef(name=point.attr):
                return ast.get_docstring(node)
            case ast.Assign(targets=[ast.Name(id=point.attr)], value=ast.Call(keywords=keywords)):
                return _constant(keywords, "help")
    return None


def _constant(keywords: list[ast.keyword], name: str) -> str | None:
    for keyword in keywords:
        if keyword.arg == name and isinstance(keyword.value, ast.Constant):
            return str(keyword.value.value)
    return None


def _group(name: str, description: str, *, completes: bool = False) -> _Commands:
    app = typer.Typer(
        name=name, cls=_Commands, help=description, no_args_is_help=True, add_completion=completes
    )
    app.callback()(_nothing)  # makes it a group
    group = typer.main.get_command(app)
    assert isinstance(group, _Commands)
    return group


def _nothing() -> None:
    return None


if __name__ == "__main__":
    main()
