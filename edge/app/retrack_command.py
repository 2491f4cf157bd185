"""Command ``muster edge retrack``: a black box, tracked again with other settings."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Annotated

import typer


def retrack(
    recording: Annotated[Path, typer.Argument(help="A black box: the folder of one boot.")],
    out: Annotated[Path, typer.Option(help="New folder for the log of what comes out.")],
    tracker: Annotated[
        str, typer.Option(help="`muster edge trackers` lists them; else as recorded.")
    ] = "",
    calibration: Annotated[
        Path | None,
        typer.Option(help="File from `muster edge calibrate` for the sensor; else as recorded."),
    ] = None,
    setting: Annotated[
        list[str] | None,
        typer.Option("--set", help="A setting of the unit, as wearer.height_m=1.8; repeatable."),
    ] = None,
    person: Annotated[
        str,
        typer.Option(
            help="The wearer, as wearer.person was in the unit's settings: starts with the steps "
            "that the unit has learnt of that person; else with those of people in the mean."
        ),
    ] = "",
    rate_hz: Annotated[float, typer.Option(help="Positions a second.", min=0.1, max=50.0)] = 5.0,
) -> None:
    """Track a black box again as its unit would have, with other settings, for the station.

    Prints the log time reached, in ns, each some seconds of the recording, and to standard error
    at the end with which lengths of steps it was tracked.
    """
    # It takes its time, and a wrong option is refused before.
    from edge.app.retrack import write_retracked  # noqa: PLC0415

    used = write_retracked(
        recording, out, tracker, calibration, setting or (), rate_hz, _print_reached, person
    )
    typer.echo(used, err=True)


def _print_reached(log_ns: int) -> None:
    typer.echo(log_ns)
    sys.stdout.flush()
