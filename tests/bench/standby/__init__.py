"""``muster bench standby``: two stations, and what it costs when one of them is gone."""
