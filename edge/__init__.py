"""The edge agent: one per wearable; tracks its wearer and publishes what it knows."""
