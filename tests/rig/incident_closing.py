"""Closing an incident over what is open in it, as a program does that means it."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any


def despite(problem: Mapping[str, Any]) -> dict[str, Any]:
    """Obstacles to the closing of the incident, to be named in the repeated request."""
    return {name: ids for name, ids in problem.items() if name.startswith("despite_")}
