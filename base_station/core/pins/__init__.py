"""Pins: constraints on units' paths from people, beacons and encounters, and the paths solved with
them.
"""
