"""The programs' own log: one line a record, UTC, to standard error.

As text for people, or as JSON for a log collector.
"""

from __future__ import annotations

import logging
import os
import re
import time
from datetime import UTC, datetime
from typing import Literal, cast

import msgspec

LogLevel = Literal["DEBUG", "INFO", "WARNING", "ERROR"]
LogFormat = Literal["text", "json"]

# The format for this program's child processes, whose lines go to the same place.
_FORMAT_VARIABLE = "MUSTER_LOG_FORMAT"

# What ends a line, or does more to a terminal than be shown: what others say gets into messages.
_UNPRINTABLE = re.compile(r"[\x00-\x1f\x7f-\x9f\u2028-\u202e\u2066-\u2069]")


class OneLineFormatter(logging.Formatter):
    """``2026-03-01T10:00:00.123Z WARNING base_station.engine.feed  text``; a traceback follows."""

    converter = staticmethod(time.gmtime)

    def __init__(self) -> None:
        super().__init__(
            "%(asctime)s.%(msecs)03dZ %(levelname)-7s %(name)s  %(message)s", "%Y-%m-%dT%H:%M:%S"
        )

    def formatMessage(self, record: logging.LogRecord) -> str:  # noqa: N802  # logging's name
        return _UNPRINTABLE.sub(_escaped, super().formatMessage(record))


class JsonFormatter(logging.Formatter):
    """One JSON object a line: ``time``, ``level``, ``logger``, ``message``, ``pid`` and, with a
    traceback, ``exception``.
    """

    def format(self, record: logging.LogRecord) -> str:
        time_utc = datetime.fromtimestamp(record.created, UTC).isoformat(timespec="milliseconds")
        line: dict[str, object] = {
            "time": time_utc.replace("+00:00", "Z"),
            "level": record.levelname,
            "logger": record.name,
            "message": record.getMessage(),
            "pid": record.process,
        }
        if record.exc_info:
            line["exception"] = self.formatException(record.exc_info)
        return msgspec.json.encode(line).decode()


def set_up_logging(level: LogLevel = "INFO", log_format: LogFormat | None = None) -> None:
    """For a program's start, once: replaces whatever handlers the root logger had.

    ``log_format``: None as the parent process has it, text where there is none.
    """
    if log_format is None:
        log_format = cast("LogFormat", os.environ.get(_FORMAT_VARIABLE, "text"))
    else:
        os.environ[_FORMAT_VARIABLE] = log_format
    handler = logging.StreamHandler()
    handler.setFormatter(JsonFormatter() if log_format == "json" else OneLineFormatter())
    logging.basicConfig(level=level, handlers=[handler], force=True)


def _escaped(found: re.Match[str]) -> str:
    return found[0].encode("unicode_escape").decode("ascii")
