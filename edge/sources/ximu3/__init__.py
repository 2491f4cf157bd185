"""Source of samples for the x-io x-IMU3."""
