"""Drawings of buildings from other programs, read as plans in a process of their own."""
