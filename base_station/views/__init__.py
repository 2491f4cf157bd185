"""Structs that describe what a console shows, and the functions that make them from the live
state.
"""
