"""Snapshot of a console with a delta applied to it."""

from __future__ import annotations

from typing import Any


def patched(before: Any, change: Any) -> Any:
    if not isinstance(before, dict) or not isinstance(change, dict):
        return change
    return {**before, **{name: patched(before[name], value) for name, value in change.items()}}
