"""The registry as a table."""

from __future__ import annotations

from datetime import datetime

from rich.console import Console
from rich.measure import Measurement
from rich.table import Table

from base_station.security.pki.registry import Entry, Registry

_MAX_WIDTH = 1000  # letters; a name has 64


def print_registry(registry: Registry, now: datetime) -> None:
    """By kind, then by name.  A row that is longer than the window is wide goes on in the next
    line: cut, a name or a date would be none.
    """
    table = Table(title=f"Certificates of {registry.organisation}")
    for heading in ("who", "kind", "serial", "valid from", "valid to", "state"):
        table.add_column(heading, no_wrap=True)
    for entry in sorted(registry.entries, key=lambda e: (e.holder.value, e.common_name)):
        table.add_row(
            entry.name,
            entry.holder.value,
            entry.serial[:8],
            f"{entry.valid_from:%Y-%m-%d}",
            f"{entry.valid_to:%Y-%m-%d}",
            _state(entry, now),
        )
    console = Console()
    needed = Measurement.get(console, console.options.update(max_width=_MAX_WIDTH), table).maximum
    console.width = max(console.width, needed)
    console.print(table)


def _state(entry: Entry, now: datetime) -> str:
    if entry.revoked is not None:
        return f"revoked {entry.revoked:%Y-%m-%d}"
    return "expired" if entry.valid_to <= now else "valid"
