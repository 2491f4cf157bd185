"""``muster base import``: bring files from elsewhere into an incident, or remove them."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from shared.end_signals import sigterm_as_ctrl_c
from shared.errors import UserError
from shared.options import finite

if TYPE_CHECKING:
    from base_station.app.import_folder import FolderImports

COMMAND = "muster base import"  # in the audit


def import_(
    incident: Annotated[str, typer.Argument(help="Its id, as in the console.")],
    files: Annotated[
        list[Path] | None,
        typer.Argument(
            help="GPX or KML tracks, photographs with a place and a time, or incidents of other "
            "stations (MCAP); none: what was brought in is listed."
        ),
    ] = None,
    data: Annotated[Path, typer.Option(help="Folder of the station.")] = Path("muster-data"),
    shift_s: Annotated[
        float,
        typer.Option(
            callback=finite,
            help="Seconds to add to the times of the files, whose clock was off.",
        ),
    ] = 0.0,
    utc_offset_h: Annotated[
        float | None,
        typer.Option(
            min=-14.0, max=14.0, help="Hours of a camera's clock before UTC, where it states none."
        ),
    ] = None,
    remove: Annotated[
        list[str] | None,
        typer.Option(help="Id of a file, as listed, to be taken out again; repeatable."),
    ] = None,
) -> None:
    """Make files from elsewhere a part of an incident: tracks, photographs, another station's
    incident.

    They are kept unchanged, and shown as brought in.  A station may be running on the folder.
    """
    with sigterm_as_ctrl_c(), _opened(data, incident) as imports:
        for import_id in remove or ():
            typer.echo(f"taken out: {imports.remove(import_id)}")
        refused = 0
        for file in files or ():
            try:
                for line in imports.import_file(file, shift_s, utc_offset_h):
                    typer.echo(line)
            except UserError as error:  # the others are brought in all the same
                typer.echo(str(error), err=True)
                refused += 1
        if not files and not remove:
            for line in imports.lines():
                typer.echo(line)
    if refused:
        raise UserError(f"{refused} of {len(files or ())} files were not brought in")


@contextmanager
def _opened(data: Path, incident_id: str) -> Iterator[FolderImports]:
    from base_station.app.import_folder import open_imports  # noqa: PLC0415

    with open_imports(data, incident_id, COMMAND) as imports:
        yield imports
