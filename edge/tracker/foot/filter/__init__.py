"""Error-state Kalman filter: strapdown integration, error propagation, measurement updates."""
