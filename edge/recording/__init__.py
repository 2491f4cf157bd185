"""The black box: a unit's own recording of its raw sensors, and how the station gets it."""
