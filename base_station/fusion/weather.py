"""The change of air pressure that everybody shares, as the height that it feigns.

Told by one barometer that stays where it is (the reference), or by those of people outside, whose
own paths say how they climb.  Every barometer has an offset of its own, so that only changes
count: one that joins begins at what is held already, and nobody moves by its joining or leaving.
"""

from __future__ import annotations

import msgspec

from shared.clock import NS_PER_S

FRESH_NS = 10 * NS_PER_S
SMOOTHING_S = 10.0


class _Source(msgspec.Struct):
    offset_m: float  # of its own, by which it agrees with the others
    t_ns: int


class Weather(msgspec.Struct):
    """Station times."""

    rise_m: float = 0.0  # by so much everybody's barometer reads too high since the beginning
    t_ns: int | None = None  # when that was last measured
    sources: dict[str, _Source] = msgspec.field(default_factory=dict)

    def note(self, name: str, t_ns: int, altitude_m: float, own_down_m: float) -> None:
        """A barometer's altitude, and how far down it is by anything but its barometer."""
        rise_m = altitude_m + own_down_m
        source = self.sources.get(name)
        if source is None or t_ns - source.t_ns > FRESH_NS:
            self.sources[name] = _Source(rise_m - self.rise_m, t_ns)
            self.t_ns = max(t_ns, self.t_ns or t_ns)
            return
        source_s = (t_ns - source.t_ns) / NS_PER_S
        source.t_ns = t_ns
        others = sum(t_ns - other.t_ns <= FRESH_NS for other in self.sources.values())
        gain = min(1.0, source_s / SMOOTHING_S / others)
        self.rise_m += gain * (rise_m - source.offset_m - self.rise_m)
        self.t_ns = max(t_ns, self.t_ns or t_ns)

    def is_known(self, t_ns: int) -> bool:
        """Whether somebody measures it now."""
        return self.t_ns is not None and t_ns - self.t_ns <= FRESH_NS

    def forget(self, name: str) -> None:
        self.sources.pop(name, None)
