"""Where samples come from.  A new kind of source is a file and a line in ``SOURCES``."""

from __future__ import annotations

from difflib import get_close_matches

from edge.sources.bench import BenchSource
from edge.sources.black_box import BlackBoxSource
from edge.sources.bus import BusSource
from edge.sources.port import Source, SourceKind
from edge.sources.recording import RecordingSource
from edge.sources.simulated import SimulatedSource
from edge.sources.ximu3 import Ximu3Source
from shared.errors import ConfigError

SOURCES: tuple[SourceKind, ...] = (
    SourceKind("recording", RecordingSource, "PATH"),
    SourceKind("simulated", SimulatedSource, "SCENARIO"),
    SourceKind("mcap", BlackBoxSource, "PATH"),
    SourceKind("bench", BenchSource, "SEED"),
    SourceKind("bus", BusSource, "UNIT"),
    SourceKind("ximu3", Ximu3Source, "tcp://HOST:PORT or /dev/PORT?baud=115200"),
)


def open_source(text: str) -> Source:
    """Open what ``scheme:argument`` names, as in ``recording:PATH``.

    Raises ``ConfigError`` for a text that names no source, and whatever
    ``MusterError`` the source itself raises for its argument.
    """
    scheme, colon, argument = text.partition(":")
    for kind in SOURCES:
        if colon and argument and kind.scheme == scheme:
            return kind.make(argument)
    choices = ", ".join(f"{kind.scheme}:{kind.argument}" for kind in SOURCES)
    schemes = [kind.scheme for kind in SOURCES]
    if scheme in schemes:
        raise ConfigError(f"source {text!r} says nothing after {scheme}:; write one of {choices}")
    near = get_close_matches(scheme, schemes, n=1)
    hint = f"did you mean {near[0]}:? " if near else ""
    raise ConfigError(f"unknown source {text!r}; {hint}Known are {choices}")
