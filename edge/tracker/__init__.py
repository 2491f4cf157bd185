"""Trackers: plug-ins that turn inertial samples into positions."""
