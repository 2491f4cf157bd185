"""Thermal classes of the equipment's environment, and the dose that they add up to.

Classes after NIST Technical Note 1474 (Donnelly et al.): I to 100 degC for 25 min, II to 160 degC
for 15 min, III to 260 degC for 5 min, IV above for less than 1 min.  Below 60 degC (ours)
nothing counts.  It says nothing of the wearer's own condition.
"""

from __future__ import annotations

CAUTION_DEGC = 100.0
WARNING_DEGC = 160.0
CRITICAL_DEGC = 260.0

# (above this temperature, time in which the whole dose is used up), hottest first
BANDS_DEGC_S = (
    (CRITICAL_DEGC, 60.0),
    (WARNING_DEGC, 300.0),
    (CAUTION_DEGC, 900.0),
    (60.0, 1500.0),
)


def dose_of(temperature_degc: float, duration_s: float) -> float:
    """The part of a unit's heat budget that this time at this temperature uses up."""
    for above_degc, limit_s in BANDS_DEGC_S:
        if temperature_degc > above_degc:
            return duration_s / limit_s
    return 0.0
