"""Reports of gpsd: one JSON object a line (gpsd_json(5)).  Members that are not read are left
out.

Errors come with "certainty unknown" and a history.  ``GST`` is the receiver's own, one sigma.
``eph`` and ``epv`` are the receiver's own where its driver has them (u-blox: one sigma, radial);
elsewhere gpsd multiplies a dilution of precision by a range error of the last century (19 m and
23 m at 95 %, a quarter of it with corrections; gpsd_error_model in libgpsd_core.c), which is
recognised by the quotient and replaced by the estimate for NMEA (``accuracy``).  ``epx`` and
``epy``, the only errors of old versions, are 95 %.
"""

from __future__ import annotations

import math
from datetime import datetime

import msgspec

from edge.samples import GpsSample
from edge.sources.gnss.accuracy import (
    NAN,
    UERE_CARRIER_M,
    UERE_CORRECTED_M,
    UERE_SINGLE_M,
    first_known,
    from_axes,
    from_dop,
    from_hdop,
)
from edge.sources.gnss.interface import MOST_SATELLITES
from shared.clock import NS_PER_S
from shared.errors import WireError

_GUESSED_H_M = (19.0, 4.75)
_GUESSED_V_M = (23.0, 5.75)
_GUESSED_WITHIN = 0.02
_OF_95 = 1.96
_NO_FIX_STATUS = frozenset({5, 6, 8})  # dead reckoning, with and without satellites; simulated
_UERE_M = {2: UERE_CORRECTED_M, 3: UERE_CARRIER_M, 4: UERE_CARRIER_M}  # by status


class _Class(msgspec.Struct):
    cls: str = msgspec.field(name="class")


class Tpv(msgspec.Struct):
    """A fix."""

    mode: int = 0
    status: int = 1
    device: str = ""
    time: str | float | None = None  # numbers were of versions before 3
    lat: float = NAN
    lon: float = NAN
    altHAE: float = NAN  # noqa: N815  # gpsd's name: above the ellipsoid
    altMSL: float = NAN  # noqa: N815  # above the sea
    geoidSep: float = NAN  # noqa: N815  # the sea above the ellipsoid
    eph: float = NAN
    epx: float = NAN
    epy: float = NAN
    epv: float = NAN
    speed: float = NAN  # m/s
    track: float = NAN  # degrees from true north

    @property
    def of_day_ns(self) -> int | None:
        """UTC since midnight."""
        if not isinstance(self.time, str):
            return None
        try:
            at = datetime.fromisoformat(self.time)
        except ValueError:  # such as a leap second
            return None
        seconds = (at.hour * 60 + at.minute) * 60 + at.second
        return seconds * NS_PER_S + at.microsecond * 1000


class _Satellite(msgspec.Struct):
    used: bool = False


class Sky(msgspec.Struct):
    """Geometry of the satellites."""

    device: str = ""
    hdop: float = NAN
    vdop: float = NAN
    uSat: int | None = None  # noqa: N815  # used; versions before 3.22 only list them
    satellites: list[_Satellite] | None = None

    @property
    def used(self) -> int | None:
        if self.uSat is not None:
            return self.uSat
        return None if self.satellites is None else sum(one.used for one in self.satellites)


class Gst(msgspec.Struct):
    """The receiver's own standard deviations, in metres."""

    device: str = ""
    lat: float = NAN
    lon: float = NAN
    alt: float = NAN


class Device(msgspec.Struct):
    """A receiver; ``activated`` 0 once it is gone, and a time or its text before."""

    path: str = ""
    activated: str | float | None = None


class Devices(msgspec.Struct):
    devices: list[Device] = []  # a new one each time: msgspec's


class Error(msgspec.Struct):
    message: str = ""


class OtherReport(msgspec.Struct):
    """Report of no use here."""


GpsdReport = Tpv | Sky | Gst | Device | Devices | Error | OtherReport
_READ: dict[str, type[GpsdReport]] = {
    "TPV": Tpv,
    "SKY": Sky,
    "GST": Gst,
    "DEVICE": Device,
    "DEVICES": Devices,
    "ERROR": Error,
}


def report_of(line: bytes) -> GpsdReport | None:
    """None of an empty line.  Raises WireError for what gpsd does not say."""
    if not line.strip():
        return None
    try:
        kind = msgspec.json.decode(line, type=_Class).cls
        return msgspec.json.decode(line, type=_READ.get(kind, OtherReport))
    except (msgspec.DecodeError, UnicodeDecodeError) as error:
        raise WireError(f"not what gpsd says ({error})") from error


def fix_of(tpv: Tpv, sky: Sky, gst: Gst, satellites: int, t_ns: int) -> GpsSample:
    """The fix, with satellites and errors of the reports about the same time."""
    located = abs(tpv.lat) <= 90.0 and abs(tpv.lon) <= 180.0
    fix_type = tpv.mode if tpv.mode in {2, 3} and located else 0
    if tpv.status in _NO_FIX_STATUS:
        fix_type = 0
    height_m = tpv.altHAE if math.isfinite(tpv.altHAE) else tpv.altMSL + tpv.geoidSep
    if fix_type == 3 and not math.isfinite(height_m):
        fix_type = 2
    uere_m = _UERE_M.get(tpv.status, UERE_SINGLE_M)
    return GpsSample(
        t_ns=t_ns,
        lat_deg=tpv.lat if fix_type else NAN,
        lon_deg=tpv.lon if fix_type else NAN,
        height_m=height_m if fix_type == 3 else NAN,
        horizontal_std_m=first_known(
            from_axes(gst.lat, gst.lon),
            _own(tpv.eph, sky.hdop, _GUESSED_H_M) / math.sqrt(2.0),
            from_hdop(sky.hdop, uere_m),
            from_axes(tpv.epy, tpv.epx) / _OF_95,
        ),
        vertical_std_m=first_known(
            gst.alt,
            _own(tpv.epv, sky.vdop, _GUESSED_V_M),
            from_dop(sky.vdop, uere_m),
        ),
        fix_type=fix_type,
        satellites=min(max(0, satellites), MOST_SATELLITES),
        speed_mps=tpv.speed,
        course_rad=math.radians(tpv.track % 360.0),
    )


def _own(error_m: float, dop: float, guessed_m: tuple[float, ...]) -> float:
    """An error that is the receiver's own; NaN of gpsd's guess."""
    near = (math.isclose(error_m, dop * guess_m, rel_tol=_GUESSED_WITHIN) for guess_m in guessed_m)
    return NAN if any(near) else error_m
