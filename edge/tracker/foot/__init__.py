"""Tracker of a foot-mounted sensor: error-state Kalman filter with zero-velocity updates."""
