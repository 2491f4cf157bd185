"""Data of the pipeline: state of the station, its units, alarms, commands, pins and incidents.

Only the pipeline changes it.  All of it can be encoded and decoded again, so that a station starts
from a checkpoint and not from the beginning of the log.  Nothing here imports another package of
the core.
"""

from base_station.core.state.alarm import Alarm
from base_station.core.state.incident import Dispatch, Incident
from base_station.core.state.site import OWN_SITE_ID, SiteState
from base_station.core.state.station import Counts, IdempotencyRecord, StationState
from base_station.core.state.unit import STILL_NS, Fault, GpsUse, UnitState
from base_station.core.state.unit_wearer import ERASED_TEXT, WEARERS_KEPT, FormerWearer, Person

__all__ = [
    "ERASED_TEXT",
    "OWN_SITE_ID",
    "STILL_NS",
    "WEARERS_KEPT",
    "Alarm",
    "Counts",
    "Dispatch",
    "Fault",
    "FormerWearer",
    "GpsUse",
    "IdempotencyRecord",
    "Incident",
    "Person",
    "SiteState",
    "StationState",
    "UnitState",
]
