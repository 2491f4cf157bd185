"""Clocks of a unit: its source's, its machine's, the station's, and their offsets."""
