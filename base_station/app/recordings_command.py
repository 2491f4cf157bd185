"""``muster base fetch-recording``: a unit's raw recording, over the bus, with a progress bar."""

from __future__ import annotations

from datetime import datetime
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from shared.clock import NS_PER_S
from shared.errors import UserError

if TYPE_CHECKING:
    from rich.progress import Progress, TaskID

    from base_station.unit_sync.recordings.transfer import Transfer


def fetch_recording(
    unit: Annotated[str, typer.Argument(help="Whose black box.")],
    incident: Annotated[str, typer.Option(help="All of this incident; its id.")] = "",
    from_: Annotated[
        str, typer.Option("--from", help="Or from this time, 2026-11-21T14:30 or with +00:00.")
    ] = "",
    to: Annotated[str, typer.Option("--to", help="Until this time; left out: now.")] = "",
    config: Annotated[Path | None, typer.Option(help="TOML file of the station.")] = None,
    data: Annotated[Path | None, typer.Option(help="Folder of the station.")] = None,
    listen: Annotated[
        list[str] | None, typer.Option(help="Where the station's router listens.")
    ] = None,
) -> None:
    """Transfer a unit's raw recording while the station runs; if it is started again, it
    continues.
    """
    from rich.progress import BarColumn, DownloadColumn, Progress, TextColumn  # noqa: PLC0415

    from base_station.app.recordings_app import pull, since, window_of  # noqa: PLC0415
    from base_station.config import StationConfig  # noqa: PLC0415
    from base_station.unit_sync.recordings.transfer import TransferRequest  # noqa: PLC0415
    from shared.config import load_config  # noqa: PLC0415

    if bool(incident) == bool(from_):
        raise UserError("say which window: --incident ID, or --from and perhaps --to")
    flags = {"data": data, "bus.listen": listen or None}
    settings = load_config(config, StationConfig, flags)
    if incident:
        from_ns, to_ns = window_of(settings, incident)
    else:
        from_ns, to_ns = (_ns(from_), _ns(to)) if to else since(settings, _ns(from_))
    if to_ns <= from_ns:
        raise UserError("the window ends before it begins; turn the two times round")
    columns = TextColumn("{task.description}"), BarColumn(), DownloadColumn()
    with Progress(*columns, transient=True) as progress:
        task = progress.add_task(f"{unit}: asking", total=None)
        folder, problem = pull(
            settings,
            TransferRequest(unit, from_ns, to_ns),
            lambda fetch: _show(progress, task, fetch),
        )
    came = problem or "whole, every hash the unit's own"
    typer.echo(f"{folder}: {came}; see `muster track --help`")


def _show(progress: Progress, task: TaskID, fetch: Transfer) -> None:
    progress.update(
        task,
        description=fetch.problem or fetch.wanted.unit_id,
        completed=fetch.done_bytes,
        total=fetch.total_bytes or None,
    )


def _ns(text: str) -> int:
    """Station time in nanoseconds; a time without a zone is in this machine's zone."""
    try:
        return round(datetime.fromisoformat(text).timestamp() * NS_PER_S)
    except ValueError:
        raise UserError(f"{text!r} is no time; write 2026-11-21T14:30 or with +00:00") from None
