"""Health check of a container: ``python -m deploy.container.health``; exit code 1: not healthy."""

from __future__ import annotations

import sys
import time
from pathlib import Path

from deploy.container.supervisor import state_folder

SILENT_S = 15.0  # a station and a unit notify once a second, a department every five


def fault(folder: Path) -> str:
    """Reason that the program of this container is not healthy; empty: it is."""
    try:
        last_s = float((folder / "working").read_text(encoding="ascii"))
    except FileNotFoundError:
        return "it is starting: it has not been ready yet"
    silent_s = time.monotonic() - last_s
    if silent_s > SILENT_S:
        return f"it hangs: nothing came from it for {silent_s:.0f} s"
    return ""


if __name__ == "__main__":
    found = fault(state_folder())
    print(found or "ready, and working")
    sys.exit(1 if found else 0)
