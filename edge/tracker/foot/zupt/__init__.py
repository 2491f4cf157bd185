"""Stance detection, zero-velocity updates, and the consistency of what they find."""
