"""Where the console's sources and its build lie."""

from pathlib import Path

CONSOLE = Path(__file__).resolve().parents[2] / "base_station" / "console"
DIST = CONSOLE / "dist"
