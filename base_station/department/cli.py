"""``muster department``: many stations under one roof."""

from __future__ import annotations

import logging
import os
import sys
from pathlib import Path
from typing import Annotated

import typer

app = typer.Typer(
    help="A department: shows what all of its stations report.",
    no_args_is_help=True,
    pretty_exceptions_enable=False,
)


@app.callback()
def department() -> None:
    """A department."""


@app.command()
def serve(
    config: Annotated[
        Path | None, typer.Option(help="TOML file with settings; flags overrule it.")
    ] = None,
    data: Annotated[
        Path | None, typer.Option(help="Folder of database and certificates; one a department.")
    ] = None,
    listen: Annotated[
        list[str] | None, typer.Option(help="Where stations connect, tls/HOST:PORT; repeatable.")
    ] = None,
    http: Annotated[str | None, typer.Option(help="Where the page is served, HOST:PORT.")] = None,
    insecure: Annotated[
        bool | None,
        typer.Option("--insecure", help="Accept plain connections from other machines."),
    ] = None,
) -> None:
    """Run the department until Ctrl-C.  Prints `ready http://...` when browsers can connect."""
    from base_station.department.config import DepartmentServerConfig  # noqa: PLC0415
    from shared.config import load_config  # noqa: PLC0415
    from shared.log import set_up_logging  # noqa: PLC0415

    flags = {
        "data": data,
        "bus.listen": listen or None,
        "http.listen": http,
        "insecure": insecure or None,
    }
    settings = load_config(config, DepartmentServerConfig, flags)
    settings.require_encryption()
    set_up_logging(settings.log_level, settings.log_format)
    logging.getLogger("alembic").setLevel(logging.WARNING)
    os.umask(0o077)
    # Imported where needed: it takes its time, and a wrong setting is reported before.
    from base_station.department.program import run_department  # noqa: PLC0415

    run_department(settings, _announce)


def _announce(line: str) -> None:
    typer.echo(line)
    sys.stdout.flush()
