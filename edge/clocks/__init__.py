"""A unit's clocks: its source's, its machine's, the station's, and where they lie to each other."""
