"""Command ``muster edge calibrate``: guided by a person, or from recordings."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from shared.errors import UserError
from shared.options import finite
from shared.out_file import writable

Out = Annotated[Path, typer.Option(help="The calibration file to write.", callback=writable)]
Unit = Annotated[str, typer.Option(help="Name of the unit whose sensors these are.")]
GuidedBy = Annotated[
    str | None,
    typer.Option(help="Be guided, with samples from here; `muster edge sources` lists them."),
]
Enrolment = Annotated[
    Path | None,
    typer.Option(help="With --source bus:UNIT: file from `muster pki enroll UNIT --tracker`."),
]
Connect = Annotated[
    list[str] | None, typer.Option(help="With --source bus:UNIT: the station, tcp/HOST:PORT.")
]
Speed = Annotated[
    float | None,
    typer.Option(
        help="Play a recorded or simulated unit at this multiple of real time.",
        min=0.01,
        max=1000.0,
        callback=finite,
    ),
]
WithWarmUp = Annotated[
    bool, typer.Option("--with-warm-up", help="Guided: also the temperature, 5 to 60 minutes.")
]
Recording = Annotated[
    str | None,
    typer.Option(help="Recording of this step: a path, or a source such as mcap:PATH."),
]
Sensor = Annotated[
    str | None,
    typer.Option(help="Name of the sensor; guided, the source's own if left out."),
]


def calibrate(
    out: Out,
    unit: Unit = "",
    source: GuidedBy = None,
    enrolment: Enrolment = None,
    connect: Connect = None,
    speed: Speed = None,
    with_warm_up: WithWarmUp = False,
    still: Recording = None,
    poses: Recording = None,
    turning: Recording = None,
    warm_up: Recording = None,
    sensor: Sensor = None,
) -> None:
    """Find the errors of one unit's sensors, and write them to a file for `muster edge run`."""
    # Only this command needs what these import, and they take their time.
    from edge.app.calibration_session import calibrate_guided, calibrate_recorded  # noqa: PLC0415
    from edge.app.run import opened_source  # noqa: PLC0415
    from edge.config import EdgeConfig  # noqa: PLC0415
    from edge.identity import bus_unit  # noqa: PLC0415
    from shared.channels import validate_unit_id  # noqa: PLC0415

    arguments = {"still": still, "poses": poses, "turning": turning, "warm-up": warm_up}
    recordings = {step: text for step, text in arguments.items() if text is not None}
    if (source is None) == (not recordings):
        raise UserError(
            "give either --source to be guided, or recordings: --still, --poses, --turning, "
            "--warm-up"
        )
    if unit:
        validate_unit_id(unit)
    if sensor is not None and not sensor.isprintable():
        raise UserError(f"the sensor's name {sensor!r} has signs that cannot be printed")
    if source is None:
        if with_warm_up:
            raise UserError("--with-warm-up is for being guided; give the recording: --warm-up")
        calibrate_recorded(recordings, out, unit, sensor)
        return
    config = EdgeConfig(source, enrolment=enrolment, connect=tuple(connect or ()))
    followed = bus_unit(config)
    if followed is not None:
        if unit not in ("", followed):
            raise UserError(f"{source} has the samples of {followed}, not of {unit}")
        unit = followed
        typer.echo(f"Waiting for the samples of {unit} ...", err=True)
    with opened_source(config) as opened:
        calibrate_guided(opened, out, unit, sensor, with_warm_up=with_warm_up, speed=speed)
