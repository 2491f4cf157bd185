"""Pins: places of a wearer that people or beacons report, and the verdict on each.

A pin is stored as it was set, also where other data contradicts it; ``PinVerdict`` rates it.
"""

from __future__ import annotations

from typing import Literal

import msgspec

from shared.coded_text import NO_CODE, TextCode, code_of_text, coded, with_code

PinKind = Literal["place", "start", "meeting", "beacon", "tag"]
PinState = Literal["used", "conflict", "waiting"]


class Pin(msgspec.Struct, frozen=True):
    """One unit was at a place, near a beacon, or beside another unit."""

    pin_id: str
    kind: PinKind
    unit_id: str
    t_ns: int  # station time; 0: where the unit's path begins
    std_m: float  # each axis
    set_ns: int
    by: str  # a person, or the unit that saw it
    note: str = ""
    north_m: float | None = None  # in the incident frame; None: where ``other_id`` is
    east_m: float | None = None
    floor: int | None = None
    heading_rad: float | None = None  # which way the wearer looked or went
    heading_std_rad: float = 0.0
    other_id: str = ""  # the beacon or tag, or the other unit of a meeting
    is_ranged: bool = True  # else anywhere within reach of that


class PinVerdict(msgspec.Struct, frozen=True):
    """Verdict on a pin by the path that is solved with all evidence."""

    state: PinState
    residual_m: float | None = None  # between the pin and the trail
    sigmas: float | None = None  # the same in standard deviations of the expected place
    text: str = ""  # for a person: its conflict, or the reason why it waits
    of_units: tuple[tuple[str, PinVerdict], ...] = ()  # verdict of each unit that it is about
    text_code: TextCode = NO_CODE

    @classmethod
    def of(
        cls,
        state: PinState,
        text: str,
        residual_m: float | None = None,
        sigmas: float | None = None,
    ) -> PinVerdict:
        """Return a verdict; the text may carry its code."""
        return cls(state, residual_m, sigmas, str(text), text_code=code_of_text(text))

    @property
    def coded_text(self) -> str:
        """``text`` with its code."""
        return with_code(self.text, self.text_code)


class Beacon(msgspec.Struct):
    """Something with an id that hangs at a known place: a radio beacon or a tag."""

    beacon_id: str
    label: str
    north_m: float
    east_m: float
    floor: int | None
    std_m: float
    reach_m: float
    placed_ns: int
    by: str
    seen_ns: int | None = None  # when a unit last saw it


def reach_std_m(reach_m: float) -> float:
    """Standard deviation along each axis of a point anywhere within reach: its variance is a
    quarter of the square of the reach.
    """
    return max(reach_m / 2.0, 0.3)


WAITING = PinVerdict.of("waiting", coded("pin-not-solved", "not solved yet"))
