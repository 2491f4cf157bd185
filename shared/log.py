"""The programs' own log: one line a record, UTC, to standard error and, where asked, a file."""

from __future__ import annotations

import logging
import re
import time
from io import TextIOWrapper
from logging.handlers import RotatingFileHandler
from pathlib import Path
from typing import Literal

from shared.own_files import append_own

LogLevel = Literal["DEBUG", "INFO", "WARNING", "ERROR"]

# What ends a line, or does more to a terminal than be shown: what others say gets into messages.
_UNPRINTABLE = re.compile(r"[\x00-\x1f\x7f-\x9f\u2028-\u202e\u2066-\u2069]")
_FILE_BYTES = 5_000_000
_FILES_KEPT = 3


class OneLineFormatter(logging.Formatter):
    """``2026-03-01T10:00:00.123Z WARNING base_station.engine.feed  text``; a traceback follows."""

    converter = staticmethod(time.gmtime)

    def __init__(self) -> None:
        super().__init__(
            "%(asctime)s.%(msecs)03dZ %(levelname)-7s %(name)s  %(message)s", "%Y-%m-%dT%H:%M:%S"
        )

    def formatMessage(self, record: logging.LogRecord) -> str:  # noqa: N802  # logging's name
        return _UNPRINTABLE.sub(_escaped, super().formatMessage(record))


class _PlainFileHandler(RotatingFileHandler):
    """Follows no link: whoever may write to the folder does not choose where root writes."""

    def _open(self) -> TextIOWrapper:
        return TextIOWrapper(append_own(Path(self.baseFilename)), encoding=self.encoding)


def set_up_logging(level: LogLevel = "INFO", file: Path | None = None) -> None:
    """For a program's start, once: replaces whatever handlers the root logger had."""
    handlers: list[logging.Handler] = [logging.StreamHandler()]
    if file is not None:
        file.parent.mkdir(parents=True, exist_ok=True)
        handlers.append(
            _PlainFileHandler(file, maxBytes=_FILE_BYTES, backupCount=_FILES_KEPT, encoding="utf-8")
        )
    for handler in handlers:
        handler.setFormatter(OneLineFormatter())
    logging.basicConfig(level=level, handlers=handlers, force=True)


def _escaped(found: re.Match[str]) -> str:
    return found[0].encode("unicode_escape").decode("ascii")
