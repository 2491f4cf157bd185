"""Inertial sensors with a driver of the kernel's Industrial I/O."""
