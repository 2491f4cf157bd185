"""Tracker by the method of Li et al. (2014): a sensor on the waist, a length for each step."""
