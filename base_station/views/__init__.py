"""Structs of what a console shows, and their making from the live state."""
