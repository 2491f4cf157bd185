"""Outputs that notify the wearer: lights, beepers, speech."""
