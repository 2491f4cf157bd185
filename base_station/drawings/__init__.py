"""Drawings of buildings from elsewhere, read as plans in a process of their own."""
