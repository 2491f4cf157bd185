"""GNSS receivers beside a source: gpsd and NMEA 0183."""
