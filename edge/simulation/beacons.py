"""Radio beacons beside the path of a simulated wearer, and their signal strength."""

from __future__ import annotations

import math
from typing import Annotated

import msgspec
import numpy as np
from msgspec import Meta

from edge.path_loss import EXPONENT, POWER_DBM, range_of
from edge.samples import BEACON, SightingSample
from edge.simulation.legs import Metres
from shared.clock import NS_PER_S

RSSI_STD_DB = 4.0
LOWEST_DBM = -88.0  # the receiver's sensitivity
CEILING_DB_PER_M = 6.0  # of height: a floor lies between


class BeaconPlace(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Position of a beacon in the site frame."""

    beacon_id: Annotated[str, Meta(min_length=1, max_length=64)]
    north_m: Metres
    east_m: Metres
    down_m: Metres = 0.0


class Beacons:
    """Receiver on the wearer: sightings of beacons, once a second."""

    def __init__(self, places: tuple[BeaconPlace, ...], rng: np.random.Generator) -> None:
        self._places = places
        self._rng = rng

    def sightings(self, second: int, place_m: tuple[float, float, float]) -> list[SightingSample]:
        """At ``place_m``, north, east and down."""
        samples = []
        for one in self._places:
            apart_m = max(math.hypot(one.north_m - place_m[0], one.east_m - place_m[1]), 0.5)
            loss_db = 10.0 * EXPONENT * math.log10(apart_m)
            loss_db += CEILING_DB_PER_M * abs(one.down_m - place_m[2])
            rssi_dbm = POWER_DBM - loss_db + float(self._rng.normal(0.0, RSSI_STD_DB))
            if rssi_dbm >= LOWEST_DBM:
                t_ns = second * NS_PER_S
                samples.append(SightingSample(t_ns, BEACON, one.beacon_id, *range_of(rssi_dbm)))
        return samples
