"""Certificate authority, and the bus router that enforces it."""
