"""The root command ``muster``: its subcommands are the entry points ``muster.commands``.

Entry points keep the sides apart: an agent's machine never imports the station, and only
the command that was asked for is loaded.
"""

from __future__ import annotations

import sys
from collections.abc import Sequence
from importlib.metadata import EntryPoint, entry_points
from typing import NoReturn

import typer

from shared.errors import MusterError

_GROUP_HELP = {"bench": "Measure this build on this machine."}


def main() -> NoReturn:
    """Run the command line; a MusterError becomes one sentence on stderr and exit code 2."""
    commands = tuple(sorted(entry_points(group="muster.commands"), key=lambda point: point.name))
    app = build_app(_asked_for(commands, sys.argv[1:]))
    try:
        app(prog_name="muster")
    except MusterError as error:
        print(f"muster: {error}", file=sys.stderr)
        sys.exit(2)
    sys.exit(0)


def build_app(commands: Sequence[EntryPoint]) -> typer.Typer:
    """A typer application of the given entry points, loading each."""
    app = _group("Responder tracking: edge agents, base station, replay.")
    groups: dict[str, typer.Typer] = {}
    for point in commands:
        group_name, _, name = point.name.rpartition(".")
        parent = app
        if group_name:
            if group_name not in groups:
                groups[group_name] = _group(_GROUP_HELP[group_name])
                app.add_typer(groups[group_name], name=group_name)
            parent = groups[group_name]
        command = point.load()
        if isinstance(command, typer.Typer):
            parent.add_typer(command, name=name)
        else:
            parent.command(name)(command)
    return app


def _asked_for(commands: Sequence[EntryPoint], arguments: Sequence[str]) -> tuple[EntryPoint, ...]:
    """The entry point that the arguments name; all of them for help and for a mistyped name."""
    typed = (".".join(arguments[:depth]) for depth in (2, 1))
    for name in typed:
        found = tuple(point for point in commands if point.name == name)
        if found:
            return found
    return tuple(commands)


def _group(description: str) -> typer.Typer:
    app = typer.Typer(help=description, no_args_is_help=True, pretty_exceptions_enable=False)
    # A callback keeps a group with a single command a group.
    app.callback()(_nothing)
    return app


def _nothing() -> None:
    return None


if __name__ == "__main__":
    main()
