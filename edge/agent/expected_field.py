"""Expected magnetic field of the Earth, by the settings, then by the first good fix."""

from __future__ import annotations

import math
from collections.abc import Callable

from edge.samples import ApproximatePosition, GpsSample, SensorBatch
from shared.clock import NS_PER_S
from shared.earth_field import EarthField, earth_field

_DAY_NS = 86_400 * NS_PER_S
_FAR_M = 5_000.0  # a fix that is no better adds nothing to the settings
_PLACE_DIGITS = 2  # of degrees; over a kilometre the field hardly changes


class ExpectedField:
    """Source of the expected field; reports a change at most twice.

    Place and date are rounded, so that a replay, whose times differ a little, gives exactly the
    same field.
    """

    def __init__(self, place: ApproximatePosition | None) -> None:
        self._place = place
        self._fixed = False

    def take(
        self, batch: SensorBatch, utc_ns_of: Callable[[int], int]
    ) -> tuple[EarthField, int] | None:
        """The field, and the source's time from which it holds.

        ``utc_ns_of`` gives the date of a source's time.  While that is no date of the model,
        because the clock has not been set, None is returned, and the next batch is tried.
        """
        if self._fixed:
            return None
        for sample in batch.others:
            if isinstance(sample, GpsSample) and _is_good(sample):
                field = _field(sample.lat_deg, sample.lon_deg, utc_ns_of(sample.t_ns))
                self._fixed = field is not None
                if field is not None:
                    return field, sample.t_ns
        if self._place is None or not len(batch.imu):
            return None
        t_ns = int(batch.imu.t_ns[0])
        field = _field(self._place.lat_deg, self._place.lon_deg, utc_ns_of(t_ns))
        if field is None:
            return None
        self._place = None
        return field, t_ns


def _is_good(fix: GpsSample) -> bool:
    located = math.isfinite(fix.lat_deg) and math.isfinite(fix.lon_deg)
    return located and fix.fix_type >= 2 and not fix.horizontal_std_m > _FAR_M


def _field(lat_deg: float, lon_deg: float, utc_ns: int) -> EarthField | None:
    lat_deg, lon_deg = round(lat_deg, _PLACE_DIGITS), round(lon_deg, _PLACE_DIGITS)
    found = earth_field(lat_deg, lon_deg, 0.0, utc_ns - utc_ns % _DAY_NS)
    return None if isinstance(found, str) else found
