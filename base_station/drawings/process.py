"""Drawings are read in a process of their own: libraries that read files from unknown sources may
crash, hang or fill the memory, and the station must not.
"""

from __future__ import annotations

import subprocess
import sys

import msgspec

from base_station.drawings.draft import Draft, DrawingRefusal, Options
from shared.coded_text import coded, with_code
from shared.errors import UserError

MOST_WAIT_S = 60.0


def command_of(options: Options) -> tuple[str, ...]:
    """Command line of the process."""
    return (sys.executable, "-m", "base_station.drawings", msgspec.json.encode(options).decode())


def draft_of(content: bytes, options: Options) -> Draft:
    """Read a drawing in the process.  Raises UserError with the fault of the file, and advice."""
    try:
        done = subprocess.run(
            command_of(options),
            input=content,
            stdout=subprocess.PIPE,
            timeout=MOST_WAIT_S,
            check=False,
        )
    except subprocess.TimeoutExpired:
        raise UserError(
            coded(
                "drawing-took-too-long", "the drawing took too long to be read; send a part of it"
            )
        ) from None
    if done.returncode != 0:
        raise UserError(
            coded(
                "drawing-unreadable",
                "the drawing cannot be read; save it anew, or as a PNG, and send that",
            )
        )
    answer = msgspec.json.decode(done.stdout, type=Draft | DrawingRefusal)
    if isinstance(answer, DrawingRefusal):
        raise UserError(with_code(answer.reason, answer.code))
    return answer
