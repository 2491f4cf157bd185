"""Alarm rules, one a file, in the order in which the console lists them.

To add one: write ``base_station/core/alarms/<name>.py`` with a frozen dataclass that has the
attributes and the one method of ``AlarmRule`` (see ``interface``), thresholds as fields with their
defaults, and name it in ``ALARMS``.  A rule only judges a unit's state at an instant; raising,
acknowledging, resolving, latching and hysteresis in time are the ``AlarmManager``'s.  The suite
``tests/contracts/test_alarms.py`` runs over every entry.
"""

from __future__ import annotations

from base_station.core.alarms.battery import BatteryLow
from base_station.core.alarms.calibration import CalibrationPoor
from base_station.core.alarms.cloned_unit import ClonedUnit
from base_station.core.alarms.fall import Fall
from base_station.core.alarms.gps_unused import GpsUnused
from base_station.core.alarms.heat import Heat
from base_station.core.alarms.heat_dose import HeatDose
from base_station.core.alarms.interface import AlarmRule
from base_station.core.alarms.link_lost import LinkLost
from base_station.core.alarms.mayday import Mayday
from base_station.core.alarms.missed_check_in import MissedCheckIn
from base_station.core.alarms.no_motion import NoMotion
from base_station.core.alarms.position_lost import PositionLost
from base_station.core.alarms.rest_due import RestDue
from base_station.core.alarms.tracker_degraded import TrackerDegraded
from base_station.core.alarms.tracker_fault import TrackerFault
from base_station.core.alarms.tracker_gone import TrackerGone
from base_station.core.alarms.unit_fault import UnitFault
from base_station.core.alarms.unknown_unit import UnknownUnit
from base_station.core.alarms.worn_wrong import WornWrong

ALARMS: tuple[AlarmRule, ...] = (
    Mayday(),
    Fall(),
    NoMotion(),
    MissedCheckIn(),
    Heat(),
    HeatDose(),
    BatteryLow(),
    LinkLost(),
    TrackerDegraded(),
    TrackerGone(),
    WornWrong(),
    PositionLost(),
    GpsUnused(),
    UnitFault(),
    TrackerFault(),
    UnknownUnit(),
    ClonedUnit(),
    CalibrationPoor(),
    RestDue(),
)
