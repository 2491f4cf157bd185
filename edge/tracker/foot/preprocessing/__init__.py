"""Repair of the foot's samples: saturated swings, spikes, losses that no time stamp shows."""
