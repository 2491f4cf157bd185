"""``muster base foxglove``: an incident in Foxglove, as it goes on or afterwards."""

from __future__ import annotations

import time
from contextlib import ExitStack
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from shared.errors import ConfigError, LogError
from shared.host_names import is_loopback

if TYPE_CHECKING:
    from base_station.foxglove.server import FoxgloveServer

foxglove = typer.Typer(
    help="Serve the log to Foxglove, as it is written or as a replay.", no_args_is_help=True
)

Data = Annotated[Path, typer.Option(help="The station's folder, or a backup of it.")]
Listen = Annotated[str, typer.Option(help="Where Foxglove connects, HOST:PORT.")]
Insecure = Annotated[
    bool,
    typer.Option(
        "--insecure",
        help="Accept connections from other machines: all who reach the port read every "
        "position, without a login and without encryption.",
    ),
]
_DATA = Path("muster-data")
_LISTEN = "127.0.0.1:8765"
_TURN_S = 0.02


@foxglove.command()
def live(data: Data = _DATA, listen: Listen = _LISTEN, insecure: Insecure = False) -> None:
    """Show the records of a station on this machine, until Ctrl-C."""
    host, port = _listening_address(listen, insecure=insecure)
    from base_station.foxglove.live import follow  # noqa: PLC0415
    from base_station.storage.data_folder import DataFolder  # noqa: PLC0415
    from shared.end_signals import end_requested  # noqa: PLC0415

    folder = DataFolder(data)
    folder.require()
    stop = end_requested()
    with ExitStack() as closing:
        server = _serve(closing, host, port, "Muster")
        follow(folder.log, server, stop)


@foxglove.command()
def replay(
    incident: Annotated[str, typer.Argument(help="Its id, as in the console.")],
    data: Data = _DATA,
    listen: Listen = _LISTEN,
    insecure: Insecure = False,
) -> None:
    """Serve a past incident, which the time bar of Foxglove controls, until Ctrl-C."""
    host, port = _listening_address(listen, insecure=insecure)
    from base_station.app.offline_log import open_offline_log  # noqa: PLC0415
    from base_station.foxglove.replay import LogReplay  # noqa: PLC0415
    from base_station.storage.db.records import Records  # noqa: PLC0415
    from shared.clock import SystemClock  # noqa: PLC0415
    from shared.end_signals import end_requested  # noqa: PLC0415

    stop = end_requested()
    with ExitStack() as closing:
        offline_log = open_offline_log(
            data, incident, closing, _warn, lambda _: None, in_place=False
        )
        folder = offline_log.folder
        found = Records(offline_log.store, SystemClock()).require_incident(incident)
        end_ns = found.closed_ns or max(folder.recorded_until_ns(), found.opened_ns)
        window_ns = (found.opened_ns, end_ns)
        server = _serve(closing, host, port, f"Muster, {incident}", window_ns)
        shown = LogReplay(folder.log, window_ns, server, time.monotonic_ns(), _warn)
        while not stop.is_set():
            if not shown.step(time.monotonic_ns()):
                stop.wait(_TURN_S)


@foxglove.command()
def layout(
    out: Annotated[Path, typer.Argument(help="JSON file to write, for Foxglove to import.")],
    data: Data = _DATA,
) -> None:
    """Write a layout with all units in the log: map, alarms, temperatures and heights."""
    _require_library()
    from base_station.foxglove.layout import make_layout  # noqa: PLC0415
    from base_station.foxglove.log_topics import topics_in, units_among  # noqa: PLC0415
    from base_station.storage.data_folder import DataFolder  # noqa: PLC0415
    from shared.mcap_log import own_segments  # noqa: PLC0415
    from shared.out_file import whole, writable  # noqa: PLC0415

    folder = DataFolder(data)
    folder.require()
    writable(out)
    unit_ids = units_among(topics_in(own_segments(folder.log)[0]))
    if not unit_ids:
        raise LogError(f"there is no unit in the log in {data}; no layout was written")
    with whole(out) as part:
        part.write_text(make_layout(unit_ids), encoding="utf-8")
    typer.echo(f"{out}: a layout of {len(unit_ids)} unit(s); in Foxglove: Layouts, Import")


def _serve(
    closing: ExitStack, host: str, port: int, name: str, window_ns: tuple[int, int] | None = None
) -> FoxgloveServer:
    """Serve, and print `ready ws://...` when Foxglove can connect."""
    from base_station.foxglove.server import FoxgloveServer  # noqa: PLC0415

    server = FoxgloveServer(host, port, name, window_ns)
    closing.callback(server.close)
    typer.echo(f"ready ws://{f'[{host}]' if ':' in host else host}:{server.port}")
    return server


def _listening_address(listen: str, *, insecure: bool) -> tuple[str, int]:
    """Address to listen on.  Raises ConfigError for one that other machines can reach without
    ``insecure``, UserError if the library is missing.
    """
    from base_station.config import host_and_port  # noqa: PLC0415

    host, port = host_and_port(listen)
    if not insecure and not is_loopback(host):
        raise ConfigError(
            f"at {listen} every machine of the network could read all positions, without a login; "
            "use 127.0.0.1 and a tunnel (ssh -L 8765:127.0.0.1:8765 STATION), or accept it with "
            "--insecure"
        )
    _require_library()
    return host, port


def _require_library() -> None:
    from base_station.foxglove.library import require_library  # noqa: PLC0415

    require_library()


def _warn(line: str) -> None:
    typer.echo(line, err=True)
