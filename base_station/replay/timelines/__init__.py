"""Timelines: what a unit measured and stated over a span of time, small enough for a screen."""
