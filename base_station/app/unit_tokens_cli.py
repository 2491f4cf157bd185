"""``muster base unit-tokens``: units that may post their samples, managed at the station."""

from __future__ import annotations

from contextlib import ExitStack
from pathlib import Path
from typing import Annotated

import typer

_BY_COMMAND = "muster base unit-tokens"  # in the audit

unit_tokens = typer.Typer(
    help="Tokens with which units post samples over HTTPS.", no_args_is_help=True
)
Unit = Annotated[str, typer.Argument(help="The unit's id.")]


@unit_tokens.command("list")
def list_unit_tokens(unit: Unit, data: Path = Path("muster-data")) -> None:
    """List ids of the unit's tokens, with the users who made them."""
    from base_station.app.folder_commands import open_accounts  # noqa: PLC0415

    with ExitStack() as closing:
        accounts, _ = open_accounts(data, closing)
        for token in accounts.unit_tokens.of(unit):
            typer.echo(f"{token.token_id}\t{token.username}")


@unit_tokens.command("add")
def add_unit_token(
    unit: Unit,
    user: Annotated[str, typer.Option(help="Whose it is: it ends with this user.")],
    days: Annotated[int | None, typer.Option(min=1, max=3660, help="Else it has no end.")] = None,
    data: Path = Path("muster-data"),
) -> None:
    """Make a token for a unit and print it, once."""
    from base_station.app.folder_commands import open_accounts  # noqa: PLC0415
    from shared.channels import validate_unit_id  # noqa: PLC0415
    from shared.clock import NS_PER_S, SystemClock  # noqa: PLC0415

    validate_unit_id(unit)
    expires_ns = None if days is None else SystemClock().utc_ns() + days * 86_400 * NS_PER_S
    with ExitStack() as closing:
        accounts, records = open_accounts(data, closing)
        token_id, secret = accounts.unit_tokens.add(unit, user, expires_ns)
        records.audit(_BY_COMMAND, "AddedUnitToken", f"{token_id} of unit {unit}")
    typer.echo(secret)


@unit_tokens.command("remove")
def remove_unit_token(unit: Unit, token_id: str, data: Path = Path("muster-data")) -> None:
    """End a token: posts with it are refused from then on."""
    from base_station.app.folder_commands import open_accounts  # noqa: PLC0415
    from shared.errors import UserError  # noqa: PLC0415

    with ExitStack() as closing:
        accounts, records = open_accounts(data, closing)
        if not accounts.unit_tokens.remove(unit, token_id):
            raise UserError(f"{unit} has no token {token_id}")
        records.audit(_BY_COMMAND, "RemovedUnitToken", f"{token_id} of unit {unit}")
