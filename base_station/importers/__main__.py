"""Process that reads one file: its path and the options are arguments, the content goes to standard
output.
"""

from __future__ import annotations

import os
import resource
import sys
from pathlib import Path

import msgspec

from base_station.importers.interface import ImportOptions
from base_station.importers.process import ImportRefusal
from base_station.importers.reading import read_import
from base_station.storage.imports import ImportedContent
from shared.coded_text import text_of_error
from shared.errors import MusterError

MOST_MEMORY_BYTES = 3_000_000_000
MOST_CPU_S = 900
_BEHIND_LIVE = 10  # niceness


def main() -> None:
    os.nice(_BEHIND_LIVE)
    resource.setrlimit(resource.RLIMIT_AS, (MOST_MEMORY_BYTES, MOST_MEMORY_BYTES))
    resource.setrlimit(resource.RLIMIT_CPU, (MOST_CPU_S, MOST_CPU_S))
    options = msgspec.json.decode(sys.argv[2], type=ImportOptions)
    answer: ImportedContent | ImportRefusal
    try:
        answer = read_import(Path(sys.argv[1]), options)
    except MusterError as error:
        answer = ImportRefusal.of(text_of_error(error))
    except OSError as error:
        answer = ImportRefusal.of(f"it cannot be read: {error.strerror or error}")
    except (MemoryError, RecursionError):
        answer = ImportRefusal.of("it is too large to be read: take a part of it")
    is_read = isinstance(answer, ImportedContent)
    sys.stdout.buffer.write(bytes([is_read]) + msgspec.msgpack.encode(answer))


if __name__ == "__main__":
    main()
