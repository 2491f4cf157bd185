"""Registry of buttons.  A new kind is a file and a line in ``BUTTONS``."""

from __future__ import annotations

from difflib import get_close_matches
from urllib.parse import parse_qsl

from edge.wearer.evdev_button import EvdevButton
from edge.wearer.interface import ButtonKind
from edge.wearer.reader import ButtonReader
from edge.wearer.socket_button import SocketButton
from shared.clock import Clock
from shared.errors import ConfigError

BUTTONS: tuple[ButtonKind, ...] = (
    ButtonKind("evdev", EvdevButton, "NAME or /dev/input/eventN, with ?key=KEY_POWER"),
    ButtonKind("socket", SocketButton, "PATH"),
)


def open_button(text: str, clock: Clock) -> ButtonReader:
    """Return a reader of the button that ``scheme:argument?option=value`` names.

    Raises ConfigError.
    """
    place, _, rest = text.partition("?")
    scheme, colon, argument = place.partition(":")
    options = dict(parse_qsl(rest, keep_blank_values=True))
    for kind in BUTTONS:
        if colon and argument and kind.scheme == scheme:
            driver = kind.make(argument, options, clock)
            return ButtonReader(f"button {text}", driver, clock)
    choices = ", ".join(f"{kind.scheme}:{kind.argument}" for kind in BUTTONS)
    schemes = [kind.scheme for kind in BUTTONS]
    near = get_close_matches(scheme, schemes, n=1)
    hint = f"did you mean {near[0]}:? " if near and near[0] != scheme else ""
    raise ConfigError(f"{text!r} names no button; {hint}Known are {choices}")
