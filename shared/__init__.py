"""The contract between edge agents and base station.

Frames: navigation NED (north, east, down), body FRD, heading clockwise from
true north.  ``rotation_nb`` takes body vectors to navigation vectors;
quaternions are Hamilton ``[w, x, y, z]``.  Latitude/longitude, ENU and "up"
appear only in the console, in exporters and in ``shared.geo``.

Units: SI and radians; names carry them (``_m _s _mps _mps2 _rad _radps _pa
_std _var _ns``; ``lat_deg``, ``lon_deg``, ``temperature_degc``, ``mag_ut``).

Time: integer nanoseconds.  Filters use the unit's monotonic clock; messages
carry that, the unit's UTC estimate with its standard deviation, a boot id and
a sequence number; the station adds its receive time.
"""
