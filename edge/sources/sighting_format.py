"""Line format of readers of beacons, tags or ranges: one line of text for each sighting.

::

    beacon door-3 range=2.4 std=0.3
    beacon door-3 rssi=-71 power=-59
    tag 04A2B9
    unit FF-02 range=1.5

The kind, an id without spaces, then what was measured; the time is when the line came.  ``rssi`` is
in dBm and ``power`` that of the beacon at one metre.  Empty lines and those that begin with ``#``
say nothing.
"""

from __future__ import annotations

import math
import re

from edge.path_loss import LEAST_RSSI_DBM, MOST_RSSI_DBM, POWER_DBM, range_of
from edge.samples import BEACON, TAG, UNIT, SightingSample
from shared.errors import WireError

LONGEST = 200  # characters of a line
_KINDS = (BEACON, TAG, UNIT)
_ID = re.compile(r"[A-Za-z0-9][A-Za-z0-9_.:-]{0,63}")
_KNOWN = ("range", "std", "rssi", "power")
_FURTHEST_M = 1000.0


def sighting_of(line: str, t_ns: int) -> SightingSample | None:
    """Return the sighting of a line that came at ``t_ns``; None of an empty one.  Raises
    WireError.
    """
    parts = line.split()
    if not parts or parts[0].startswith("#"):
        return None
    if len(line) > LONGEST:
        raise WireError(f"longer than {LONGEST} characters")
    kind, seen_id, measured = _head(parts)
    values = dict(_value(part) for part in measured)
    range_m, std_m = _range(values)
    return SightingSample(t_ns, kind, seen_id, range_m, std_m)


def _head(parts: list[str]) -> tuple[str, str, list[str]]:
    if parts[0] not in _KINDS or len(parts) == 1:
        raise WireError(f"{parts[0]!r}: a line begins with {', '.join(_KINDS)} and an id")
    if not _ID.fullmatch(parts[1]):
        raise WireError(f"{parts[1]!r} is no id: 1 to 64 letters, digits or _ . : -")
    return parts[0], parts[1], parts[2:]


def _value(part: str) -> tuple[str, float]:
    name, _, text = part.partition("=")
    if name not in _KNOWN:
        raise WireError(f"{part!r}: known are {', '.join(f'{one}=' for one in _KNOWN)}")
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        raise WireError(f"{part!r} has no number")
    return name, value


def _range(values: dict[str, float]) -> tuple[float, float]:
    if "rssi" in values and "range" not in values:
        rssi_dbm, power_dbm = values["rssi"], values.get("power", POWER_DBM)
        for name, level_dbm in (("rssi", rssi_dbm), ("power", power_dbm)):
            if not LEAST_RSSI_DBM <= level_dbm <= MOST_RSSI_DBM:
                raise WireError(f"{name}={level_dbm:g} is no level in dBm")
        return range_of(rssi_dbm, power_dbm)
    range_m, std_m = values.get("range", math.nan), values.get("std", math.nan)
    if range_m < 0.0 or range_m > _FURTHEST_M or std_m < 0.0:
        raise WireError(f"a range is 0 to {_FURTHEST_M:.0f} m, and its std not negative")
    return range_m, std_m
