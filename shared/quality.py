"""Quality of an estimate, in the words that unit, wire and console share."""

from __future__ import annotations

from enum import IntEnum, IntFlag


class Quality(IntEnum):
    """The numbers are those on the wire."""

    UNKNOWN = 0
    GOOD = 1
    DEGRADED = 2
    LOST = 3


# For what every message passes: a member is looked up through its class ten times as slowly.
GOOD, DEGRADED, LOST = Quality.GOOD, Quality.DEGRADED, Quality.LOST


class Reason(IntFlag):
    """Reasons that an estimate is not ``GOOD``, or no better; the bits are those on the wire."""

    NONE = 0
    ALIGNING = 1  # not enough stillness yet to know which way is down
    NO_STANCE = 2  # too long without a still instant
    GYRO_SATURATED = 4
    ACCEL_SATURATED = 8
    SAMPLE_GAP = 16
    BAD_SAMPLES = 32  # not finite, stuck or out of order: left out
    UNCERTAIN = 128  # stated standard deviation past what a commander can use
    UNSETTLED = 256  # no rest has shown the gyroscope's bias yet, and the heading suffers
    INCONSISTENT = (
        512  # stances contradict the motion between them, or did until the height was lost
    )
    NOT_ON_FOOT = 1024  # the motion is not that of a foot, for which the tracker is made


NOT_OF_STEPS = Reason.UNCERTAIN | Reason.UNSETTLED  # nothing against a path's last steps

_IN_WORDS = {
    Reason.ALIGNING: "which way is down is not known yet: stand still",
    Reason.NO_STANCE: "no footfall felt",
    Reason.GYRO_SATURATED: "turned faster than it measures",
    Reason.ACCEL_SATURATED: "struck harder than it measures",
    Reason.SAMPLE_GAP: "samples missing",
    Reason.BAD_SAMPLES: "samples unusable",
    Reason.UNCERTAIN: "place only roughly known",
    Reason.UNSETTLED: "heading not settled: stand still for five seconds",
    Reason.INCONSISTENT: "footfalls contradict the motion between them: height not known",
    Reason.NOT_ON_FOOT: "not worn on a foot: strap it to the instep",
}


def code_of(reason: Reason) -> str:
    """Code of a single reason: its name in lower case with hyphens."""
    return (reason.name or "").lower().replace("_", "-")


def codes_of(reasons: Reason) -> tuple[str, ...]:
    """Codes of reasons, in the order of their bits."""
    return tuple(map(code_of, reasons))


def in_words(reasons: Reason) -> str:
    """For a person, and what to do where anything helps."""
    return ", ".join(_IN_WORDS[reason] for reason in reasons) or "it gives no reason"
