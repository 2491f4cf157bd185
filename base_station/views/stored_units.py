"""Views of units from the tables."""

from __future__ import annotations

import msgspec

from base_station.core.units.worn_sensors import DescribedSensor
from base_station.storage.db.models import Unit
from base_station.views.units import worn_sensor_views
from base_station.views.wire import WornSensorView


def stored_sensors(unit: Unit) -> tuple[WornSensorView, ...]:
    """Sensors of a unit according to its newest description; none in a table of an earlier
    version.
    """
    return worn_sensor_views(msgspec.json.decode(unit.sensors, type=tuple[DescribedSensor, ...]))
