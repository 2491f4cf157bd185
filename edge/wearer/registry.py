"""Registry of buttons.  A new kind is a file and a line in ``BUTTONS``."""

from __future__ import annotations

from difflib import get_close_matches
from urllib.parse import parse_qsl

from edge.wearer.evdev_button import EvdevButton
from edge.wearer.gestures import HOLD_LEAST_NS, HOLD_MOST_NS, HOLD_NS
from edge.wearer.interface import ButtonKind
from edge.wearer.reader import ButtonReader
from edge.wearer.socket_button import SocketButton
from shared.clock import NS_PER_S, Clock
from shared.coded_text import coded
from shared.errors import ConfigError
from shared.options import number_within

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
    hold_ns = _hold_ns(text, options.pop("hold", None))
    for kind in BUTTONS:
        if colon and argument and kind.scheme == scheme:
            driver = kind.make(argument, options, clock)
            return ButtonReader(
                coded("device-button", "button {name}", name=text), driver, clock, hold_ns
            )
    choices = ", ".join(f"{kind.scheme}:{kind.argument}" for kind in BUTTONS)
    schemes = [kind.scheme for kind in BUTTONS]
    near = get_close_matches(scheme, schemes, n=1)
    hint = f"did you mean {near[0]}:? " if near and near[0] != scheme else ""
    raise ConfigError(f"{text!r} names no button; {hint}Known are {choices}")


def _hold_ns(text: str, given: str | None) -> int:
    """Return after how long a hold is a mayday.  Raises ConfigError."""
    if given is None:
        return HOLD_NS
    least_s, most_s = HOLD_LEAST_NS / NS_PER_S, HOLD_MOST_NS / NS_PER_S
    hold_s = number_within(given, least_s, most_s)
    if hold_s is None:
        raise ConfigError(
            f"{text}: hold is {given!r}; give the seconds after which a hold is a mayday, "
            f"{least_s:g} to {most_s:g}"
        )
    return round(hold_s * NS_PER_S)
