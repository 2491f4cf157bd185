"""``muster base users``: accounts that may log in, managed at the station itself."""

from __future__ import annotations

import sys
from contextlib import ExitStack
from pathlib import Path
from typing import Annotated

import typer

_BY_COMMAND = "muster base users"  # in the audit

users = typer.Typer(help="Who may log in.", no_args_is_help=True)


@users.command("list")
def list_users(data: Path = Path("muster-data")) -> None:
    """List the users with their roles."""
    from base_station.app.folder_commands import open_accounts  # noqa: PLC0415

    with ExitStack() as closing:
        accounts, _ = open_accounts(data, closing)
        for user in accounts.users():
            typer.echo(f"{user.username}\t{user.role}")


@users.command("add")
def add_user(
    name: str,
    role: Annotated[str, typer.Option(help="viewer, commander or administrator.")] = "viewer",
    data: Path = Path("muster-data"),
) -> None:
    """Add a user; the password is asked for, or read from standard input."""
    from base_station.accounts.principals import Role  # noqa: PLC0415
    from base_station.app.folder_commands import open_accounts  # noqa: PLC0415

    with ExitStack() as closing:
        accounts, records = open_accounts(data, closing)
        given = Role.of(role)
        accounts.add_user(name, _ask_password(), given)
        records.audit(_BY_COMMAND, "AddedUser", f"{name} as {given.word}")


@users.command("password")
def change_password(name: str, data: Path = Path("muster-data")) -> None:
    """Give a user a new password; their sessions and tokens end."""
    from base_station.app.folder_commands import open_accounts  # noqa: PLC0415

    with ExitStack() as closing:
        accounts, records = open_accounts(data, closing)
        accounts.change_user(name, _ask_password(), None)
        records.audit(_BY_COMMAND, "ChangedUser", f"{name}: password")


@users.command("remove")
def remove_user(name: str, data: Path = Path("muster-data")) -> None:
    """Remove a user with all sessions and tokens."""
    from base_station.app.folder_commands import open_accounts  # noqa: PLC0415

    with ExitStack() as closing:
        accounts, records = open_accounts(data, closing)
        accounts.remove_user(name)
        records.audit(_BY_COMMAND, "RemovedUser", name)


def _ask_password() -> str:
    if sys.stdin.isatty():
        return str(typer.prompt("Password", hide_input=True, confirmation_prompt=True))
    return sys.stdin.readline().rstrip("\n")
