"""Tracker of the body (body): steps of a sensor on back, hip, chest, in a pocket or a hand."""
