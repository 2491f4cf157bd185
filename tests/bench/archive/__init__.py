"""Cost of post-processing for a station that is at work."""
