"""The process that reads one drawing: the file from its standard input, the draft to its output."""

from __future__ import annotations

import resource
import sys

import msgspec

from base_station.drawings.draft import Draft, DrawingRefusal, Options
from base_station.drawings.reader import read_drawing
from shared.errors import UserError

MOST_MEMORY_BYTES = 2_000_000_000
MOST_CPU_S = 30


def main() -> None:
    resource.setrlimit(resource.RLIMIT_AS, (MOST_MEMORY_BYTES, MOST_MEMORY_BYTES))
    resource.setrlimit(resource.RLIMIT_CPU, (MOST_CPU_S, MOST_CPU_S))
    options = msgspec.json.decode(sys.argv[1], type=Options)
    answer: Draft | DrawingRefusal
    try:
        answer = read_drawing(sys.stdin.buffer.read(), options)
    except UserError as error:
        answer = DrawingRefusal(str(error))
    except (MemoryError, RecursionError):
        answer = DrawingRefusal("the drawing is too large to be read; send a part of it")
    sys.stdout.buffer.write(msgspec.json.encode(answer))


if __name__ == "__main__":
    main()
