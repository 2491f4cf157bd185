"""Codec of sensor batches: sent by a unit that does not track, recorded, and received."""
