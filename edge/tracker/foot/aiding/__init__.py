"""Aiding sensors: barometer and magnetometer, each with a filter for its own errors."""
