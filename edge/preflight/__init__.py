"""Checks of a unit before its wearer goes in."""
