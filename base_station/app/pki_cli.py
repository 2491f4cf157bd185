"""``muster pki``: certificates of those who may take part, and their kinds."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from datetime import timedelta
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from shared.enrolment import Enrolment, Holder

if TYPE_CHECKING:
    from base_station.security.pki.folder import PkiFolder

app = typer.Typer(
    help="The station's certificate authority: enrol units, revoke them, see who is enrolled.",
    no_args_is_help=True,
    pretty_exceptions_enable=False,
)

Name = Annotated[
    str, typer.Argument(help="The unit (also with --tracker), or with --operator the person.")
]
Data = Annotated[Path, typer.Option(help="The station's data folder.")]
Days = Annotated[int, typer.Option(min=1, max=3650, help="How long the certificate is valid.")]
Operator = Annotated[
    bool, typer.Option("--operator", help="An operator's program, which only listens.")
]
Tracker = Annotated[
    bool, typer.Option("--tracker", help="The agent that tracks for the unit of this name.")
]
DepartmentStation = Annotated[
    bool,
    typer.Option("--department-station", help="A station that reports to this department."),
]
Connect = Annotated[
    list[str] | None,
    typer.Option(help="tls/HOST:PORT to write into the enrolment, if not the station's own."),
]
Host = Annotated[
    list[str] | None,
    typer.Option(
        help="Name or address that units reach this station by, the first one the one they are "
        "given; may be repeated; else those this machine has now."
    ),
]
Port = Annotated[int, typer.Option(min=1, max=65535, help="Of the bus.")]
Out = Annotated[Path | None, typer.Option(help="The enrolment file; else NAME.enrolment.toml.")]
Qr = Annotated[bool, typer.Option("--qr", help="Show a QR code instead of writing a file.")]
Png = Annotated[Path | None, typer.Option(help="Write the QR code as a picture.")]
_DATA = Path("muster-data")


@app.command()
def init(
    data: Data = _DATA,
    organisation: Annotated[str, typer.Option(help="Whose station this is.")] = "Muster",
    host: Host = None,
    port: Port = 7447,
    days: Days = 365,
) -> None:
    """Make the authority and this station's certificate, once."""
    # Only this command needs these imports, and they take their time.
    from base_station.security.pki.folder import PkiFolder  # noqa: PLC0415

    hosts, endpoint = _station_hosts(host, port)
    folder = PkiFolder(data)
    folder.create(organisation, hosts, [endpoint], timedelta(days=days))
    typer.echo(f"{folder.path}: authority and certificate of {organisation}'s station")
    typer.echo(f"valid for: {', '.join(folder.registry().hosts)}")
    typer.echo(f"units will connect to {endpoint}; enrol one with `muster pki enroll UNIT`")
    typer.echo(f"keep a copy of {folder.path} where no other person can read it")


def _issuing(
    issue: Callable[[PkiFolder, str, Holder, timedelta, Sequence[str]], Enrolment],
) -> Callable[..., None]:
    """A command that makes a certificate and hands it over."""

    def command(
        name: Name,
        data: Data = _DATA,
        operator: Operator = False,
        tracker: Tracker = False,
        department_station: DepartmentStation = False,
        days: Days = 365,
        connect: Connect = None,
        out: Out = None,
        qr: Qr = False,
        png: Png = None,
    ) -> None:
        from base_station.security.pki.folder import PkiFolder  # noqa: PLC0415
        from base_station.security.pki.hosts import require_endpoint  # noqa: PLC0415

        holder = _holder(operator, tracker, department_station)
        endpoints = [require_endpoint(one) for one in connect or ()]
        target = _free_target(name, holder, out, png, qr=qr)
        valid = timedelta(days=days)
        _output_enrolment(
            issue(PkiFolder(data), name, holder, valid, endpoints), target, png, qr=qr
        )

    return command


app.command("enroll", help="Make a certificate for a unit, as one file or QR code to carry to it.")(
    _issuing(lambda folder, *what: folder.enroll(*what))
)
app.command(
    "renew", help="Make a new certificate for an enrolled name; the old one works until it ends."
)(_issuing(lambda folder, *what: folder.renew(*what)))


@app.command()
def renew_station(
    data: Data = _DATA,
    host: Annotated[
        list[str] | None, typer.Option(help="As for init, where they are others now.")
    ] = None,
    port: Annotated[
        int | None,
        typer.Option(min=1, max=65535, help="Of the bus, 7447 if left out; goes with --host."),
    ] = None,
    days: Days = 365,
) -> None:
    """Make a new certificate for this station; a running router takes it up by itself."""
    from base_station.security.pki.folder import PkiFolder  # noqa: PLC0415
    from shared.errors import ConfigError  # noqa: PLC0415

    if port is not None and not host:
        raise ConfigError("for another --port say with --host where units reach it, too")
    folder = PkiFolder(data)
    hosts, endpoint = _station_hosts(host, port or 7447) if host else ([], "")
    folder.renew_station(timedelta(days=days), hosts, [endpoint] if endpoint else [])
    typer.echo(f"valid for {days} days and: {', '.join(folder.registry().hosts)}")


@app.command()
def enroll_station(
    name: Annotated[str, typer.Argument(help="Of the further station, as in its [standby].")],
    host: Annotated[
        list[str],
        typer.Option(help="Name or address of that station, the first one for units; repeatable."),
    ],
    data: Data = _DATA,
    port: Port = 7447,
    days: Days = 365,
    out: Annotated[Path | None, typer.Option(help="The file; else NAME.station.toml.")] = None,
) -> None:
    """Make the file with which a second machine becomes a station of this authority."""
    from base_station.security.pki.folder import PkiFolder  # noqa: PLC0415

    hosts, endpoint = _station_hosts(host, port)
    target = out or Path(f"{name}.station.toml")
    _require_free(target)
    folder = PkiFolder(data)
    folder.enroll_station(name, hosts, endpoint, timedelta(days=days)).write(target)
    typer.echo(f"{target}: carry it to {name} and keep no other copy; it holds a private key")
    typer.echo(f"there: `muster pki join {target.name} --data DIR`; see docs/standby.md")
    typer.echo(f"units find both stations: {', '.join(folder.registry().connect)}")
    typer.echo("units that were enrolled before: give them both with --connect, or renew them")


@app.command()
def join(
    file: Annotated[Path, typer.Argument(help="From `muster pki enroll-station`.")],
    data: Data = _DATA,
) -> None:
    """Make this machine a further station of another one's authority."""
    from base_station.security.pki.folder import PkiFolder  # noqa: PLC0415
    from base_station.security.pki.station_enrolment import read_station_enrolment  # noqa: PLC0415

    enrolment = read_station_enrolment(file)
    folder = PkiFolder(data)
    folder.join(enrolment)
    typer.echo(f"{folder.path}: this is station {enrolment.name}; delete {file}")


@app.command()
def revoke(
    name: Name,
    data: Data = _DATA,
    operator: Operator = False,
    tracker: Tracker = False,
    department_station: DepartmentStation = False,
) -> None:
    """Shut a lost unit out: within seconds where a router runs."""
    from base_station.security.pki.folder import PkiFolder  # noqa: PLC0415

    holder = _holder(operator, tracker, department_station)
    PkiFolder(data).revoke(name, holder)
    typer.echo(f"{holder.value} {name} is shut out; a running router takes it up within seconds")


@app.command()
def show(data: Data = _DATA) -> None:
    """List enrolled names with the ends of their certificates."""
    from datetime import UTC, datetime  # noqa: PLC0415

    from base_station.security.pki.expiry import EXPIRY_WARNING, about_to_expire  # noqa: PLC0415
    from base_station.security.pki.folder import PkiFolder  # noqa: PLC0415
    from base_station.security.pki.registry_table import print_registry  # noqa: PLC0415

    folder, now = PkiFolder(data), datetime.now(UTC)
    registry = folder.registry()
    print_registry(registry, now)
    for sentence in about_to_expire(registry, now, EXPIRY_WARNING, folder.own_common_name()):
        typer.secho(sentence, fg=typer.colors.YELLOW)


def _station_hosts(given: list[str] | None, port: int) -> tuple[list[str], str]:
    """The hosts of its certificate, and the endpoint that enrolments name."""
    from base_station.security.pki.hosts import own_hosts, require_host, tls_endpoint  # noqa: PLC0415

    hosts = [require_host(host) for host in given] if given else [*own_hosts()]
    return hosts, tls_endpoint(hosts[0] if hosts else "127.0.0.1", port)


def _holder(*chosen: bool) -> Holder:
    """``chosen``: the options --operator, --tracker and --department-station, in this order."""
    if sum(chosen) > 1:
        raise typer.BadParameter("choose one of --operator, --tracker and --department-station")
    kinds = (Holder.OPERATOR, Holder.TRACKER, Holder.DEPARTMENT_STATION)
    return next((kind for kind, one in zip(kinds, chosen, strict=True) if one), Holder.UNIT)


def _free_target(
    name: str, holder: Holder, out: Path | None, png: Path | None, *, qr: bool
) -> Path | None:
    """Path for the file; checked before a certificate is made that could not be handed over."""
    from shared.channels import tracker_id, validate_unit_id  # noqa: PLC0415

    validate_unit_id(name)
    only_code = out is None and (qr or png is not None)
    file_name = tracker_id(name) if holder is Holder.TRACKER else name
    target = None if only_code else out or Path(f"{file_name}.enrolment.toml")
    for path in (target, png):
        if path is not None:
            _require_free(path)
    return target


def _require_free(path: Path) -> None:
    """Before anything is issued: a certificate that cannot be handed over would be in the rules."""
    from shared.errors import ConfigError  # noqa: PLC0415
    from shared.out_file import writable  # noqa: PLC0415

    if path.exists():
        raise ConfigError(f"{path} is there already; choose another place")
    writable(path)


def _output_enrolment(
    enrolment: Enrolment, target: Path | None, png: Path | None, *, qr: bool
) -> None:
    from base_station.security.pki.qr import as_text, qr_code, save_png  # noqa: PLC0415

    if target is not None:
        enrolment.write(target)
        typer.echo(
            f"{target}: carry it to {enrolment.holder.value} {enrolment.name} and keep no other "
            "copy"
        )
        if enrolment.holder is Holder.UNIT:
            typer.echo(f"start the unit with `muster edge run --enrolment {target.name}`")
        elif enrolment.holder is Holder.TRACKER:
            source = f"--source bus:{enrolment.name}"
            typer.echo(f"start it with `muster edge run --enrolment {target.name} {source}`")
        elif enrolment.holder is Holder.DEPARTMENT_STATION:
            typer.echo("there: put it into the settings, [department] enrolment = ...")
    if png is not None:
        save_png(qr_code(enrolment), png, enrolment.renewal_command)
        typer.echo(f"{png}: the enrolment as a QR code")
    if qr:
        typer.echo(as_text(qr_code(enrolment)))
        typer.echo("Save what the scanner reads as a file; the code is not shown again.")
