"""Option that every benchmark offers: its figures in a file as well."""

from __future__ import annotations

import json
from dataclasses import asdict
from pathlib import Path
from typing import Annotated

import typer

from shared.out_file import whole, writable

FiguresFile = Annotated[
    Path | None,
    typer.Option("--json", help="Also write the figures to this file.", callback=writable),
]


def write_figures(path: Path | None, figures: object) -> None:
    """Write figures as JSON, where a file is given; ``figures`` may be or hold dataclasses."""
    if path is not None:
        with whole(path) as making:
            text = json.dumps(figures, indent=2, default=asdict)
            making.write_text(text + "\n", encoding="utf-8")
