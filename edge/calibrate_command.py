"""``muster edge calibrate``: guide a person through it, or use what was recorded."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from shared.errors import UserError

_RECORDING = "Recording of this step: a path, or a source such as mcap:PATH."


def calibrate(
    out: Annotated[Path, typer.Option(help="The calibration file to write.")],
    unit: Annotated[str, typer.Option(help="Name of the unit whose sensors these are.")] = "",
    source: Annotated[
        str | None,
        typer.Option(help="Be guided, with samples from here; `muster edge sources` lists them."),
    ] = None,
    enrolment: Annotated[
        Path | None,
        typer.Option(help="With --source bus:UNIT: file from `muster pki enroll UNIT --tracker`."),
    ] = None,
    connect: Annotated[
        list[str] | None, typer.Option(help="With --source bus:UNIT: the station, tcp/HOST:PORT.")
    ] = None,
    speed: Annotated[
        float | None,
        typer.Option(help="Play a recorded or simulated unit at this multiple of real time."),
    ] = None,
    with_warm_up: Annotated[
        bool, typer.Option("--with-warm-up", help="Guided: also the temperature, 5 to 60 minutes.")
    ] = False,
    still: Annotated[str | None, typer.Option(help=_RECORDING)] = None,
    poses: Annotated[str | None, typer.Option(help=_RECORDING)] = None,
    turning: Annotated[str | None, typer.Option(help=_RECORDING)] = None,
    warm_up: Annotated[str | None, typer.Option(help=_RECORDING)] = None,
    sensor: Annotated[
        str | None, typer.Option(help="Name of the sensor; the source's own if left out.")
    ] = None,
) -> None:
    """Find the errors of one unit's sensors, and write them to a file for `muster edge run`."""
    # Only this command needs what this imports, and it takes its time.
    from edge.app import opened_source  # noqa: PLC0415
    from edge.calibration.session import (  # noqa: PLC0415
        calibrate_guided,
        calibrate_recorded,
    )
    from edge.config import EdgeConfig  # noqa: PLC0415

    given = {"still": still, "poses": poses, "turning": turning, "warm-up": warm_up}
    recordings = {step: text for step, text in given.items() if text is not None}
    if source is not None and not recordings:
        config = EdgeConfig(source, enrolment=enrolment, connect=tuple(connect or ()))
        if source.startswith("bus:"):
            unit = unit or source.partition(":")[2]
            typer.echo(f"Waiting for the samples of {unit} ...", err=True)
        with opened_source(config) as opened:
            calibrate_guided(opened, out, unit, sensor, with_warm_up=with_warm_up, speed=speed)
    elif source is None and recordings:
        calibrate_recorded(recordings, out, unit, sensor)
    else:
        raise UserError(
            "give either --source to be guided, or recordings: --still, --poses, --turning, "
            "--warm-up"
        )
