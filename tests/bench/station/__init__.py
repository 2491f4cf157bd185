"""``muster bench station``: what a message costs a station."""
