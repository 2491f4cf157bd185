"""``muster bench console``: what the station sends to consoles, and what a browser shows of it."""
