"""Commands ``muster edge``: run an agent, and list what it can be made of."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from edge.app.calibrate import calibrate
from edge.app.forget_steps import forget_steps
from edge.app.retrack_command import retrack
from shared.options import finite

app = typer.Typer(
    help="One agent for each wearable.", no_args_is_help=True, pretty_exceptions_enable=False
)

# Headings of the list of commands.
_OPERATION = "On a unit"
_DESK = "Elsewhere"


Config = Annotated[Path | None, typer.Option(help="TOML file with settings; flags overrule it.")]
Unit = Annotated[str | None, typer.Option(help="Name of this unit.")]
SamplesFrom = Annotated[
    str | None, typer.Option(help="Where samples come from; `muster edge sources` lists the kinds.")
]
Sensors = Annotated[
    list[str] | None,
    typer.Option(
        "--sensor",
        help="One of several sensors on one person, as NAME=SOURCE; a NAME such as left_foot or "
        "lower_back says where it is worn; may be repeated.",
    ),
]
WornOn = Annotated[
    str | None,
    typer.Option(help="Part of the body that wears the only sensor: foot, chest, lower_back ..."),
]
Sightings = Annotated[
    str | None, typer.Option(help="A reader of beacons and tags: tcp:HOST:PORT or a device's path.")
]
Gps = Annotated[
    str | None,
    typer.Option(
        help="A satellite receiver: gpsd://HOST:PORT, nmea:/dev/PORT?baud=9600 or "
        "nmea:tcp://HOST:PORT."
    ),
]
Temperature = Annotated[
    list[str] | None,
    typer.Option(
        help="A temperature sensor, as hwmon:CHIP, iio:DEVICE or w1:ID with "
        "?name=NAME&role=environment or electronics; may be repeated."
    ),
]
Battery = Annotated[
    str | None,
    typer.Option(
        help="The battery of this computer: its name in /sys/class/power_supply, or auto where "
        "there is one."
    ),
]
Button = Annotated[
    str | None,
    typer.Option(
        help="The wearer's button, which calls a mayday: evdev:NAME?key=KEY_POWER or "
        "evdev:/dev/input/eventN."
    ),
]
Output = Annotated[
    list[str] | None,
    typer.Option(
        help="An output that notifies the wearer: led:NAME, beeper:/dev/input/DEVICE, "
        "sound:default or speech:VOICE; may be repeated."
    ),
]
Enrolment = Annotated[
    Path | None,
    typer.Option(
        help="File from `muster pki enroll`, or a picture of its QR code: who this unit is."
    ),
]
Connect = Annotated[
    list[str] | None,
    typer.Option(
        help="The station, tls/HOST:PORT or tcp/HOST:PORT; may be repeated. discover: look for it "
        "on the network, too."
    ),
]
Data = Annotated[
    Path | None, typer.Option(help="Folder for journal and black box, one below it a unit.")
]
TrackedBy = Annotated[
    str | None,
    typer.Option(
        help="`muster edge trackers` lists them; by-place: by where the sensors are worn; auto: "
        "recognise that by their motion; none: track on another machine."
    ),
]
Calibrated = Annotated[
    Path | None, typer.Option(help="File from `muster edge calibrate` for these sensors.")
]
ForSeconds = Annotated[
    float | None,
    typer.Option("--for", help="Stop after this many seconds.", min=0.0, max=1e9, callback=finite),
]
Speed = Annotated[
    float | None, typer.Option(help="Play a recording at this multiple of real time.")
]
Unpaced = Annotated[
    bool, typer.Option("--as-fast-as-possible", help="Play a recording without waiting.")
]

CheckSeconds = Annotated[
    float,
    typer.Option(
        "--for", help="Seconds to watch the sensors.", min=1.0, max=600.0, callback=finite
    ),
]
AsJson = Annotated[bool, typer.Option("--json", help="Print the findings for a script.")]


@app.command(rich_help_panel=_OPERATION)
def run(
    config: Config = None,
    unit: Unit = None,
    source: SamplesFrom = None,
    sensor: Sensors = None,
    worn_on: WornOn = None,
    sightings: Sightings = None,
    gps: Gps = None,
    temperature: Temperature = None,
    battery: Battery = None,
    button: Button = None,
    output: Output = None,
    enrolment: Enrolment = None,
    connect: Connect = None,
    data: Data = None,
    tracker: TrackedBy = None,
    calibration: Calibrated = None,
    for_s: ForSeconds = None,
    speed: Speed = None,
    as_fast_as_possible: Unpaced = False,
) -> None:
    """Run one agent until its source ends, Ctrl-C, or --for is over."""
    # Only this command needs what these import, and they take their time.
    from edge.app.run import run_agent  # noqa: PLC0415
    from edge.config import EdgeConfig  # noqa: PLC0415
    from shared.config import load_config  # noqa: PLC0415
    from shared.end_signals import end_requested  # noqa: PLC0415
    from shared.log import set_up_logging  # noqa: PLC0415

    flags = {
        "unit": unit,
        "enrolment": enrolment,
        "source": source,
        "sensors": _sensor_tables(sensor),
        "worn_on": worn_on,
        "sightings": sightings,
        "gps": gps,
        "temperatures": temperature,
        "battery": battery,
        "button": button,
        "outputs": output,
        "connect": connect,
        "data": data,
        "tracker": tracker,
        "calibration": calibration,
        "speed": speed,
    }
    settings = load_config(config, EdgeConfig, flags)
    set_up_logging(settings.log_level, settings.log_format)
    stop = end_requested()
    run_agent(settings, stop, for_s=for_s, paced=not as_fast_as_possible)


@app.command(rich_help_panel=_OPERATION)
def check(
    config: Config = None,
    unit: Unit = None,
    source: SamplesFrom = None,
    sensor: Sensors = None,
    worn_on: WornOn = None,
    sightings: Sightings = None,
    gps: Gps = None,
    temperature: Temperature = None,
    battery: Battery = None,
    button: Button = None,
    output: Output = None,
    enrolment: Enrolment = None,
    connect: Connect = None,
    data: Data = None,
    calibration: Calibrated = None,
    for_s: CheckSeconds = 10.0,
    as_json: AsJson = False,
) -> None:
    """Check a unit, lying still, before its wearer goes in; exit code 1: it is not ready."""
    # Only this command needs what these import, and they take their time.
    from edge.app.check import print_check  # noqa: PLC0415
    from edge.config import EdgeConfig  # noqa: PLC0415
    from shared.config import load_config  # noqa: PLC0415
    from shared.log import set_up_logging  # noqa: PLC0415

    flags = {
        "unit": unit,
        "enrolment": enrolment,
        "source": source,
        "sensors": _sensor_tables(sensor),
        "worn_on": worn_on,
        "sightings": sightings,
        "gps": gps,
        "temperatures": temperature,
        "battery": battery,
        "button": button,
        "outputs": output,
        "connect": connect,
        "data": data,
        "calibration": calibration,
    }
    settings = load_config(config, EdgeConfig, flags)
    set_up_logging("ERROR")  # what would be logged is a finding
    if not print_check(settings, for_s, as_json=as_json):
        raise typer.Exit(1)


@app.command("learn-steps", rich_help_panel=_OPERATION)
def learn_steps(
    length_m: Annotated[
        float,
        typer.Option(help="Length of the walk in metres, measured with a tape.", callback=finite),
    ],
    person: Annotated[
        str | None, typer.Option(help="The wearer, as wearer.person in the unit's settings.")
    ] = None,
    config: Config = None,
    unit: Unit = None,
    source: SamplesFrom = None,
    worn_on: WornOn = None,
    enrolment: Enrolment = None,
    data: Data = None,
    calibration: Calibrated = None,
    for_s: ForSeconds = None,
) -> None:
    """Learn the length of a person's steps by one walk of known length; Ctrl-C ends the walk."""
    # Only this command needs what these import, and they take their time.
    from edge.app import learn_steps as steps  # noqa: PLC0415
    from edge.config import EdgeConfig  # noqa: PLC0415
    from shared.config import load_config  # noqa: PLC0415
    from shared.end_signals import end_requested  # noqa: PLC0415
    from shared.log import set_up_logging  # noqa: PLC0415

    flags = {
        "unit": unit,
        "enrolment": enrolment,
        "source": source,
        "worn_on": worn_on,
        "data": data,
        "calibration": calibration,
    }
    settings = steps.with_person(load_config(config, EdgeConfig, flags), person)
    set_up_logging(settings.log_level, settings.log_format)
    steps.learn_steps(settings, length_m, for_s, end_requested())


@app.command(rich_help_panel=_OPERATION)
def enrol(
    picture: Annotated[
        Path, typer.Argument(help="The enrolment's QR code: a photo, or as the console saved it.")
    ],
    out: Annotated[
        Path | None, typer.Option(help="The enrolment file; else NAME.enrolment.toml.")
    ] = None,
) -> None:
    """Make the enrolment file from a photograph of its QR code."""
    from shared.enrolment import read_enrolment  # noqa: PLC0415

    enrolment = read_enrolment(picture)
    target = out or Path(f"{enrolment.name}.enrolment.toml")
    enrolment.write(target)
    typer.echo(f"{target}: {enrolment.holder.value} {enrolment.name}; delete {picture}")


@app.command(rich_help_panel=_OPERATION)
def sources() -> None:
    """List the sources of samples and the other sensors that a unit can read."""
    from edge.notifiers.registry import NOTIFIERS  # noqa: PLC0415
    from edge.sources.gnss.registry import RECEIVERS  # noqa: PLC0415
    from edge.sources.registry import SOURCES  # noqa: PLC0415
    from edge.sources.temperature.registry import TEMPERATURE_SENSORS  # noqa: PLC0415
    from edge.wearer.registry import BUTTONS  # noqa: PLC0415

    for kind in SOURCES:
        typer.echo(f"{kind.scheme}:{kind.argument}")
    for receiver in RECEIVERS:
        typer.echo(f"--gps {receiver.scheme}:{receiver.argument}")
    for sensor in TEMPERATURE_SENSORS:
        typer.echo(f"--temperature {sensor.scheme}:{sensor.argument}")
    typer.echo("--battery NAME or auto")
    for button in BUTTONS:
        typer.echo(f"--button {button.scheme}:{button.argument}")
    for output in NOTIFIERS:
        typer.echo(f"--output {output.scheme}:{output.argument}")


@app.command(rich_help_panel=_OPERATION)
def trackers() -> None:
    """List the trackers."""
    from edge.tracker.registry import MULTI_SENSOR_TRACKERS, TRACKERS  # noqa: PLC0415

    one = [(entry.name, entry.summary) for entry in TRACKERS]
    several = [(entry.name, entry.summary) for entry in MULTI_SENSOR_TRACKERS]
    for name, summary in (*one, *several):
        typer.echo(f"{name:14} {summary}")


@app.command(rich_help_panel=_DESK)
def plan() -> None:
    """Print the plan of the building in which simulated responders work, as GeoJSON."""
    from edge.simulation.building import plan_path  # noqa: PLC0415

    typer.echo(plan_path().read_text())


@app.command("compile", rich_help_panel=_OPERATION)
def compile_(
    *,
    one_process: Annotated[
        bool,
        typer.Option(
            "--one-process", help="All of them in one process: quicker, and needs more memory."
        ),
    ] = False,
) -> None:
    """Compile the trackers now, so that the first start is quick."""
    from edge.app.jit_warmup import compile_trackers  # noqa: PLC0415

    compile_trackers(one_process=one_process)


def _sensor_tables(given: list[str] | None) -> list[dict[str, str]] | None:
    """Return NAME=SOURCE of each sensor as in a settings file; None where none is given."""
    if not given:
        return None
    tables = []
    for text in given:
        name, equals, source = text.partition("=")
        if not (name and equals and source):
            raise typer.BadParameter(
                f"--sensor {text!r}: write NAME=SOURCE, as in left_foot=ximu3:tcp://192.168.1.1"
            )
        tables.append({"name": name, "source": source})
    return tables


app.command(rich_help_panel=_OPERATION)(calibrate)
app.command("forget-steps", rich_help_panel=_OPERATION)(forget_steps)
app.command(rich_help_panel=_DESK)(retrack)
