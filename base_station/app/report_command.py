"""``muster base report``: the report on an incident, as HTML and as PDF."""

from __future__ import annotations

from contextlib import ExitStack
from pathlib import Path
from typing import Annotated

import typer

from base_station.app.progress_bar import progress_bar
from shared.end_signals import sigterm_as_ctrl_c
from shared.out_file import whole, writable


def report(
    incident: Annotated[str, typer.Argument(help="Its id, as in the console.")],
    data: Path = Path("muster-data"),
    html: Annotated[
        Path | None,
        typer.Option(help="File to write, not INCIDENT.html.", callback=writable),
    ] = None,
    pdf: Annotated[
        Path | None, typer.Option(help="Also write a PDF to this file.", callback=writable)
    ] = None,
    assess: Annotated[
        bool, typer.Option("--assess", help="First judge the positions: it may take minutes.")
    ] = False,
) -> None:
    """Write the report on an incident: its events, the trails of its members, and the gaps."""
    # Imported where needed: they take their time, and a wrong option is refused before.
    from base_station.app.offline_report import open_report_sources  # noqa: PLC0415
    from base_station.report.data_collection import collect_report_data  # noqa: PLC0415
    from base_station.report.document import html_document  # noqa: PLC0415
    from base_station.report.pdf import pdf_document, require_library  # noqa: PLC0415

    if pdf is not None:
        require_library()
    with sigterm_as_ctrl_c(), ExitStack() as closing:
        with progress_bar("reading the log") as on_progress:
            opened = open_report_sources(data, incident, closing, _warn, on_progress)
        if assess:
            with progress_bar("judging positions") as on_progress:
                opened.assess(on_progress)
        with progress_bar("gathering the report") as on_progress:
            page = html_document(collect_report_data(opened.sources, opened.incident, on_progress))
    _write(html or Path(f"{opened.incident.incident_id}.html"), page)
    if pdf is not None:
        _write(pdf, pdf_document(page))


def _write(path: Path, content: bytes) -> None:
    with whole(path) as making:
        making.write_bytes(content)
    typer.echo(f"{path} written")


def _warn(line: str) -> None:
    typer.echo(line, err=True)
