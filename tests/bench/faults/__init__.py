"""``muster bench faults``: what troubles cost a station and its units."""
