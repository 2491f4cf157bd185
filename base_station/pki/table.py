"""The registry as a table."""

from __future__ import annotations

from datetime import datetime

from rich.console import Console
from rich.table import Table

from base_station.pki.registry import Entry, Registry


def print_registry(registry: Registry, now: datetime, console: Console | None = None) -> None:
    """To standard output unless told otherwise; by kind, then by name."""
    table = Table(title=f"Certificates of {registry.organisation}")
    for heading in ("who", "kind", "serial", "valid from", "valid to", "days left", "state"):
        table.add_column(
            heading, justify="right" if heading == "days left" else "left", no_wrap=True
        )
    for entry in sorted(registry.entries, key=lambda e: (e.holder.value, e.common_name)):
        table.add_row(
            entry.name,
            entry.holder.value,
            entry.serial[:8],
            f"{entry.valid_from:%Y-%m-%d}",
            f"{entry.valid_to:%Y-%m-%d}",
            str(max(0, (entry.valid_to - now).days)),
            _state(entry, now),
        )
    (console or Console()).print(table)


def _state(entry: Entry, now: datetime) -> str:
    if entry.revoked is not None:
        return f"revoked {entry.revoked:%Y-%m-%d}"
    return "expired" if entry.valid_to <= now else "valid"
