"""``muster base export``: write an incident to a file, with or without a running station."""

from __future__ import annotations

from collections.abc import Iterable
from contextlib import ExitStack
from dataclasses import replace
from datetime import datetime
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from base_station.app.progress_bar import progress_bar
from base_station.replay.trail_kind import TrailKind
from shared.clock import NS_PER_S
from shared.end_signals import sigterm_as_ctrl_c
from shared.errors import UserError
from shared.options import End, Start
from shared.out_file import whole, writable

if TYPE_CHECKING:
    from base_station.app.folder_commands import IncidentCommandContext

_STANDS_ALONE = "mcap"


def export(
    incident: Annotated[
        str, typer.Argument(help="Its id, as in the console, or a file that has it all (MCAP).")
    ],
    out: Annotated[Path, typer.Argument(help="File to write: tracks.gpx, incident.mcap ...")],
    data: Annotated[Path, typer.Option(help="Folder of the station, or what was given.")] = Path(
        "muster-data"
    ),
    file_format: Annotated[
        str, typer.Option("--format", help="Else by the ending of the file's name.")
    ] = "",
    kind: Annotated[
        TrailKind, typer.Option(help="As shown at the time, post-processed, or the unit's own.")
    ] = TrailKind.FUSED,
    only: Annotated[
        list[str] | None, typer.Option(help="A unit, person or crew; repeatable. Else everybody.")
    ] = None,
    start: Start = None,
    end: End = None,
    radio: Annotated[
        bool, typer.Option("--radio", help="With the audio of the radio channels (mcap).")
    ] = False,
) -> None:
    """Write an incident for other programs: tracks as GPX, KML, GeoJSON, CSV or Parquet, or all of
    it as one file that stands alone (mcap).

    A file whose name ends in .gz, such as tracks.gpx.gz, is compressed.
    """
    from base_station.app.folder_commands import open_post_processing  # noqa: PLC0415
    from base_station.exporters import exporter_of  # noqa: PLC0415
    from base_station.exporters.compression import SUFFIX, gzipped  # noqa: PLC0415
    from base_station.exporters.incident import incident_tracks  # noqa: PLC0415
    from base_station.exporters.interface import TrackCount  # noqa: PLC0415
    from base_station.exporters.selection import TrackSelection  # noqa: PLC0415
    from base_station.storage.db.window import FOREVER_NS  # noqa: PLC0415

    is_gzip = out.suffix == SUFFIX
    named = out.with_suffix("") if is_gzip else out
    name = file_format or named.suffix.removeprefix(".")
    writable(out)
    if name == _STANDS_ALONE:
        if is_gzip or only or start or end or kind is not TrailKind.FUSED:
            raise UserError(
                "an incident that stands alone is whole, with every kind of trail, and compressed: "
                "leave out --kind, --only, --start, --end and .gz, or cut it with muster log cut"
            )
        _export_whole(incident, out, data, with_radio=radio)
        return
    if radio:
        raise UserError("audio of the radio is in an incident that stands alone: give OUT.mcap")
    exporter = exporter_of(name)
    selection = TrackSelection(only or (), _ns(start, 0), _ns(end, FOREVER_NS))
    with sigterm_as_ctrl_c(), ExitStack() as closing:
        context = open_post_processing(data, incident, closing, _warn, lambda _: None)
        trails = context.tracks(kind)
        tracks = incident_tracks(context.records, context.roster, context.incident, trails)
        chosen = selection.of(tracks).named_as(kind.in_words)
        count = TrackCount(chosen.tracks)
        content = exporter.export(replace(chosen, tracks=count))
        _write(out, gzipped(content) if is_gzip else content)
        _audit(context, f"({kind.value}) as {exporter.name}")
    typer.echo(f"{out}: {count.tracks} tracks, {count.points} points")


def _export_whole(incident: str, out: Path, data: Path, *, with_radio: bool) -> None:
    from base_station.app.folder_commands import open_post_processing  # noqa: PLC0415
    from base_station.radio.radio_log import RadioLog  # noqa: PLC0415
    from base_station.replay.incident_file import (  # noqa: PLC0415
        IncidentFileSource,
        incident_file,
    )

    with sigterm_as_ctrl_c(), ExitStack() as closing, progress_bar("writing") as on_progress:
        context = open_post_processing(data, incident, closing, _warn, lambda _: None)
        until_ns = context.folder.recorded_until_ns()
        source = IncidentFileSource(
            log=context.log,
            incident=context.incident,
            name=context.roster.shown(context.incident.name),
            people=context.roster.known_people(),
            plan=context.records.plan(context.incident.closed_ns or until_ns),
            until_ns=until_ns,
            imports=context.imports.attachments(context.incident.incident_id),
            radio=RadioLog(context.folder.radio) if with_radio else None,
            report=_warn,
            on_progress=on_progress,
        )
        _write(out, incident_file(source))
        with_audio = ", with the audio of the radio" if with_radio else ""
        _audit(context, f"as a file that stands alone{with_audio}")
    size_mb = out.stat().st_size / 1e6
    typer.echo(f"{out}: {size_mb:.1f} MB, all of it; muster base replay {out}")


def _write(out: Path, content: Iterable[bytes]) -> None:
    with whole(out) as part, part.open("wb") as file:
        file.writelines(content)


def _audit(context: IncidentCommandContext, what: str) -> None:
    if context.keeps_result:
        incident_id = context.incident.incident_id
        context.records.audit("muster base export", "Exported", f"{incident_id} {what}")


def _ns(time: datetime | None, default_ns: int) -> int:
    return default_ns if time is None else round(time.timestamp() * 1000) * (NS_PER_S // 1000)


def _warn(line: str) -> None:
    typer.echo(line, err=True)
