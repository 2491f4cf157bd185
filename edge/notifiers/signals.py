"""Signals to the wearer: what each means, how urgent it is, and its pattern of light and sound.

Patterns differ in rhythm, which can be recognised through gloves, smoke and noise; pitch helps
where the output has one.  A rising sequence is the pre-alert's alone, as with other personal alert
safety systems.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import StrEnum


class Signal(StrEnum):
    """Signals, the most urgent first."""

    EVACUATE = "evacuate"
    PRE_ALERT = "pre-alert"
    NO_MOTION = "no motion"
    MAYDAY_CALLED = "mayday called"
    PAR_REQUEST = "PAR request"
    TEXT = "message"
    ALL_CLEAR = "all clear"
    MAYDAY_ACKNOWLEDGED = "mayday acknowledged"
    ALARM_ACKNOWLEDGED = "alarm acknowledged"
    LOCATE = "locate"
    MAYDAY_SENT = "mayday sent"
    NOT_ON_FOOT = "worn wrongly"
    LINK_LOST = "link lost"
    BATTERY_LOW = "battery low"

    @property
    def urgency(self) -> int:
        """0 is the most urgent."""
        return list(Signal).index(self)


_PAUSES_S = {
    Signal.EVACUATE: 0.0,
    Signal.PRE_ALERT: 0.0,
    Signal.NO_MOTION: 0.0,
    Signal.LOCATE: 0.0,
    Signal.PAR_REQUEST: 10.0,
    Signal.TEXT: 30.0,
    Signal.ALL_CLEAR: 30.0,
}


@dataclass(frozen=True, slots=True)
class Notice:
    """Signal of one cause; equal notices are the same one, however often they are shown."""

    signal: Signal
    key: str = ""  # of its cause, such as the command's id
    text: str = ""  # of a message

    @property
    def pause_s(self) -> float:
        """Time from its end until it is played again; infinite: it is played once."""
        return _PAUSES_S.get(self.signal, math.inf)


@dataclass(frozen=True, slots=True)
class Pulse:
    """Light and tone, and the darkness and silence after them."""

    on_s: float
    off_s: float
    tone_hz: int


_HIGH_HZ, _MIDDLE_HZ, _LOW_HZ = 2900, 2000, 1000  # helmets and hoods dampen what is higher

PATTERNS: dict[Signal, tuple[Pulse, ...]] = {
    Signal.EVACUATE: (Pulse(0.12, 0.08, _HIGH_HZ),) * 10,
    Signal.PRE_ALERT: tuple(Pulse(0.1 + 0.05 * step, 0.1, 1000 + 400 * step) for step in range(6)),
    Signal.NO_MOTION: (Pulse(2.0, 0.1, _HIGH_HZ),),
    Signal.MAYDAY_CALLED: (Pulse(0.3, 0.1, _LOW_HZ), Pulse(0.9, 0.3, _HIGH_HZ)),
    Signal.PAR_REQUEST: (Pulse(0.4, 0.2, _MIDDLE_HZ), Pulse(0.4, 1.0, _HIGH_HZ)),
    Signal.TEXT: (Pulse(0.15, 0.1, _MIDDLE_HZ),) * 3 + (Pulse(0.15, 1.0, _MIDDLE_HZ),),
    Signal.ALL_CLEAR: (Pulse(0.8, 0.2, _LOW_HZ),) * 2 + (Pulse(0.8, 1.0, _LOW_HZ),),
    Signal.LOCATE: (Pulse(1.0, 0.5, _HIGH_HZ),),
    # Like neither of the two before it: a mayday goes up, and its answer comes down in three steps.
    Signal.MAYDAY_ACKNOWLEDGED: (
        Pulse(0.2, 0.1, _HIGH_HZ),
        Pulse(0.2, 0.1, _MIDDLE_HZ),
        Pulse(1.2, 1.0, _LOW_HZ),
    ),
    Signal.ALARM_ACKNOWLEDGED: (Pulse(1.2, 0.2, _MIDDLE_HZ),) + (Pulse(0.2, 0.1, _LOW_HZ),) * 2,
    Signal.MAYDAY_SENT: (Pulse(0.8, 0.2, _LOW_HZ), Pulse(0.8, 1.0, _HIGH_HZ)),
    Signal.NOT_ON_FOOT: (Pulse(0.5, 0.2, _LOW_HZ),) * 2 + (Pulse(0.1, 1.0, _LOW_HZ),),
    Signal.LINK_LOST: (Pulse(0.6, 0.3, _MIDDLE_HZ), Pulse(0.6, 1.0, _LOW_HZ)),
    Signal.BATTERY_LOW: (Pulse(0.1, 0.4, _LOW_HZ),) * 3 + (Pulse(0.1, 1.0, _LOW_HZ),),
}

_SENTENCES = {
    Signal.EVACUATE: "Evacuate. Leave the building now.",
    Signal.PRE_ALERT: "You are not moving. Move, or press the button.",
    Signal.NO_MOTION: "Firefighter down here.",
    Signal.MAYDAY_CALLED: "Mayday called.",
    Signal.PAR_REQUEST: "PAR. Press the button if you are well.",
    Signal.TEXT: "Message:",
    Signal.ALL_CLEAR: "All clear. The evacuation is over.",
    Signal.LOCATE: "You are being located.",
    Signal.MAYDAY_ACKNOWLEDGED: "The commander knows of your mayday.",
    Signal.ALARM_ACKNOWLEDGED: "The commander knows of your alarm.",
    Signal.MAYDAY_SENT: "Your mayday has reached the station.",
    Signal.NOT_ON_FOOT: "This unit is not on a foot. Your position is not known.",
    Signal.LINK_LOST: "No link. The commander does not see you.",
    Signal.BATTERY_LOW: "Battery low.",
}


def sentence(notice: Notice) -> str:
    """Return what is spoken or shown."""
    return f"{_SENTENCES[notice.signal]} {notice.text}".strip()
