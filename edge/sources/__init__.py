"""Sources of sensor samples: recorded, simulated, another unit on the bus, devices."""
