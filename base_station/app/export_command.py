"""``muster base export``: an incident's tracks as a file, with or without a running station."""

from __future__ import annotations

from contextlib import ExitStack
from dataclasses import replace
from datetime import datetime
from pathlib import Path
from typing import Annotated

import typer

from base_station.replay.trail_kind import TrailKind
from shared.clock import NS_PER_S
from shared.end_signals import sigterm_as_ctrl_c
from shared.options import End, Start
from shared.out_file import whole, writable


def export(
    incident: Annotated[str, typer.Argument(help="Its id, as in the console.")],
    out: Annotated[Path, typer.Argument(help="File to write, such as tracks.gpx.")],
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
) -> None:
    """Write an incident's tracks for other programs: GPX, KML, GeoJSON, CSV or Parquet.

    A file whose name ends in .gz, such as tracks.gpx.gz, is compressed.
    """
    from base_station.app.folder_commands import open_post_processing  # noqa: PLC0415
    from base_station.exporters import exporter_of  # noqa: PLC0415
    from base_station.exporters.compression import SUFFIX, gzipped  # noqa: PLC0415
    from base_station.exporters.incident import incident_tracks  # noqa: PLC0415
    from base_station.exporters.interface import TrackCount  # noqa: PLC0415
    from base_station.exporters.selection import TrackSelection  # noqa: PLC0415
    from base_station.storage.db.records import FOREVER_NS  # noqa: PLC0415

    is_gzip = out.suffix == SUFFIX
    named = out.with_suffix("") if is_gzip else out
    exporter = exporter_of(file_format or named.suffix.removeprefix("."))
    writable(out)
    selection = TrackSelection(only or (), _ns(start, 0), _ns(end, FOREVER_NS))
    with sigterm_as_ctrl_c(), ExitStack() as closing:
        context = open_post_processing(data, incident, closing, _warn, lambda _: None)
        trails = context.tracks(kind)
        tracks = incident_tracks(context.records, context.roster, context.incident, trails)
        chosen = selection.of(tracks).named_as(kind.in_words)
        count = TrackCount(chosen.tracks)
        content = exporter.export(replace(chosen, tracks=count))
        with whole(out) as part, part.open("wb") as file:
            file.writelines(gzipped(content) if is_gzip else content)
        if context.keeps_result:
            context.records.audit(
                "muster base export", "Exported", f"{incident} ({kind.value}) as {exporter.name}"
            )
    typer.echo(f"{out}: {count.tracks} tracks, {count.points} points")


def _ns(time: datetime | None, default_ns: int) -> int:
    return default_ns if time is None else round(time.timestamp() * 1000) * (NS_PER_S // 1000)


def _warn(line: str) -> None:
    typer.echo(line, err=True)
