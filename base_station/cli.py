"""``muster base``: run a station, replay, and look after its data."""

from __future__ import annotations

import logging
import os
import sys
from collections.abc import Mapping
from contextlib import ExitStack
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from base_station.app.archive_cli import archive as archive_commands
from base_station.app.dispatch_command import dispatch
from base_station.app.export_command import export
from base_station.app.foxglove_cli import foxglove
from base_station.app.import_command import import_
from base_station.app.progress_bar import progress_bar
from base_station.app.recordings_command import fetch_recording
from base_station.app.rehearse_command import rehearse
from base_station.app.report_command import report
from base_station.app.rerun_command import rerun
from base_station.app.search_command import search
from base_station.app.unit_tokens_cli import unit_tokens
from base_station.app.users_cli import users
from base_station.process import gc_tuning
from shared.end_signals import sigterm_as_ctrl_c
from shared.options import finite
from shared.out_file import writable

if TYPE_CHECKING:
    from base_station.app.folder_commands import IncidentCommandContext
    from base_station.config import StationConfig

app = typer.Typer(no_args_is_help=True, pretty_exceptions_enable=False)
log = typer.Typer(help="List the log's segments, or end torn ones.", no_args_is_help=True)

# Headings of the list of commands.
_OPERATION = "At a running station"
_PAST = "Past incidents"
_DATA = "Data of the station"

ConfigOption = Annotated[
    Path | None, typer.Option(help="TOML file with settings; flags overrule it.")
]
DataOption = Annotated[
    Path | None, typer.Option(help="Folder of log and database; one station a folder.")
]
HttpOption = Annotated[str | None, typer.Option(help="Where the console is served, HOST:PORT.")]
InsecureOption = Annotated[
    bool | None,
    typer.Option("--insecure", help="Accept plain connections from other machines."),
]


@app.callback()
def base() -> None:
    """The base station."""


@app.command(rich_help_panel=_OPERATION)
def serve(
    config: ConfigOption = None,
    data: DataOption = None,
    listen: Annotated[
        list[str] | None, typer.Option(help="Where units connect, tls/HOST:PORT; repeatable.")
    ] = None,
    http: HttpOption = None,
    insecure: InsecureOption = None,
) -> None:
    """Run the station until Ctrl-C.  Prints `ready http://...` when consoles can connect."""
    flags = {
        "data": data,
        "bus.listen": listen or None,
        "http.listen": http,
        "insecure": insecure or None,
    }
    settings = _load_settings(config, flags)
    # Imported where needed: it takes its time, and wrong settings are reported before.  The
    # router's process takes as long, beside it.
    from base_station.security.router.process import start_loading  # noqa: PLC0415

    loading_router = start_loading()
    with gc_tuning.paused():
        from base_station.app.live import run_station  # noqa: PLC0415

    run_station(settings, _announce, loading_router)


@app.command(rich_help_panel=_PAST)
def replay(
    incident: Annotated[
        str, typer.Argument(help="Its id, as in the console, or a file that has it all (MCAP).")
    ],
    config: ConfigOption = None,
    data: DataOption = None,
    http: HttpOption = None,
    speed: Annotated[
        float, typer.Option(min=0.25, max=1000.0, callback=finite, help="Times real time.")
    ] = 1.0,
    insecure: InsecureOption = None,
    recompute: Annotated[
        bool, typer.Option(help="Decide everything again instead of playing what was shown.")
    ] = False,
    archive: Annotated[
        str | None, typer.Option(help="Read it in this archive: a folder, or s3://BUCKET/PLACE.")
    ] = None,
) -> None:
    """Show a past incident in a console of its own; the folder is only read."""
    flags = {"data": data, "http.listen": http, "insecure": insecure or None}
    settings = _load_settings(config, flags)
    with gc_tuning.paused():
        from base_station.app.replay import run_replay_station  # noqa: PLC0415

    with sigterm_as_ctrl_c():
        run_replay_station(
            settings, incident, speed, _announce, recompute=recompute, archive=archive
        )


@app.command(rich_help_panel=_DATA)
def rebuild(data: Path = Path("muster-data")) -> None:
    """Make the queryable tables again from the log; people and users are kept."""
    from rich.progress import Progress  # noqa: PLC0415

    from base_station.app import folder_commands as station  # noqa: PLC0415

    with Progress(transient=True) as progress:
        task = progress.add_task("reading the log", total=1.0)
        count = station.rebuild(
            data, lambda done: progress.update(task, completed=done), progress.console.print
        )
    typer.echo(f"{count} log records projected")


@app.command(rich_help_panel=_DATA)
def backup(
    target: Annotated[Path, typer.Argument(help="A folder of its own for this station's copy.")],
    data: Path = Path("muster-data"),
    radio: Annotated[
        bool, typer.Option("--radio", help="With the audio of the radio channels.")
    ] = False,
) -> None:
    """Copy log, database and certificates, also while the station runs; repeated: new data only."""
    from rich.progress import Progress  # noqa: PLC0415

    from base_station.app.backup import back_up  # noqa: PLC0415

    os.umask(0o077)
    with Progress(transient=True) as progress:
        task = progress.add_task("copying", total=1.0)
        done = back_up(
            data,
            target,
            lambda part: progress.update(task, completed=part),
            with_radio=radio,
        )
    typer.echo(
        f"{target}: {done.copied} files ({done.copied_bytes / 1e6:.1f} MB) copied, "
        f"{done.unchanged} were there already"
    )
    if done.removed:
        typer.echo(f"{done.removed} segments of the log are there that the station has no more")
    done.require_whole()


@app.command(rich_help_panel=_DATA)
def forget(
    what: Annotated[str, typer.Argument(help="A person's id or full name, or an incident's id.")],
    data: Path = Path("muster-data"),
) -> None:
    """Delete all data of a person or of all people in an incident; the audit stays.

    Units of the person are unassigned first.  A station that runs on the folder does it itself.
    """
    from rich.progress import Progress  # noqa: PLC0415

    from base_station.app import folder_commands as station  # noqa: PLC0415

    with Progress(transient=True) as progress:
        task = progress.add_task("writing the log anew", total=1.0, start=False)

        def confirm(about: str) -> None:
            progress.stop()
            _ask_to_confirm(what, about)
            progress.start()
            progress.start_task(task)

        done = station.forget(
            data, what, confirm, lambda part: progress.update(task, completed=part)
        )
    typer.echo(f"forgotten: {done}")


@app.command("compile", rich_help_panel=_OPERATION)
def compile_() -> None:
    """Compile the code for positions and trails now, so that the first start is quick."""
    from importlib import import_module  # noqa: PLC0415

    for compiled in (
        "base_station.fusion.kernels",
        "base_station.fusion.smoothing",
        "base_station.site.storeys",
    ):
        import_module(compiled)


@app.command(rich_help_panel=_PAST)
def smooth(
    incident: Annotated[str, typer.Argument(help="Its id, as in the console.")],
    data: Path = Path("muster-data"),
) -> None:
    """Smooth an incident's trails by everything that became known afterwards."""
    from base_station.app import folder_commands as station  # noqa: PLC0415

    with sigterm_as_ctrl_c(), ExitStack() as closing:
        with progress_bar("reading the log") as on_progress:
            post_processing = station.open_post_processing(
                data, incident, closing, _warn, on_progress
            )
        with progress_bar("smoothing") as on_progress:
            made = post_processing.post_processor.smooth(post_processing.incident, on_progress)
    for unit_id, track in made.tracks.items():
        typer.echo(f"{unit_id}\t{len(track)} points")
    kept = (
        "kept"
        if made.is_kept and post_processing.keeps_result
        else f"not kept: {_reason_not_kept(post_processing)}"
    )
    typer.echo(f"{len(made.tracks)} trails by {made.smoother}; {kept}")


@app.command(rich_help_panel=_PAST)
def assess(
    incident: Annotated[str, typer.Argument(help="Its id, as in the console.")],
    data: Path = Path("muster-data"),
    json_file: Annotated[
        Path | None,
        typer.Option("--json", help="Also write all of it to this file.", callback=writable),
    ] = None,
) -> None:
    """Assess an incident's positions, in the terms of ISO/IEC 18305."""
    from base_station.app import folder_commands as station  # noqa: PLC0415
    from base_station.replay.assessment.report import with_people  # noqa: PLC0415
    from base_station.replay.assessment.tables import print_report, write_report  # noqa: PLC0415

    with sigterm_as_ctrl_c(), ExitStack() as closing:
        with progress_bar("reading the log") as on_progress:
            post_processing = station.open_post_processing(
                data, incident, closing, _warn, on_progress
            )
        live = post_processing.records.tracks_of(post_processing.incident)
        report = with_people(
            post_processing.post_processor.assess(post_processing.incident, live),
            post_processing.people,
        )
    print_report(report)
    if json_file is not None:
        write_report(report, json_file)


@log.command("recover")
def recover(data: Path = Path("muster-data")) -> None:
    """End torn segments in order; a station does this by itself when it starts."""
    from base_station.storage.data_folder import DataFolder  # noqa: PLC0415
    from shared.mcap_log import recover_log  # noqa: PLC0415

    folder = DataFolder(data)
    folder.require()
    lock = folder.lock()
    try:
        recoveries = recover_log(folder.log)
    finally:
        lock.close()
    for recovery in recoveries:
        typer.echo(str(recovery))
    typer.echo(f"{len(recoveries)} segments were torn")


@log.command("list")
def list_segments(data: Path = Path("muster-data")) -> None:
    """List the segments with their times and sizes; a station is writing the open one."""
    from datetime import UTC, datetime  # noqa: PLC0415

    from base_station.storage.data_folder import DataFolder  # noqa: PLC0415
    from shared.clock import NS_PER_S  # noqa: PLC0415

    folder = DataFolder(data)
    folder.require()
    for info in folder.segments():
        start = datetime.fromtimestamp(info.start_ns / NS_PER_S, UTC)
        typer.echo(
            f"{info.path.name}\t{start:%Y-%m-%d %H:%M:%S}\t{info.messages} messages\t"
            f"{info.size_bytes} bytes\t{info.state.value}"
        )


def _load_settings(config: Path | None, flags: Mapping[str, object]) -> StationConfig:
    """The settings; also sets up the whole process once."""
    from base_station.config import StationConfig  # noqa: PLC0415
    from shared.config import load_config  # noqa: PLC0415
    from shared.log import set_up_logging  # noqa: PLC0415

    settings = load_config(config, StationConfig, flags)
    settings.require_encryption()
    set_up_logging(settings.log_level, settings.log_format)
    logging.getLogger("alembic").setLevel(logging.WARNING)
    os.umask(0o077)  # people's photos and tracks are private
    return settings


def _reason_not_kept(post_processing: IncidentCommandContext) -> str:
    if post_processing.incident.closed_ns is None:
        return "the incident is open"
    return (
        "the disk takes nothing"
        if post_processing.keeps_result
        else "nothing is written to what was given"
    )


def _warn(line: str) -> None:
    typer.echo(line, err=True)


def _announce(line: str) -> None:
    typer.echo(line)
    sys.stdout.flush()


def _ask_to_confirm(what: str, about: str) -> None:
    """It cannot be undone: the name is typed a second time, or comes on standard input."""
    from shared.errors import UserError  # noqa: PLC0415

    question = f"This deletes all that is stored of the {about}, for good. Type it again"
    answer = typer.prompt(question) if sys.stdin.isatty() else sys.stdin.readline().rstrip("\n")
    if answer != what:
        raise UserError(f"{answer!r} is not {what!r}; nothing was deleted")


app.command(rich_help_panel=_OPERATION)(dispatch)
app.command("fetch-recording", rich_help_panel=_OPERATION)(fetch_recording)
app.add_typer(users, name="users", rich_help_panel=_OPERATION)
app.add_typer(unit_tokens, name="unit-tokens", rich_help_panel=_OPERATION)
app.command(rich_help_panel=_PAST)(search)
app.command(rich_help_panel=_PAST)(report)
app.command(rich_help_panel=_PAST)(export)
app.command("import", rich_help_panel=_PAST)(import_)
app.command(rich_help_panel=_PAST)(rerun)
app.command(rich_help_panel=_PAST)(rehearse)
app.add_typer(foxglove, name="foxglove", rich_help_panel=_PAST)
app.add_typer(log, name="log", rich_help_panel=_DATA)
app.add_typer(archive_commands, name="archive", rich_help_panel=_DATA)
