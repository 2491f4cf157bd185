"""The programs' own log: one line a record, in UTC."""

from __future__ import annotations

import json
import logging
import os
import re
import subprocess
import sys
from collections.abc import Iterator
from datetime import UTC, datetime

import pytest

from shared.log import OneLineFormatter, set_up_logging


@pytest.fixture(autouse=True)
def root_logger_restored() -> Iterator[None]:
    root = logging.getLogger()
    handlers, level = root.handlers[:], root.level
    root.handlers.clear()  # pytest's own, which set_up_logging would close
    yield
    for handler in root.handlers:
        handler.close()
    root.handlers[:] = handlers
    root.setLevel(level)


def test_a_record_is_one_line_with_utc_time_level_and_component(
    capsys: pytest.CaptureFixture[str],
) -> None:
    set_up_logging("INFO")
    record = logging.LogRecord("base_station.engine.engine", 30, "", 0, "disk\nfull", None, None)
    record.created, record.msecs = 1_700_000_000.25, 250.0
    logging.getLogger().handle(record)
    logging.getLogger("quiet").debug("not asked for")
    expected = "2023-11-14T22:13:20.250Z WARNING base_station.engine.engine  disk\\nfull\n"
    assert capsys.readouterr().err == expected


def test_a_traceback_follows_its_line(capsys: pytest.CaptureFixture[str]) -> None:
    set_up_logging("INFO")
    try:
        raise ValueError("a bug")
    except ValueError:
        logging.getLogger("edge").exception("step failed")
    assert re.search(
        r"ERROR {3}edge {2}step failed\nTraceback .*\nValueError: a bug",
        capsys.readouterr().err,
        re.S,
    )


@pytest.mark.parametrize("character", "\x00\b\x1b\r\x7f\x85\x9b\u2028\u202e")
def test_foreign_text_forges_no_line_and_controls_no_terminal(character: str) -> None:
    record = logging.LogRecord("bus", logging.INFO, "", 0, "from %s", (f"an{character}na",), None)
    reported = OneLineFormatter().format(record)
    assert character not in reported
    assert len(reported.splitlines()) == 1


def test_json_has_one_object_a_line_with_the_traceback_inside(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setenv("MUSTER_LOG_FORMAT", "text")  # put back to what it was
    set_up_logging("INFO", "json")
    try:
        raise ValueError("a bug\nof two lines")
    except ValueError:
        logging.getLogger("edge").exception("step %s failed: %s", 3, 'disk "full"\n\x1b')
    (line,) = capsys.readouterr().err.splitlines()
    record = json.loads(line)
    assert datetime.fromisoformat(record.pop("time")).tzinfo is UTC
    assert record.pop("exception").endswith("ValueError: a bug\nof two lines")
    assert record == {
        "level": "ERROR",
        "logger": "edge",
        "message": 'step 3 failed: disk "full"\n\x1b',
        "pid": os.getpid(),
    }


@pytest.mark.slow  # starts a program
def test_a_child_process_logs_in_the_format_of_its_parent(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("MUSTER_LOG_FORMAT", "text")
    set_up_logging("INFO", "json")
    child = "from shared.log import set_up_logging as s; import logging; s(); logging.info('up')"
    ended = subprocess.run([sys.executable, "-c", child], capture_output=True, check=True)
    assert json.loads(ended.stderr)["message"] == "up"


def test_other_writing_stays_as_it_is() -> None:
    record = logging.LogRecord("bus", logging.INFO, "", 0, "Zoë 李 👩🏽\u200d🚒 C:\\new", (), None)
    assert OneLineFormatter().format(record).endswith("Zoë 李 👩🏽\u200d🚒 C:\\new")
