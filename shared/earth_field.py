"""The earth's magnetic field by place and date, from the World Magnetic Model.

The model is published for five years at a time, with the error it is believed to have (Chulliat
et al., "The US/UK World Magnetic Model for 2025-2030", 2025, section 3).  Here are those of 2010
to 2030.  For five years more the last one is carried on, with more doubt each year; for any other
date there is no answer, because a clock that says so is wrong.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from datetime import UTC, datetime
from functools import lru_cache
from typing import Any

from pygeomag import GeoMag
from pygeomag.wmm.wmm_2010 import WMM_2010
from pygeomag.wmm.wmm_2015v2 import WMM_2015v2
from pygeomag.wmm.wmm_2020 import WMM_2020
from pygeomag.wmm.wmm_2025 import WMM_2025

_FIRST_YEAR = 2010.0
_LASTS_YEARS = 5.0
_MODELS: tuple[tuple[Any, ...], ...] = (WMM_2010, WMM_2015v2, WMM_2020, WMM_2025)
_LAST_YEAR = _FIRST_YEAR + _LASTS_YEARS * len(_MODELS)
_CARRIED_ON_YEARS = 5.0
# The published error: of the core's field, and of what rock and weather in space add (nT).
_CORE_STD_DEG = 0.26
_ROCK_STD_NT = 5417.0  # degrees times horizontal nanotesla
_HORIZONTAL_STD_UT = 0.133
_VERTICAL_STD_UT = 0.141
_CARRIED_ON_DEG_A_YEAR = 0.1  # how well the yearly change itself is known


@dataclass(frozen=True, slots=True)
class EarthField:
    """North, east and down of the undisturbed field, as heading, strength and dip."""

    declination_rad: float  # of magnetic north, east of true north positive
    declination_std_rad: float
    horizontal_ut: float
    down_ut: float
    horizontal_std_ut: float
    down_std_ut: float


@lru_cache(maxsize=64)
def earth_field(lat_deg: float, lon_deg: float, height_m: float, utc_ns: int) -> EarthField | str:
    """The field at a place and time (height above the ellipsoid), or in words why not."""
    place_known = abs(lat_deg) <= 90.0 and abs(lon_deg) <= 360.0 and abs(height_m) < 1e5
    if not place_known:  # also when one is not a number
        return "the place is none on the earth"
    year = _year_of(utc_ns)
    if not _FIRST_YEAR <= year < _LAST_YEAR + _CARRIED_ON_YEARS:
        return f"no magnetic model is known for the year {year:.0f}; is the clock right?"
    which = min(int((year - _FIRST_YEAR) / _LASTS_YEARS), len(_MODELS) - 1)
    found = GeoMag(coefficients_data=_MODELS[which]).calculate(
        lat_deg, lon_deg, height_m * 1e-3, year, allow_date_outside_lifespan=True
    )
    over_years = max(year - _LAST_YEAR, 0.0)
    std_deg = math.hypot(_CORE_STD_DEG, _ROCK_STD_NT / max(found.h, 1.0))
    std_deg = math.hypot(std_deg, _CARRIED_ON_DEG_A_YEAR * over_years)
    return EarthField(
        declination_rad=math.radians(found.d),
        declination_std_rad=min(math.radians(std_deg), math.pi),
        horizontal_ut=found.h * 1e-3,
        down_ut=found.z * 1e-3,
        horizontal_std_ut=_HORIZONTAL_STD_UT,
        down_std_ut=_VERTICAL_STD_UT,
    )


def _year_of(utc_ns: int) -> float:
    """The year with its fraction, by UTC; infinite where there is no such date."""
    try:
        at = datetime.fromtimestamp(utc_ns * 1e-9, UTC)
        first = datetime(at.year, 1, 1, tzinfo=UTC)
        after = datetime(at.year + 1, 1, 1, tzinfo=UTC)
    except (OverflowError, OSError, ValueError):
        return math.inf
    return at.year + (at - first) / (after - first)
