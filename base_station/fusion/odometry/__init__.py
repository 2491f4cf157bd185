"""Odometry of a unit: growth of its errors, and what is kept of its path."""
