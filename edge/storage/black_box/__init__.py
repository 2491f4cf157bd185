"""Black box: a unit's own recording of its raw samples, and its server for the station."""
