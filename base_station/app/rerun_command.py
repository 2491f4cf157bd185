"""``muster base rerun``: raw recordings through another tracker, and fusion again."""

from __future__ import annotations

from contextlib import ExitStack
from pathlib import Path
from typing import Annotated

import typer

from base_station.app.progress_bar import progress_bar
from shared.end_signals import sigterm_as_ctrl_c

COMMAND = "muster base rerun"  # in the audit


def rerun(
    incident: Annotated[str, typer.Argument(help="Its id, as in the console.")],
    data: Annotated[Path, typer.Option(help="Folder of the station, or what was given.")] = Path(
        "muster-data"
    ),
    recording: Annotated[
        list[Path] | None,
        typer.Option(help="A unit's black box beside those that were pulled; repeatable."),
    ] = None,
    tracker: Annotated[
        str, typer.Option(help="`muster edge trackers` lists them; else as each unit had it.")
    ] = "",
    calibration: Annotated[
        Path | None,
        typer.Option(
            help="A calibration of the sensor; else as each unit had it.",
            exists=True,
            dir_okay=False,
        ),
    ] = None,
    setting: Annotated[
        list[str] | None,
        typer.Option("--set", help="A setting of the units, as wearer.height_m=1.8; repeatable."),
    ] = None,
    out: Annotated[
        Path | None, typer.Option(help="Folder for the result, not INCIDENT-rerun; goes on in it.")
    ] = None,
    keep: Annotated[
        bool,
        typer.Option(
            "--keep", help="Also bring its trails into the incident: replays show them, dashed."
        ),
    ] = False,
) -> None:
    """Track an incident's raw recordings again, fuse again, and compare with the live result."""
    # Imported where needed: they take their time, and a wrong option is refused before.
    from base_station.app.import_folder import open_imports  # noqa: PLC0415
    from base_station.app.offline_rerun import open_rerun  # noqa: PLC0415
    from base_station.app.offline_rerun import rerun as run_again  # noqa: PLC0415
    from base_station.app.rerun_files import TRAILS, write_rerun  # noqa: PLC0415
    from base_station.app.retracking import RetrackSettings  # noqa: PLC0415
    from base_station.replay.rerun.tables import print_rerun  # noqa: PLC0415

    folder = out or Path(f"{incident}-rerun")
    settings = RetrackSettings(tracker, calibration, tuple(setting or ()))
    with sigterm_as_ctrl_c(), ExitStack() as closing:
        if keep:  # before minutes of work
            with open_imports(data, incident, COMMAND) as imports:
                imports.require_anchor()
        with progress_bar("reading the log") as on_progress:
            opened = open_rerun(data, incident, recording or (), closing, _warn, on_progress)
        with (
            progress_bar("tracking") as on_tracking,
            progress_bar("fusing") as on_fusing,
        ):
            result = run_again(opened, settings, folder, on_tracking, on_fusing)
        print_rerun(result.report)
        written = write_rerun(opened, result, folder)
    typer.echo(f"{', '.join(written)} written to {folder}")
    if keep:
        name = f"rerun-{result.report.tracker or 'as-set'}.gpx"
        with open_imports(data, incident, COMMAND) as imports:
            for line in imports.import_file(folder / TRAILS, name=name):
                typer.echo(line)


def _warn(line: str) -> None:
    typer.echo(line, err=True)
