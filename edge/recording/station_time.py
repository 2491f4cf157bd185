"""How a recording's time stands to station time, kept beside it, one file for each boot.

Log time of a recording is the machine's UTC as it was at the boot's start.  That may be of 1970,
and the machine may be set right while it runs: what was learnt of it by then is all that can ever
place the recording.
"""

from __future__ import annotations

from pathlib import Path

_NAME = "ahead_ns"


def note_ahead(boot: Path, ahead_ns: int) -> None:
    """Log time in this folder is so far ahead of station time.  Raises OSError."""
    making = boot / f"{_NAME}.part"
    making.write_text(f"{ahead_ns}\n", encoding="ascii")
    making.replace(boot / _NAME)


def ahead_of(boot: Path) -> int | None:
    """None where nobody ever knew."""
    try:
        return int((boot / _NAME).read_text(encoding="ascii"))
    except (OSError, ValueError):
        return None


def remove_if_empty(boot: Path) -> None:
    """Where nothing of the recording is left.  Raises OSError."""
    own = {_NAME, f"{_NAME}.part"}
    if all(path.name in own for path in boot.iterdir()):
        for name in own:
            (boot / name).unlink(missing_ok=True)
        boot.rmdir()
