"""Closing an incident over what is open in it, as a program does that means it."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any


def despite(problem: Mapping[str, Any]) -> dict[str, Any]:
    """What the incident was not closed over, to be named when it is asked for again."""
    return {name: ids for name, ids in problem.items() if name.startswith("despite_")}
