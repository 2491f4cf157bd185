"""``muster bench bus``: what the bus and the station behind it take in."""
