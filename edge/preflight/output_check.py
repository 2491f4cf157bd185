"""Check of the outputs that notify the wearer: each plays a test message once, for a person."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from pathlib import Path
from threading import Event

from edge.notifiers.registry import open_notifier
from edge.notifiers.signals import Notice, Signal
from edge.preflight.finding import HAS_NONE, CheckFinding, Severity, subject
from edge.sources.sysfs import SYSFS, explain_read_error

_TEST = Notice(Signal.TEXT, text="this is a test.")
_NO_WEARER_NOTIFIED = "the wearer cannot be notified of orders; it takes the voice radio"
NO_OUTPUT = CheckFinding(
    subject("output", "output"),
    Severity.WARNING,
    HAS_NONE,
    _NO_WEARER_NOTIFIED,
)


def output_findings(texts: Iterable[str], sysfs: Path = SYSFS) -> Iterator[CheckFinding]:
    """Play a test message on each output, as in the settings.  Raises ConfigError."""
    notifiers = {text: open_notifier(text, sysfs) for text in texts}
    if not notifiers:
        yield NO_OUTPUT
    for text, notifier in notifiers.items():
        output = f"output {text}"
        try:
            notifier.play(_TEST, Event())
            notifier.close()
        except OSError as error:
            yield CheckFinding(
                output, Severity.FAILED, explain_read_error(error), _NO_WEARER_NOTIFIED
            )
        else:
            yield CheckFinding(
                output, Severity.OK, "has played a test message; was it seen or heard?"
            )
