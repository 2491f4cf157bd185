"""Files are read in a process of their own, so that no content can end or block the station or fill
its memory.
"""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import msgspec

from base_station.importers.interface import ImportOptions
from base_station.storage.imports import ImportedContent
from shared.coded_text import NO_CODE, TextCode, code_of_text, coded, with_code
from shared.errors import UserError

MOST_WAIT_S = 1200.0


class ImportRefusal(msgspec.Struct, frozen=True):
    """Reason for a person, and its code."""

    reason: str
    code: TextCode = NO_CODE

    @staticmethod
    def of(text: str) -> ImportRefusal:
        return ImportRefusal(str(text), code_of_text(text))


def content_of(path: Path, options: ImportOptions) -> ImportedContent:
    """Read a file in the process.  Raises UserError with the fault of the file, and advice."""
    command = (
        *(sys.executable, "-m", "base_station.importers"),
        *(str(path.absolute()), msgspec.json.encode(options).decode()),
    )
    try:
        done = subprocess.run(
            command,
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            timeout=MOST_WAIT_S,
            check=False,
        )
    except subprocess.TimeoutExpired:
        raise UserError(
            coded("import-took-too-long", "it took too long to be read: take a part of it")
        ) from None
    if done.returncode != 0 or not done.stdout:
        raise UserError(
            coded(
                "import-unreadable",
                "it cannot be read: it may be damaged; save it again, and bring that in",
            )
        )
    is_read, encoded = done.stdout[0], done.stdout[1:]
    if not is_read:
        refusal = msgspec.msgpack.decode(encoded, type=ImportRefusal)
        raise UserError(with_code(refusal.reason, refusal.code))
    return msgspec.msgpack.decode(encoded, type=ImportedContent)
