"""Processes for work on the past: the live station shares neither its interpreter nor its memory
with them.
"""
