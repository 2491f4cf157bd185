"""Engine: the one thread that takes events, logs and applies them, and publishes."""
