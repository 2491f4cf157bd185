"""Registry of outputs.  A new kind is a file and a line in ``NOTIFIERS``."""

from __future__ import annotations

from difflib import get_close_matches
from pathlib import Path

from edge.notifiers.beeper import BeeperNotifier
from edge.notifiers.interface import Notifier, NotifierKind
from edge.notifiers.led import LedNotifier
from edge.notifiers.sound import SoundNotifier
from edge.notifiers.speech import SpeechNotifier
from edge.notifiers.terminal import TerminalNotifier
from edge.sources.sysfs import SYSFS
from shared.errors import ConfigError

NOTIFIERS: tuple[NotifierKind, ...] = (
    NotifierKind("led", LedNotifier, "NAME", is_audible=False),
    NotifierKind("beeper", BeeperNotifier, "/dev/input/DEVICE"),
    NotifierKind("sound", SoundNotifier, "DEVICE (default, or another of `aplay -L`)"),
    NotifierKind("speech", SpeechNotifier, "VOICE"),
    NotifierKind("terminal", TerminalNotifier, "TITLE", is_audible=False),
)


def open_notifier(text: str, sysfs: Path = SYSFS) -> Notifier:
    """Return the output that ``scheme:argument`` names.  Raises ConfigError."""
    return _kind(text).make(text.partition(":")[2], sysfs)


def output_kind(text: str) -> str:
    """Return the scheme of an output, as a unit's description says it.  Raises ConfigError."""
    return _kind(text).scheme


def is_audible(text: str) -> bool:
    """True if others hear the output.  Raises ConfigError."""
    return _kind(text).is_audible


def _kind(text: str) -> NotifierKind:
    scheme, colon, argument = text.partition(":")
    for kind in NOTIFIERS:
        if colon and argument and kind.scheme == scheme:
            return kind
    choices = ", ".join(f"{kind.scheme}:{kind.argument}" for kind in NOTIFIERS)
    near = get_close_matches(scheme, [kind.scheme for kind in NOTIFIERS], n=1)
    hint = f"did you mean {near[0]}:? " if near and near[0] != scheme else ""
    raise ConfigError(f"{text!r} names no output; {hint}Known are {choices}")
