"""Timelines: measured and stated values of a unit over a span of time, reduced for a screen."""
