"""Parts that trackers of a sensor on the trunk share: attitude, height, dead reckoning by steps."""
