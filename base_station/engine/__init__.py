"""Engine: the one thread that receives events, logs and applies them, and publishes."""
