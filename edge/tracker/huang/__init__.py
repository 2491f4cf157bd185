"""Tracker by the method of Huang's thesis (2009): quasi-static resets in stance."""
