"""What ``muster bench bus`` is made of: units that speak, consoles that listen, and a station."""
