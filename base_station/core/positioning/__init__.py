"""Positions of all units in the incident frame: input to their fusers and output of estimates."""
