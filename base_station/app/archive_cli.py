"""``muster base archive``: copies of closed incidents on another disk or in a bucket."""

from __future__ import annotations

from datetime import UTC, datetime
from pathlib import Path
from typing import Annotated

import typer

from base_station.app.progress_bar import progress_bar
from shared.clock import NS_PER_S
from shared.end_signals import sigterm_as_ctrl_c
from shared.out_file import writable

archive = typer.Typer(help="Copies of incidents on a disk or in a bucket.", no_args_is_help=True)

_Archive = Annotated[str, typer.Argument(metavar="ARCHIVE", help="A folder, or s3://BUCKET/PLACE.")]


@archive.command("copy")
def copy_incidents(
    archive: _Archive,
    data: Path = Path("muster-data"),
    radio: Annotated[
        bool, typer.Option("--radio", help="With the audio of the radio channels.")
    ] = False,
) -> None:
    """Copy all closed incidents that the archive lacks, or of which more has become known since.

    The station may be running.  If the command is interrupted, or the archive cannot be reached,
    the next run continues.
    """
    from base_station.app.archive_sources import open_copier  # noqa: PLC0415

    count = 0
    with (
        sigterm_as_ctrl_c(),
        open_copier(archive, data, with_radio=radio) as copier,
        progress_bar("copying") as on_progress,
    ):
        for done in copier.copy_due(on_progress):
            count += 1
            typer.echo(
                f"{done.incident_id}\t{done.size_bytes / 1e6:.1f} MB"
                if done.size_bytes
                else f"{done.incident_id}\tis there already"
            )
            for words in done.damage:
                typer.echo(
                    f"{done.incident_id}: not copied, for it cannot be read: {words}", err=True
                )
    typer.echo(f"{archive}: {count} incidents copied, all that are closed are there")


@archive.command("list")
def list_incidents(archive: _Archive) -> None:
    """List the incidents in the archive, in time order."""
    from base_station.archive.catalogue import archived_ids, require_entry  # noqa: PLC0415
    from base_station.archive.store import open_store  # noqa: PLC0415

    store = open_store(archive)
    entries = [require_entry(store, one) for one in archived_ids(store)]
    for entry in sorted(entries, key=lambda one: one.opened_ns):
        opened = datetime.fromtimestamp(entry.opened_ns / NS_PER_S, UTC)
        size_mb = sum(one.size_bytes for one in entry.files) / 1e6
        typer.echo(
            f"{entry.incident_id}\t{opened:%Y-%m-%d %H:%M:%S}\t{size_mb:.1f} MB\t"
            f"{len(entry.people)} people\t{' '.join(entry.alarm_rules)}\t{entry.name}"
        )
    typer.echo(f"{len(entries)} incidents", err=True)


@archive.command("verify")
def verify(archive: _Archive) -> None:
    """Read the whole archive and compare it with its checksums; exit code 1 if anything differs."""
    from base_station.archive.checking import defects_of  # noqa: PLC0415
    from base_station.archive.store import open_store  # noqa: PLC0415

    store = open_store(archive)
    count = 0
    with sigterm_as_ctrl_c(), progress_bar("reading") as on_progress:
        for incident_id, words in defects_of(store, on_progress):
            count += 1
            typer.echo(f"{incident_id}: {words}")
    typer.echo(f"{archive}: {count} defects")
    if count:
        raise typer.Exit(1)


@archive.command("fetch")
def fetch(
    archive: _Archive,
    incident: Annotated[str, typer.Argument(help="Its id.")],
    out: Annotated[Path, typer.Argument(help="File to write: incident.mcap.", callback=writable)],
) -> None:
    """Fetch an incident as one file that stands alone: report, export and assess accept it."""
    from base_station.archive.catalogue import require_entry  # noqa: PLC0415
    from base_station.archive.checking import fetch_log  # noqa: PLC0415
    from base_station.archive.store import open_store  # noqa: PLC0415

    store = open_store(archive)
    with sigterm_as_ctrl_c(), progress_bar("fetching") as on_progress:
        fetch_log(store, require_entry(store, incident), out, on_progress)
    typer.echo(f"{out}: {out.stat().st_size / 1e6:.1f} MB; muster base replay {out}")
