"""Pins: who was where, as people and beacons tell it, and the past solved again with them."""
