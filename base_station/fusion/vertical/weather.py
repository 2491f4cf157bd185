"""Barometric heights with the change of the weather removed.

The change of pressure that is common to all is kept as an apparent height. It is measured by the
reference barometer, which does not move, or by barometers of units outside, whose own paths give
their climbs. Every barometer has its own offset, so that only changes count: one that joins begins
at the present value, and no estimate moves when one joins or leaves. The same holds for a reference
that was carried elsewhere, once it stays there.
"""

from __future__ import annotations

import msgspec

from base_station.fusion.interface import BarometricHeight
from shared.clock import NS_PER_S
from shared.geo import pressure_altitude_m
from shared.messages import Position

FRESH_NS = 10 * NS_PER_S
SMOOTHING_S = 10.0
LEAST_PA, MOST_PA = 30_000.0, 120_000.0  # where people live


class _Source(msgspec.Struct):
    offset_m: float  # of its own, by which it agrees with the others
    t_ns: int


class Weather(msgspec.Struct):
    """Common change of pressure, as an apparent height; station times."""

    rise_m: float = 0.0  # by so much everybody's barometer reads too high since the beginning
    t_ns: int | None = None  # when that was last measured
    sources: dict[str, _Source] = msgspec.field(default_factory=dict)

    def note(self, name: str, t_ns: int, altitude_m: float, own_down_m: float) -> None:
        """A barometer's altitude, and how far down it is by anything but its barometer."""
        rise_m = altitude_m + own_down_m
        source = self.sources.get(name)
        if source is None or t_ns - source.t_ns > FRESH_NS:
            self.sources = {
                other: one for other, one in self.sources.items() if t_ns - one.t_ns <= FRESH_NS
            }
            self.sources[name] = _Source(rise_m - self.rise_m, t_ns)
            self.t_ns = max(t_ns, self.t_ns or t_ns)
            return
        if t_ns <= source.t_ns:  # its clock was wrong, now or before
            return
        source_s = (t_ns - source.t_ns) / NS_PER_S
        source.t_ns = t_ns
        others = sum(t_ns - other.t_ns <= FRESH_NS for other in self.sources.values())
        gain = min(1.0, source_s / SMOOTHING_S / others)
        self.rise_m += gain * (rise_m - source.offset_m - self.rise_m)
        self.t_ns = max(t_ns, self.t_ns or t_ns)

    def is_known(self, t_ns: int) -> bool:
        """True while a barometer measures the weather."""
        return self.t_ns is not None and t_ns - self.t_ns <= FRESH_NS


class Barometers(msgspec.Struct):
    """Barometers of all units, with the reference."""

    reference_id: str | None = None  # the unit whose barometer stays at its place
    reference_down_m: float = 0.0
    reference_walked: tuple[int, float] = 0, 0.0  # which run of its program, and how far in that
    carried_ns: int | None = None  # when that grew last
    weather: Weather = msgspec.field(default_factory=Weather)

    def set_reference(self, unit_id: str | None, down_m: float) -> None:
        self.reference_id, self.reference_down_m = unit_id, down_m
        self.reference_walked, self.carried_ns = (0, 0.0), None
        self.weather.sources.clear()

    def update(
        self, unit_id: str, t_ns: int, position: Position, *, is_outside: bool
    ) -> BarometricHeight | None:
        """Barometric height of a position; None without pressure, or with an impossible one."""
        pressure_pa = position.pressure_pa
        if pressure_pa is None or not LEAST_PA < pressure_pa < MOST_PA:
            return None
        altitude_m = pressure_altitude_m(pressure_pa)
        if self.reference_id == unit_id:
            self._watch_reference(position, t_ns)
            if self.carried_ns is None or t_ns - self.carried_ns > FRESH_NS:
                self.weather.note(unit_id, t_ns, altitude_m, self.reference_down_m)
        elif self.reference_id is None and is_outside:
            name = f"{unit_id} {position.header.boot_id}"  # its own height begins anew with it
            self.weather.note(name, t_ns, altitude_m, position.down_m)
        return BarometricHeight(
            t_mono_ns=position.header.t_mono_ns,
            down_m=self.weather.rise_m - altitude_m,
            referenced=self.weather.is_known(t_ns),
        )

    def _watch_reference(self, position: Position, t_ns: int) -> None:
        """Detect that the reference is carried: its changes are then climbs."""
        walked = position.header.boot_id, position.distance_m
        if walked[0] == self.reference_walked[0] and walked[1] > self.reference_walked[1]:
            self.carried_ns = t_ns
            self.weather.sources.clear()
        self.reference_walked = walked
