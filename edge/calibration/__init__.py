"""Sensor errors of one unit: found with a person's help, kept in a file, removed from samples."""
