"""Checks and repair of samples before the filter: bad samples, times, saturation, spikes, gaps."""
