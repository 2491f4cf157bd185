"""The process that packs one segment: its path as argument.  Exit code 1: it stays as it is."""

from __future__ import annotations

import os
import sys
from pathlib import Path

from shared.errors import MusterError
from shared.mcap_log import pack_segment

_NICE = 19  # behind everything: nobody waits for it


def main() -> None:
    os.nice(_NICE)
    try:
        is_packed = pack_segment(Path(sys.argv[1]))
    except MusterError as error:
        sys.exit(str(error))
    sys.exit(0 if is_packed else 1)


if __name__ == "__main__":
    main()
