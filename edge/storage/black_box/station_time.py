"""Offset of a recording's log time from station time, kept beside it, one file for each boot.

Log time of a recording is the machine's UTC as it was at the boot's start.  That may be of 1970,
and the machine may be set right while it runs: what was learnt of it by then is all that can ever
place the recording.
"""

from __future__ import annotations

from pathlib import Path

from shared.own_files import write_own

_NAME = "ahead_ns"


def write_clock_offset(boot: Path, ahead_ns: int) -> None:
    """Write how far log time in this folder is ahead of station time.  Raises OSError."""
    making = boot / f"{_NAME}.part"
    with write_own(making) as written:
        written.write(b"%d\n" % ahead_ns)
    making.replace(boot / _NAME)


def read_clock_offset(boot: Path) -> int | None:
    """Return the offset; None where it was never known."""
    try:
        return int((boot / _NAME).read_text(encoding="ascii"))
    except (OSError, ValueError):
        return None


def remove_if_empty(boot: Path) -> None:
    """Remove the folder where nothing of the recording is left.  Raises OSError."""
    own = {_NAME, f"{_NAME}.part"}
    if all(path.name in own for path in boot.iterdir()):
        for name in own:
            (boot / name).unlink(missing_ok=True)
        boot.rmdir()
