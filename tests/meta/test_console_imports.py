"""The console's modules have no import cycle."""

from __future__ import annotations

import re
from graphlib import TopologicalSorter
from pathlib import Path

SOURCE = Path(__file__).resolve().parents[2] / "base_station/console/src"
ENDS = (".ts", ".tsx")
IMPORT = re.compile(r'(?:from|import)\s+"(\.[^"]+)"')


def imported(file: Path) -> set[Path]:
    """Files of the console that a file imports, with imports of types."""
    places = [
        file.parent / reported for reported in IMPORT.findall(file.read_text(encoding="utf-8"))
    ]
    candidates = [place.with_name(place.name + end).resolve() for place in places for end in ENDS]
    return {candidate for candidate in candidates if candidate.is_file()}


def test_console_has_no_import_cycle() -> None:
    files = [file for end in ENDS for file in SOURCE.rglob(f"*{end}")]
    graph = {file: imported(file) for file in files}
    assert sum(map(len, graph.values())) > len(files), "the imports are read"
    TopologicalSorter(graph).prepare()  # CycleError names the cycle
