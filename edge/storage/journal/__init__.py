"""Journal of every message of a unit: on its disk before it is sent, and until the station has
it.
"""
