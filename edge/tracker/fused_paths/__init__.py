"""Trackers that fuse the paths of two sensors of one person into one."""
