"""Paths of the console's sources and of its build."""

from pathlib import Path

CONSOLE = Path(__file__).resolve().parents[2] / "base_station" / "console"
DIST = CONSOLE / "dist"
