"""Exchange of a segment for one that is made anew, as a whole or not at all."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress
from pathlib import Path

from shared.durable_names import sync_folder
from shared.errors import LogError
from shared.mcap_log.recovery import MAKING


def exchange_segment(path: Path, make: Callable[[Path], int], *, attempted: str) -> int:
    """Let ``make`` write the new segment to the path that it is given, and put it in the place of
    the old one; where it returns 0 or raises, the old one stays.  Returns what ``make`` returns.

    What a reader has open stays as it was.  No process may write to the segment meanwhile.
    ``attempted``: a participle for the message, such as *packed*.  Raises LogError when the disk
    refuses.
    """
    making = path.with_name(path.name + MAKING)
    try:
        making.unlink(missing_ok=True)
        made = make(making)
        if made:
            making.rename(path)
            sync_folder(path.parent)
    except OSError as error:
        raise LogError(
            f"{path} cannot be {attempted} ({error.strerror}): free or mend the disk"
        ) from error
    finally:
        with suppress(OSError):  # it is removed at the next start
            making.unlink(missing_ok=True)  # the room is for what is being recorded
    return made
