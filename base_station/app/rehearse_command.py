"""``muster base rehearse``: other thresholds of alarm rules over recorded incidents."""

from __future__ import annotations

from contextlib import ExitStack
from pathlib import Path
from typing import Annotated

import typer

from base_station.app.progress_bar import progress_bar
from shared.end_signals import sigterm_as_ctrl_c
from shared.errors import UserError
from shared.out_file import whole, writable


def rehearse(
    change: Annotated[
        list[str] | None,
        typer.Option("--set", help="RULE.THRESHOLD=VALUE, as no-motion.alarm_s=25; repeatable."),
    ] = None,
    sweep: Annotated[
        str, typer.Option(help="RULE.THRESHOLD=FIRST:LAST:STEP, as no-motion.alarm_s=15:60:5.")
    ] = "",
    incident: Annotated[
        list[str] | None, typer.Option(help="Its id; repeatable. Else all that are closed.")
    ] = None,
    data: Annotated[Path, typer.Option(help="Folder of the station, or what was given.")] = Path(
        "muster-data"
    ),
    json_file: Annotated[
        Path | None,
        typer.Option("--json", help="Also write all of it to this file.", callback=writable),
    ] = None,
    picture: Annotated[
        Path | None,
        typer.Option(help="Also draw the trade-off of a sweep, as SVG.", callback=writable),
    ] = None,
) -> None:
    """Run other alarm thresholds over recorded incidents: which alarms would have been raised,
    missed, earlier or later.
    """
    # Imported where needed: they take their time, and a wrong option is refused before.
    from base_station.app.offline_rehearsal import open_rehearsal  # noqa: PLC0415
    from base_station.replay.rehearsal.changes import changes_of, points_of  # noqa: PLC0415
    from base_station.replay.rehearsal.tables import (  # noqa: PLC0415
        print_rehearsal,
        write_rehearsal,
    )
    from base_station.report.trade_off_picture import trade_off_picture  # noqa: PLC0415

    changes = changes_of(change or ())
    if picture is not None and not sweep:
        raise UserError("a picture is drawn of a sweep; give --sweep too")
    if not (sweep or changes):
        raise UserError("give the thresholds to rehearse: --set no-motion.alarm_s=25, or --sweep")
    swept, points = points_of(changes, sweep)
    with sigterm_as_ctrl_c(), ExitStack() as closing:
        with progress_bar("reading the log") as on_progress:
            opened = open_rehearsal(data, incident or (), closing, _warn, on_progress)
        with progress_bar("rehearsing") as on_progress:
            report = opened.rehearser.rehearse(opened.incidents, points, swept, on_progress)
    if all(point.problem for point in report.points):
        raise UserError(f"{report.points[0].problem}; give the other threshold with --set too")
    print_rehearsal(report)
    if json_file is not None:
        write_rehearsal(report, json_file)
    if picture is not None:
        with whole(picture) as making:
            making.write_text(trade_off_picture(report), encoding="utf-8")


def _warn(line: str) -> None:
    typer.echo(line, err=True)
