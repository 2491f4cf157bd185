"""Process that reads one drawing: the file comes on standard input, the draft goes to standard
output.
"""

from __future__ import annotations

import resource
import signal
import sys
from types import FrameType

import msgspec

from base_station.drawings.draft import Draft, DrawingRefusal, Options
from base_station.drawings.reader import read_drawing
from shared.coded_text import text_of_error
from shared.errors import UserError

MOST_MEMORY_BYTES = 2_000_000_000
MOST_CPU_S = 30
_TO_ANSWER_S = 2  # of the processor: a library that does not return then is killed


def main() -> None:
    resource.setrlimit(resource.RLIMIT_AS, (MOST_MEMORY_BYTES, MOST_MEMORY_BYTES))
    resource.setrlimit(resource.RLIMIT_CPU, (MOST_CPU_S, MOST_CPU_S + _TO_ANSWER_S))
    signal.signal(signal.SIGXCPU, _refuse)
    options = msgspec.json.decode(sys.argv[1], type=Options)
    answer: Draft | DrawingRefusal
    try:
        answer = read_drawing(sys.stdin.buffer.read(), options)
    except UserError as error:
        answer = DrawingRefusal.of(text_of_error(error))
    except (MemoryError, RecursionError):
        answer = DrawingRefusal.of("the drawing is too large to be read; send a part of it")
    sys.stdout.buffer.write(msgspec.json.encode(answer))


def _refuse(_signal: int, _frame: FrameType | None) -> None:
    raise UserError(f"the drawing takes longer than {MOST_CPU_S} s to be read; send a part of it")


if __name__ == "__main__":
    main()
